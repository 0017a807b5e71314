#pragma once

#include <memory>
#include <vector>

#include "softform/objectives/imls_field.hpp"
#include "softform/objectives/objective.hpp"

namespace softform {

/// The squared distance (6.17) of a triangle surface to a target, integrated over it rather than summed over its nodes:
///     E(x) = 1/L^2 sum_s w_s d(P_s x)^2
/// over points s on the triangles: corners, middles of edges and centroids, with the weights of the quadrature that is
/// exact to third order (Zienkiewicz). A sum over nodes alone is gamed: nodes flee to where the target is met and the
/// triangles between them, which no one looks at, grow.
class SampledDistance : public Objective {
 public:
  /// triangles (m, 3) between nodes; areas (m), of any unit: the weights sum to the number of nodes, so that the value
  /// is comparable with a sum over nodes; unit_length L [m].
  SampledDistance(const Triangles& triangles, int node_count, ConstVec areas, std::shared_ptr<const ImlsField> target,
                  double unit_length);

  double value(ConstVec x) const override;
  void gradient(ConstVec x, Vec& g) const override;
  void gauss_newton_hessian(ConstVec x, SparseMatrix& H) const override;
  bool hessian(ConstVec x, SparseMatrix& H) const override;

 private:
  std::vector<ImlsField::Value> evaluate(ConstVec x, ImlsField::Derivatives derivatives) const;
  void assemble(const std::vector<ImlsField::Value>& samples, bool is_exact, SparseMatrix& H) const;
  int sample_count() const { return static_cast<int>(weights_.size()); }

  std::shared_ptr<const ImlsField> target_;
  SparseMatrix interpolation_;  // P (3 samples, 3n)
  Vec weights_;                 // w_s / L^2
};

}  // namespace softform
