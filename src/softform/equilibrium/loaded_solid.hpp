#pragma once

#include <vector>

#include "softform/equilibrium/newton.hpp"
#include "softform/equilibrium/potential.hpp"
#include "softform/fem/solid.hpp"
#include "softform/linalg/sparse_sum.hpp"

namespace softform {

/// A point of a body as a weighted mean of vertices: what an actuator holds. The weights sum to one.
struct BodyPoint {
  std::vector<int> vertices;
  std::vector<double> weights;
};

template <int dim>
using Point = Eigen::Matrix<double, dim, 1>;

/// Where a point of the body is at positions x (dim n) of its vertices.
template <int dim>
Point<dim> position(const BodyPoint& point, ConstVec x);

/// A pin by position: the spring energy  stiffness/2 |x(point) - position|^2. Its force is the pin's reaction.
template <int dim>
struct Pin {
  BodyPoint point;
  Point<dim> position;   ///< [m]
  double stiffness = 0;  ///< [N/m]
};

/// A string from a point of the body to an anchor, by its potential  tension |anchor - x(point)|: it pulls with
/// constant force along its own direction (5.4).
template <int dim>
struct String {
  BodyPoint point;
  Point<dim> anchor;   ///< [m]
  double tension = 0;  ///< [N], not negative
};

/// The potential of a solid with given densities under dead loads, pins and strings. It refers to a Solid that must
/// outlive it.
template <int dim>
class LoadedSolid : public Potential {
 public:
  /// densities: (m). `dead_loads`: nodal forces (dim n) [N], or empty.
  LoadedSolid(const Solid<dim>& body, Vec densities, Vec dead_loads = {}, std::vector<Pin<dim>> pins = {},
              std::vector<String<dim>> strings = {});

  const Solid<dim>& body() const { return body_; }
  const Vec& densities() const { return densities_; }
  void set_densities(const Vec& densities) { densities_ = densities; }

  double value(ConstVec x) const override;
  void gradient(ConstVec x, Vec& g) const override;
  void hessian(ConstVec x, SparseMatrix& K) const override;
  bool projected_hessian(ConstVec x, SparseMatrix& K) const override;
  /// The force that strains a mean element of the soft material by one.
  double force_scale() const override { return force_scale_; }
  /// The rest shape's extent.
  double length_scale() const override { return length_scale_; }
  int dimension() const override { return dim; }

 private:
  void assemble(ConstVec x, Projection projection, SparseMatrix& K) const;

  const Solid<dim>& body_;
  Vec densities_, dead_loads_;
  std::vector<Pin<dim>> pins_;
  std::vector<String<dim>> strings_;
  double force_scale_, length_scale_;
  mutable SparseMatrix body_hessian_;
  mutable SparseSum sum_;
};

}  // namespace softform
