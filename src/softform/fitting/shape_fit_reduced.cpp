// The shape fit in its parameters alone.

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "softform/core/error.hpp"
#include "softform/equilibrium/volume_control.hpp"
#include "softform/fitting/shape_fit_internal.hpp"
#include "softform/linalg/sparse_factorization.hpp"

namespace softform {
namespace {

// Equilibria at one set of parameters, with the load of each.
struct Simulation {
  ClampedSheet sheet;
  std::vector<Equilibrium> states;
};

// The derivatives of an equilibrium in the logarithms of the parameters: dx (3n, parameters) and dP.
struct Sensitivity {
  Eigen::MatrixXd dx;
  Vec dP;
};

// Equilibria and their sensitivities at z: they predict those nearby.
struct Linearization {
  Vec z;
  std::vector<Equilibrium> states;
  std::vector<Sensitivity> sensitivities;
};

// A sparse matrix that stores its zeros too: the pattern must not change.
SparseMatrix all_entries(const Eigen::MatrixXd& dense)
{
  SparseMatrix sparse(dense.rows(), dense.cols());
  sparse.reserve(Eigen::VectorXi::Constant(dense.cols(), static_cast<int>(dense.rows())));
  for (Eigen::Index j = 0; j < dense.cols(); ++j)
    for (Eigen::Index i = 0; i < dense.rows(); ++i) sparse.insert(i, j) = dense(i, j);
  sparse.makeCompressed();
  return sparse;
}

class ReducedShapeFit final : public NonlinearProgram {
 public:
  explicit ReducedShapeFit(const ShapeFit& fit) : fit_(fit) { check(fit_); }

  std::string name() const override { return "shape fit, reduced"; }
  int variable_count() const override { return static_cast<int>(fit_.start.size()); }
  int constraint_count() const override { return 0; }
  Vec initial_point() const override { return log_magnitudes(fit_.start); }

  double objective(ConstVec z) const override
  {
    const Simulation* simulation = simulate(z);
    if (simulation == nullptr) return HUGE_VAL;
    double sum = 0;
    for (std::size_t i = 0; i < fit_.steps.size(); ++i)
      sum += step_misfit(fit_, fit_.steps[i], simulation->states[i].x, simulation->states[i].pressure).value;
    return sum / observation_count(fit_);
  }
  void objective_gradient(ConstVec z, Vec& g) const override
  {
    differentiate(z);
    g = gradient_;
  }
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override
  {
    differentiate(z);
    H = all_entries(hessian_);
  }
  void constraints(ConstVec, Vec& c) const override { c.resize(0); }
  void constraint_jacobian(ConstVec, SparseMatrix& J) const override { J.resize(0, variable_count()); }

  /// Marquardt's scaling; a parameter without influence keeps a little of the others'.
  void step_metric(ConstVec z, SparseMatrix& D) const override
  {
    differentiate(z);
    const Vec diagonal = hessian_.diagonal().array() + 1e-6 * hessian_.diagonal().maxCoeff();
    D = all_entries(diagonal.asDiagonal());
  }
  std::optional<Vec> restore(ConstVec z) const override
  {
    // A linearisation says nothing of parameters several times as large: the sheet there is another.
    constexpr double largest_step = 1.5;
    const bool is_far = linearization_.z.size() > 0 && !((z - linearization_.z).cwiseAbs().maxCoeff() < largest_step);
    if (is_far || simulate(z) == nullptr) return std::nullopt;
    return Vec(z);
  }
  int inner_linear_solves() const override { return factorization_.attempts(); }

 private:
  const Simulation* simulate(ConstVec z) const;
  std::vector<Equilibrium> inflate_by_volume(const ClampedSheet& sheet, ConstVec z) const;
  std::vector<Equilibrium> inflate_by_pressure(const ClampedSheet& sheet) const;
  Sensitivity sensitivity(const Simulation& simulation, const Equilibrium& state) const;
  void differentiate(ConstVec z) const;

  ShapeFit fit_;
  mutable SparseFactorization factorization_;
  // The simulation and the derivatives of the last points asked for: several functions need them at the same one.
  mutable Vec simulated_at_;
  mutable std::optional<Simulation> simulation_;
  mutable Linearization linearization_;
  mutable Vec gradient_;
  mutable Eigen::MatrixXd hessian_;
};

// nullptr where the material or an equilibrium does not exist.
const Simulation* ReducedShapeFit::simulate(ConstVec z) const
{
  if (simulated_at_.size() != z.size() || simulated_at_ != z) {
    simulated_at_ = z;
    simulation_.reset();
    std::shared_ptr<const Material> material;
    try {
      material = fitted_material(fit_, z);
    } catch (const InputError&) {
      return nullptr;  // a trial step out of the model's range
    }
    ClampedSheet sheet(fit_.radius, reference_thickness, fit_.rings, material);
    std::vector<Equilibrium> states =
        fit_.control == Control::Volume ? inflate_by_volume(sheet, z) : inflate_by_pressure(sheet);
    if (states.size() == fit_.steps.size() && states.back().report.converged())
      simulation_.emplace(Simulation{std::move(sheet), std::move(states)});
  }
  return simulation_ ? &*simulation_ : nullptr;
}

// From the equilibria predicted for z, three times as fast as from the flat sheet; the branch is the same.
std::vector<Equilibrium> ReducedShapeFit::inflate_by_volume(const ClampedSheet& sheet, ConstVec z) const
{
  const std::vector<double> volumes = faceted_volumes(fit_, sheet);
  NewtonOptions newton;
  newton.max_iterations = 12;  // a prediction that needs more is worth less than the path from the flat sheet
  std::vector<Equilibrium> states;
  for (std::size_t i = 0; i < linearization_.states.size(); ++i) {
    const Equilibrium& state = linearization_.states[i];
    const Sensitivity& by = linearization_.sensitivities[i];
    const Vec dz = z - linearization_.z;
    states.push_back(solve_at_volume(sheet.balloon(), volumes[i], state.x + by.dx * dz, state.pressure + by.dP.dot(dz),
                                     factorization_, newton, sheet.clamp()));
    if (!states.back().report.converged()) return inflate(sheet, volumes, factorization_);
  }
  return states.empty() ? inflate(sheet, volumes, factorization_) : states;
}

// Each step from the one before; a jump to another branch, or none left, ends it.
std::vector<Equilibrium> ReducedShapeFit::inflate_by_pressure(const ClampedSheet& sheet) const
{
  std::vector<Equilibrium> states;
  Vec x = spherical_cap(sheet.mesh(), fit_.radius, fit_.steps.front().volume);
  for (const ShapeStep& step : fit_.steps) {
    const ShapeObservation& observation = step.observations.front();
    const double pressure = observation.pressure * reference_thickness / observation.thickness;
    states.push_back(solve_at_pressure(sheet.balloon(), pressure, x, factorization_, {}, sheet.clamp()));
    if (!states.back().report.converged()) break;
    x = states.back().x;
  }
  return states;
}

// With f = W' - P g the unbalanced forces, g = V' and K = W'' - P V'':
//     [ K  -g ] (dx)     ( df/dp )
//     [ g^t 0 ] (dP) = - (   0   ) d(log |p|) p.
Sensitivity ReducedShapeFit::sensitivity(const Simulation& simulation, const Equilibrium& state) const
{
  const ClampedSheet& sheet = simulation.sheet;
  const Vec& X = sheet.balloon().rest_positions();
  SparseMatrix K;
  PressurePotential(sheet.balloon(), state.pressure, state.x).hessian(state.x, K);
  sheet.clamp().project(K, K.diagonal().cwiseAbs().mean());
  if (!factorization_.cholesky(K)) factorization_.indefinite(K);
  Vec g;
  sheet.balloon().volume().gradient(state.x, g);
  sheet.clamp().project(g);
  const Vec u = factorization_.solve(g);

  const auto parameters = sheet.membrane().material().parameters();
  Sensitivity found{Eigen::MatrixXd(state.x.size(), variable_count()), Vec::Zero(variable_count())};
  for (int k = 0; k < variable_count(); ++k) {
    Vec f_k;
    sheet.membrane().parameter_gradient(state.x, X, k, f_k);
    sheet.clamp().project(f_k);
    const Vec w = parameters[static_cast<std::size_t>(k)].value * factorization_.solve(f_k);
    if (fit_.control == Control::Volume) found.dP[k] = g.dot(w) / g.dot(u);
    found.dx.col(k) = found.dP[k] * u - w;
  }
  return found;
}

void ReducedShapeFit::differentiate(ConstVec z) const
{
  if (linearization_.z.size() == z.size() && linearization_.z == z) return;
  const int m = variable_count();
  gradient_.setConstant(m, HUGE_VAL);
  hessian_.setZero(m, m);
  const Simulation* simulation = simulate(z);
  if (simulation == nullptr) return;
  gradient_.setZero();
  linearization_ = {z, simulation->states, {}};
  const double count = observation_count(fit_);
  for (std::size_t i = 0; i < fit_.steps.size(); ++i) {
    const Equilibrium& state = simulation->states[i];
    const StepMisfit misfit = step_misfit(fit_, fit_.steps[i], state.x, state.pressure);
    linearization_.sensitivities.push_back(sensitivity(*simulation, state));
    const auto& [dx, dP] = linearization_.sensitivities.back();
    gradient_ +=
        (dx.topRows(misfit.gradient.size()).transpose() * misfit.gradient + misfit.pressure_gradient * dP) / count;
    hessian_ += misfit.pressure_hessian / count * dP * dP.transpose();
    for (std::size_t v = 0; v < misfit.hessian.size(); ++v) {
      const auto rows = dx.middleRows<3>(3 * static_cast<Eigen::Index>(v));
      hessian_ += rows.transpose() * misfit.hessian[v] * rows / count;
    }
  }
}

}  // namespace

std::unique_ptr<NonlinearProgram> reduced_program(const ShapeFit& fit)
{
  return std::make_unique<ReducedShapeFit>(fit);
}

}  // namespace softform
