#pragma once

#include "softform/core/types.hpp"

namespace softform {

/// How far a pose is from its target: the distances of corresponding vertices, the measure of table 5.1.
struct PoseError {
  double max = 0, mean = 0;  ///< [m]
};

/// x, target: (dim n) [m].
template <int dim>
PoseError pose_error(const Vec& x, const Vec& target)
{
  const auto points = [](const Vec& flat) {
    return Eigen::Map<const Eigen::Matrix<double, dim, Eigen::Dynamic>>(flat.data(), dim, flat.size() / dim);
  };
  const Vec distances = (points(x) - points(target)).colwise().norm();
  return {distances.maxCoeff(), distances.mean()};
}

}  // namespace softform
