#include "softform/inflatables/inflatable.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/materials/tension_field.hpp"

namespace softform {
namespace {

std::vector<char> skin_flags(const PanelLayout& layout)
{
  std::vector<char> is_skin(static_cast<std::size_t>(layout.triangle_count()), 1);
  for (const Panel& panel : layout.panels)
    if (panel.is_wall) std::fill_n(is_skin.begin() + panel.first_triangle, panel.triangle_count, 0);
  return is_skin;
}

// Pressure needs an inside: the area vectors of a closed surface sum to zero around every edge.
void require_closed_skins(const PanelLayout& layout, const Triangles& triangles, const std::vector<char>& is_skin)
{
  std::map<std::pair<int, int>, int> balance;
  for (int t = 0; t < triangles.rows(); ++t) {
    if (!is_skin[std::size_t(t)]) continue;
    for (int k = 0; k < 3; ++k) {
      const int i = triangles(t, k), j = triangles(t, (k + 1) % 3);
      balance[std::minmax(i, j)] += i < j ? 1 : -1;
    }
  }
  for (const auto& [edge, sum] : balance)
    if (sum != 0)
      throw InputError(
          fmt::format("the skins are open or turned at the edge between the nodes {} and {} of {}: sew their "
                      "boundaries together, all facing outwards",
                      edge.first, edge.second, layout.node_count()));
}

// 1 - s_2 / w with the natural width w; stretches (m, 2).
Vec lost_width(const Eigen::MatrixX2d& stretches)
{
  const auto natural_width = stretches.col(0).array().max(1.0).rsqrt();
  return (1 - stretches.col(1).array() / natural_width).max(0.0);
}

// The total energy under `overpressure` times the pressure.
class InflationPotential : public Potential {
 public:
  InflationPotential(const Inflatable& inflatable, const Vec& flat, double overpressure)
      : inflatable_(inflatable),
        flat_(flat),
        overpressure_(overpressure),
        extra_((overpressure - 1) * inflatable.pressure())
  {}

  double value(ConstVec x) const override
  {
    return inflatable_.value(x, flat_) - extra_ * inflatable_.volume().value(x);
  }
  void gradient(ConstVec x, Vec& g) const override
  {
    inflatable_.gradient(x, flat_, g);
    if (extra_ == 0) return;
    inflatable_.volume().gradient(x, volume_gradient_);
    g -= extra_ * volume_gradient_;
  }
  void hessian(ConstVec x, SparseMatrix& K) const override
  {
    inflatable_.hessian(x, flat_, K);
    if (extra_ != 0) inflatable_.volume().add_hessian(x, -extra_, K);
  }
  // The pressure's own part may be indefinite: it is left to the shift.
  bool projected_hessian(ConstVec x, SparseMatrix& K) const override
  {
    if (!inflatable_.membrane().projected_hessian(x, flat_, K)) return false;
    inflatable_.volume().add_hessian(x, -overpressure_ * inflatable_.pressure(), K);
    return true;
  }
  double force_scale() const override { return overpressure_ * inflatable_.force_scale(); }
  double length_scale() const override { return inflatable_.length_scale(); }

 private:
  const Inflatable& inflatable_;
  const Vec& flat_;
  double overpressure_, extra_;
  mutable Vec volume_gradient_;
};

// In equilibrium the membrane's virial balances that of the pressure: x . dW/dx = p x . dV/dx = 3 p V.
bool is_near_equilibrium(const Inflatable& inflatable, const Vec& flat, const Vec& x)
{
  Vec g;
  inflatable.gradient(x, flat, g);
  const double pressure_virial = 3 * inflatable.pressure() * inflatable.volume().value(x);
  const double ratio = 1 + g.dot(x) / pressure_virial;
  return pressure_virial > 0 && ratio > 0.1 && ratio < 100;
}

// By how much the pressure must grow until strains are no longer small: it takes E h to p L = 20.
double softening_overpressure(const Inflatable& inflatable)
{
  const PanelMembrane& membrane = inflatable.membrane();
  const double stiffness = membrane.material().shear_modulus() * membrane.thickness().mean();
  return stiffness / (20 * inflatable.pressure() * inflatable.length_scale());
}

// What `stage` cost on top of what `total` did.
void append(const Equilibrium& stage, Equilibrium& total)
{
  for (Iterate iterate : stage.report.trace) {
    iterate.k += total.iterations;
    total.report.trace.push_back(iterate);
  }
  const Evaluations& spent = stage.report.evaluations;
  total.report.evaluations.value += spent.value;
  total.report.evaluations.gradient += spent.gradient;
  total.report.evaluations.hessian += spent.hessian;
  total.report.evaluations.linear_solve += spent.linear_solve;
  const PhaseTimes& times = stage.report.times;
  total.report.times.assembly += times.assembly;
  total.report.times.factorization += times.factorization;
  total.report.times.solve += times.solve;
  total.iterations += stage.iterations;
}

}  // namespace

Inflatable::Inflatable(const PanelLayout& layout, std::shared_ptr<const Material> material, double thickness,
                       double pressure)
    : membrane_(node_triangles(layout), layout.node_count(), layout.triangles, layout.vertex_count(),
                std::move(material), Vec::Constant(layout.triangle_count(), thickness)),
      volume_(membrane_.triangles(), layout.node_count(), skin_flags(layout)),
      pressure_(pressure)
{
  if (!(pressure > 0) || !std::isfinite(pressure))
    throw InputError(fmt::format("a pressure of {} Pa: it must be positive", pressure));
  const std::vector<char> is_skin = skin_flags(layout);
  require_closed_skins(layout, membrane_.triangles(), is_skin);
  const Vec flat = flat_vector(layout);
  double skin_area = 0;
  for (int t = 0; t < layout.triangle_count(); ++t)
    if (is_skin[std::size_t(t)])
      skin_area += FlatTriangleEdges(flat, layout.triangles(t, 0), layout.triangles(t, 1), layout.triangles(t, 2))
                       .products()
                       .area();
  force_scale_ = pressure * skin_area / layout.node_count();
  length_scale_ = (layout.nodes.colwise().maxCoeff() - layout.nodes.colwise().minCoeff()).norm();
}

double Inflatable::value(ConstVec x, ConstVec flat) const
{
  return membrane_.value(x, flat) - pressure_ * volume_.value(x);
}

void Inflatable::gradient(ConstVec x, ConstVec flat, Vec& g) const
{
  membrane_.gradient(x, flat, g);
  volume_.gradient(x, volume_gradient_);
  g -= pressure_ * volume_gradient_;
}

void Inflatable::hessian(ConstVec x, ConstVec flat, SparseMatrix& K) const
{
  membrane_.hessian(x, flat, K);
  volume_.add_hessian(x, -pressure_, K);
}

void Inflatable::force_hessian(ConstVec x, ConstVec flat, ConstVec lambda, SparseMatrix& xx, SparseMatrix& mixed,
                               SparseMatrix& XX) const
{
  membrane_.force_hessian(x, flat, lambda, xx, mixed, XX);
  volume_.add_hessian(lambda, -pressure_, xx);
}

Vec Inflatable::compression(ConstVec x, ConstVec flat) const
{
  return lost_width(membrane_.principal_stretches(x, flat));
}

Vec Inflatable::patch_compression(ConstVec x, ConstVec flat, const std::vector<int>& patch, int patch_count) const
{
  using Gradient = Eigen::Matrix<double, 3, 2>;
  std::vector<Gradient> sums(static_cast<std::size_t>(patch_count), Gradient::Zero());
  Vec areas = Vec::Zero(patch_count);
  for (int t = 0; t < membrane_.triangles().rows(); ++t) {
    const int k = patch[std::size_t(t)];
    if (k < 0) continue;
    const auto deformed = membrane_.triangles().row(t), rest = membrane_.rest_triangles().row(t);
    const TriangleEdges e(x, deformed[0], deformed[1], deformed[2]);
    const FlatTriangleEdges E(flat, rest[0], rest[1], rest[2]);
    Gradient edges;
    Eigen::Matrix2d rest_edges;
    edges << e.u, e.v;
    rest_edges << E.u, E.v;
    const double area = E.products().area();
    sums[std::size_t(k)] += area * edges * rest_edges.inverse();
    areas[k] += area;
  }
  Eigen::MatrixX2d stretches(patch_count, 2);
  for (int k = 0; k < patch_count; ++k) {
    const Gradient F = sums[std::size_t(k)] / areas[k];
    const Eigen::Matrix2d C = F.transpose() * F;
    const SquaredStretches lambda = SquaredStretches::of(C.trace(), C.determinant());
    stretches.row(k) << std::sqrt(lambda.lambda_1), std::sqrt(lambda.lambda_2);
  }
  return lost_width(stretches);
}

Vec flat_vector(const PanelLayout& layout) { return Eigen::Map<const Vec>(layout.flat.data(), layout.flat.size()); }

NewtonOptions inflation_options()
{
  NewtonOptions options;
  // Forces are a thousandth of the stiffness or less: round-off leaves some 1e-8 of them, more on stiffer material.
  options.tolerance = 1e-6;
  options.step_cap = 0.2;
  options.max_iterations = 400;
  return options;
}

Equilibrium settle(const Inflatable& inflatable, const Vec& flat, const Vec& x0, SparseFactorization& factorization,
                   const NewtonOptions& options)
{
  Equilibrium equilibrium = solve_equilibrium(InflationPotential(inflatable, flat, 1), x0, factorization, options);
  equilibrium.pressure = inflatable.pressure();
  return equilibrium;
}

Equilibrium inflate(const Inflatable& inflatable, const Vec& flat, const Vec& x0, SparseFactorization& factorization,
                    const NewtonOptions& options)
{
  constexpr double largest_jump = 50, loose_tolerance = 0.1;
  Equilibrium total;
  Vec x = x0;
  double overpressure = is_near_equilibrium(inflatable, flat, x0) ? 1 : softening_overpressure(inflatable);
  for (; overpressure > 2; overpressure = overpressure > 2 * largest_jump ? overpressure / largest_jump : 1) {
    NewtonOptions loose = options;
    loose.tolerance = std::max(loose_tolerance, options.tolerance);
    loose.max_iterations = (options.max_iterations - total.iterations) / 2;
    const Equilibrium stage =
        solve_equilibrium(InflationPotential(inflatable, flat, overpressure), x, factorization, loose);
    append(stage, total);
    if (!stage.report.converged()) break;
    x = stage.x;
  }
  NewtonOptions rest = options;
  rest.max_iterations = options.max_iterations - total.iterations;
  Equilibrium last = settle(inflatable, flat, x, factorization, rest);
  append(last, total);
  last.report.trace = std::move(total.report.trace);
  last.report.evaluations = total.report.evaluations;
  last.report.times = total.report.times;
  last.iterations = total.iterations;
  return last;
}

}  // namespace softform
