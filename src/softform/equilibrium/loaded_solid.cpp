#include "softform/equilibrium/loaded_solid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace softform {

template <int dim>
Point<dim> position(const BodyPoint& point, ConstVec x)
{
  Point<dim> sum = Point<dim>::Zero();
  for (std::size_t k = 0; k < point.vertices.size(); ++k)
    sum += point.weights[k] * x.template segment<dim>(dim * Eigen::Index(point.vertices[k]));
  return sum;
}

namespace {

template <int dim>
void add_force(const BodyPoint& point, const Point<dim>& force, Vec& g)
{
  for (std::size_t k = 0; k < point.vertices.size(); ++k)
    g.template segment<dim>(dim * Eigen::Index(point.vertices[k])) += point.weights[k] * force;
}

template <int dim>
void append_stiffness(const BodyPoint& point, const Gradient<dim>& stiffness,
                      std::vector<Eigen::Triplet<double>>& entries)
{
  for (std::size_t k = 0; k < point.vertices.size(); ++k)
    for (std::size_t l = 0; l < point.vertices.size(); ++l)
      for (int p = 0; p < dim; ++p)
        for (int q = 0; q < dim; ++q)
          entries.emplace_back(dim * point.vertices[k] + p, dim * point.vertices[l] + q,
                               point.weights[k] * point.weights[l] * stiffness(p, q));
}

// d2/dx2 of tension |anchor - x|: the string resists turning only. Positive semi-definite.
template <int dim>
Gradient<dim> string_stiffness(const String<dim>& string, ConstVec x)
{
  const Point<dim> d = position<dim>(string.point, x) - string.anchor;
  const double length = d.norm();
  return string.tension / length * (Gradient<dim>::Identity() - d * d.transpose() / (length * length));
}

template <int dim>
double extent(const Vec& x)
{
  const Eigen::Map<const Eigen::Matrix<double, dim, Eigen::Dynamic>> points(x.data(), dim, x.size() / dim);
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

}  // namespace

template <int dim>
LoadedSolid<dim>::LoadedSolid(const Solid<dim>& body, Vec densities, Vec dead_loads, std::vector<Pin<dim>> pins,
                              std::vector<String<dim>> strings)
    : body_(body),
      densities_(std::move(densities)),
      dead_loads_(std::move(dead_loads)),
      pins_(std::move(pins)),
      strings_(std::move(strings)),
      length_scale_(extent<dim>(body.rest_positions())),
      sum_(static_cast<int>(body.rest_positions().size()))
{
  const double mean_volume = body.volumes().mean();
  const double element_size = std::cbrt(mean_volume);
  force_scale_ = body.mixture().soft().shear_modulus() * element_size * element_size;
}

template <int dim>
double LoadedSolid<dim>::value(ConstVec x) const
{
  double sum = body_.value(x, densities_);
  if (dead_loads_.size() > 0) sum -= dead_loads_.dot(x);
  for (const Pin<dim>& pin : pins_)
    sum += pin.stiffness / 2 * (position<dim>(pin.point, x) - pin.position).squaredNorm();
  for (const String<dim>& string : strings_)
    sum += string.tension * (position<dim>(string.point, x) - string.anchor).norm();
  return sum;
}

template <int dim>
void LoadedSolid<dim>::gradient(ConstVec x, Vec& g) const
{
  body_.gradient(x, densities_, g);
  if (dead_loads_.size() > 0) g -= dead_loads_;
  for (const Pin<dim>& pin : pins_)
    add_force<dim>(pin.point, pin.stiffness * (position<dim>(pin.point, x) - pin.position), g);
  for (const String<dim>& string : strings_)
    add_force<dim>(string.point, string.tension * (position<dim>(string.point, x) - string.anchor).normalized(), g);
}

template <int dim>
void LoadedSolid<dim>::assemble(ConstVec x, Projection projection, SparseMatrix& K) const
{
  if (pins_.empty() && strings_.empty()) {
    body_.hessian(x, densities_, projection, K);
    return;
  }
  body_.hessian(x, densities_, projection, body_hessian_);
  std::vector<Eigen::Triplet<double>> entries;
  for (const Pin<dim>& pin : pins_)
    append_stiffness<dim>(pin.point, pin.stiffness * Gradient<dim>::Identity(), entries);
  for (const String<dim>& string : strings_)
    append_stiffness<dim>(string.point, string_stiffness<dim>(string, x), entries);
  SparseMatrix actuators(x.size(), x.size());
  actuators.setFromTriplets(entries.begin(), entries.end());
  sum_.clear();
  sum_.add(body_hessian_, 1, 0, 0);
  sum_.add(actuators, 1, 0, 0);
  K = sum_.matrix();
}

template <int dim>
void LoadedSolid<dim>::hessian(ConstVec x, SparseMatrix& K) const
{
  assemble(x, Projection::None, K);
}

template <int dim>
bool LoadedSolid<dim>::projected_hessian(ConstVec x, SparseMatrix& K) const
{
  assemble(x, Projection::PositiveDefinite, K);
  return true;
}

template Point<2> position<2>(const BodyPoint&, ConstVec);
template Point<3> position<3>(const BodyPoint&, ConstVec);
template class LoadedSolid<2>;
template class LoadedSolid<3>;

}  // namespace softform
