// The shape fit in equilibria, pressures and parameters together.

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "softform/core/error.hpp"
#include "softform/equilibrium/volume_control.hpp"
#include "softform/fitting/shape_fit_internal.hpp"
#include "softform/mesh/disc.hpp"

namespace softform {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

class FullSpaceShapeFit final : public NonlinearProgram {
 public:
  explicit FullSpaceShapeFit(const ShapeFit& fit);

  std::string name() const override { return "shape fit, full space"; }
  int variable_count() const override { return steps() * step_size() + parameter_count(); }
  int constraint_count() const override { return steps() * step_size(); }
  Vec initial_point() const override;

  double objective(ConstVec z) const override;
  void objective_gradient(ConstVec z, Vec& g) const override;
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override;
  void constraints(ConstVec z, Vec& c) const override;
  void constraint_jacobian(ConstVec z, SparseMatrix& J) const override;
  std::optional<Vec> restore(ConstVec z) const override;
  int inner_linear_solves() const override { return factorization_.attempts(); }

 private:
  int steps() const { return static_cast<int>(fit_.steps.size()); }
  int parameter_count() const { return static_cast<int>(fit_.start.size()); }
  int free_vertices() const { return disc_vertex_count(fit_.rings - 1); }
  int free_size() const { return 3 * free_vertices(); }
  int step_size() const { return free_size() + 1; }
  // The sheet of the parameters of z; nothing where the model does not take them: a trial step out of its range.
  std::optional<ClampedSheet> sheet(ConstVec z) const;
  ClampedSheet first_sheet() const { return sheet_of(log_magnitudes(fit_.start)); }
  ClampedSheet sheet_of(ConstVec logarithms) const
  {
    return {fit_.radius, reference_thickness, fit_.rings, fitted_material(fit_, logarithms)};
  }
  // All positions (3n) and the pressure of step i.
  Vec positions(ConstVec z, int i) const;
  double pressure(ConstVec z, int i) const { return pressure_unit_ * z[i * step_size() + free_size()]; }
  StepMisfit misfit(ConstVec z, int i) const
  {
    return step_misfit(fit_, fit_.steps[static_cast<std::size_t>(i)], positions(z, i), pressure(z, i));
  }
  Vec join(const std::vector<Equilibrium>& states, ConstVec logarithms) const;
  void add_step_jacobian(const ClampedSheet& sheet, ConstVec z, int i, Triplets& entries) const;

  ShapeFit fit_;
  double pressure_unit_ = 0, force_unit_ = 0;
  Vec rest_;
  std::vector<double> volumes_;
  mutable SparseFactorization factorization_;
};

FullSpaceShapeFit::FullSpaceShapeFit(const ShapeFit& fit) : fit_(fit)
{
  check(fit_);
  if (fit_.control != Control::Volume)
    throw InputError("the full-space shape fit prescribes volumes: use Control::Volume");
  const ShapeObservation& last = fit_.steps.back().observations.front();
  pressure_unit_ = last.pressure * reference_thickness / last.thickness;
  force_unit_ = pressure_unit_ * std::numbers::pi * fit_.radius * fit_.radius / free_vertices();
  const ClampedSheet start = first_sheet();
  rest_ = start.balloon().rest_positions();
  volumes_ = faceted_volumes(fit_, start);
}

std::optional<ClampedSheet> FullSpaceShapeFit::sheet(ConstVec z) const
{
  try {
    return sheet_of(z);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

Vec FullSpaceShapeFit::positions(ConstVec z, int i) const
{
  Vec x = rest_;
  x.head(free_size()) = fit_.radius * z.segment(i * step_size(), free_size());
  return x;
}

Vec FullSpaceShapeFit::join(const std::vector<Equilibrium>& states, ConstVec logarithms) const
{
  Vec z(variable_count());
  for (int i = 0; i < steps(); ++i) {
    const Equilibrium& state = states[static_cast<std::size_t>(i)];
    z.segment(i * step_size(), free_size()) = state.x.head(free_size()) / fit_.radius;
    z[i * step_size() + free_size()] = state.pressure / pressure_unit_;
  }
  z.tail(parameter_count()) = logarithms;
  return z;
}

// The equilibria of the first parameters: the only feasible point that is known.
Vec FullSpaceShapeFit::initial_point() const
{
  const std::vector<Equilibrium> states = inflate(first_sheet(), volumes_, factorization_);
  if (!states.back().report.converged())
    throw InputError("the sheet cannot be inflated with the first parameters: " + states.back().report.message);
  return join(states, log_magnitudes(fit_.start));
}

std::optional<Vec> FullSpaceShapeFit::restore(ConstVec z) const
{
  const std::optional<ClampedSheet> sheet_at_z = sheet(z);
  if (!sheet_at_z) return std::nullopt;
  std::vector<Equilibrium> states;
  for (int i = 0; i < steps(); ++i) {
    states.push_back(solve_at_volume(sheet_at_z->balloon(), volumes_[static_cast<std::size_t>(i)], positions(z, i),
                                     pressure(z, i), factorization_, {}, sheet_at_z->clamp()));
    if (!states.back().report.converged()) return std::nullopt;
  }
  return join(states, z.tail(parameter_count()));
}

double FullSpaceShapeFit::objective(ConstVec z) const
{
  double sum = 0;
  for (int i = 0; i < steps(); ++i) sum += misfit(z, i).value;
  return sum / observation_count(fit_);
}

void FullSpaceShapeFit::objective_gradient(ConstVec z, Vec& g) const
{
  g.setZero(variable_count());
  for (int i = 0; i < steps(); ++i) {
    const StepMisfit step = misfit(z, i);
    g.segment(i * step_size(), free_size()) = fit_.radius / observation_count(fit_) * step.gradient;
    g[i * step_size() + free_size()] = pressure_unit_ / observation_count(fit_) * step.pressure_gradient;
  }
}

void FullSpaceShapeFit::gauss_newton_hessian(ConstVec z, SparseMatrix& H) const
{
  Triplets entries;
  for (int i = 0; i < steps(); ++i) {
    const StepMisfit step = misfit(z, i);
    const int offset = i * step_size();
    const double scale = fit_.radius * fit_.radius / observation_count(fit_);
    for (int v = 0; v < free_vertices(); ++v)
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
          entries.emplace_back(offset + 3 * v + r, offset + 3 * v + c,
                               scale * step.hessian[static_cast<std::size_t>(v)](r, c));
    const int p = offset + free_size();
    entries.emplace_back(p, p, pressure_unit_ * pressure_unit_ / observation_count(fit_) * step.pressure_hessian);
  }
  for (int k = variable_count() - parameter_count(); k < variable_count(); ++k) entries.emplace_back(k, k, 0);
  H.resize(variable_count(), variable_count());
  H.setFromTriplets(entries.begin(), entries.end());
}

void FullSpaceShapeFit::constraints(ConstVec z, Vec& c) const
{
  const std::optional<ClampedSheet> sheet_at_z = sheet(z);
  c.setConstant(constraint_count(), NAN);
  if (!sheet_at_z) return;
  for (int i = 0; i < steps(); ++i) {
    const Vec x = positions(z, i);
    Vec f, g;
    sheet_at_z->membrane().gradient(x, rest_, f);
    sheet_at_z->balloon().volume().gradient(x, g);
    f -= pressure(z, i) * g;
    c.segment(i * step_size(), free_size()) = f.head(free_size()) / force_unit_;
    const double volume = volumes_[static_cast<std::size_t>(i)];
    c[i * step_size() + free_size()] = sheet_at_z->balloon().volume().value(x) / volume - 1;
  }
}

// d(f, V)/d(x, P, log |p|) of step i.
void FullSpaceShapeFit::add_step_jacobian(const ClampedSheet& sheet_at_z, ConstVec z, int i, Triplets& entries) const
{
  const Vec x = positions(z, i);
  SparseMatrix K;
  PressurePotential(sheet_at_z.balloon(), pressure(z, i), x).hessian(x, K);
  const int offset = i * step_size(), free = free_size();
  for (int j = 0; j < free; ++j)
    for (SparseMatrix::InnerIterator entry(K, j); entry; ++entry)
      if (entry.row() < free)
        entries.emplace_back(offset + static_cast<int>(entry.row()), offset + j,
                             entry.value() * fit_.radius / force_unit_);
  Vec g, f_k;
  sheet_at_z.balloon().volume().gradient(x, g);
  const double volume = volumes_[static_cast<std::size_t>(i)];
  for (int j = 0; j < free; ++j) {
    entries.emplace_back(offset + j, offset + free, -g[j] * pressure_unit_ / force_unit_);
    entries.emplace_back(offset + free, offset + j, g[j] * fit_.radius / volume);
  }
  const auto parameters = sheet_at_z.membrane().material().parameters();
  for (int k = 0; k < parameter_count(); ++k) {
    sheet_at_z.membrane().parameter_gradient(x, rest_, k, f_k);
    const double scale = parameters[static_cast<std::size_t>(k)].value / force_unit_;
    for (int j = 0; j < free; ++j)
      entries.emplace_back(offset + j, variable_count() - parameter_count() + k, scale * f_k[j]);
  }
}

void FullSpaceShapeFit::constraint_jacobian(ConstVec z, SparseMatrix& J) const
{
  const std::optional<ClampedSheet> sheet_at_z = sheet(z);
  Triplets entries;  // the pattern is that of any parameters
  for (int i = 0; i < steps(); ++i) add_step_jacobian(sheet_at_z ? *sheet_at_z : first_sheet(), z, i, entries);
  J.resize(constraint_count(), variable_count());
  J.setFromTriplets(entries.begin(), entries.end());
  if (!sheet_at_z) J.coeffs().setConstant(NAN);
}

}  // namespace

std::unique_ptr<NonlinearProgram> full_space_program(const ShapeFit& fit)
{
  return std::make_unique<FullSpaceShapeFit>(fit);
}

}  // namespace softform
