#include "softform/inverse/material_design.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {
namespace {

// rho_e - mean of the neighbours' rho (5.18), as a matrix.
template <int dim>
SparseMatrix smoothing_matrix(const Solid<dim>& body)
{
  std::vector<Eigen::Triplet<double>> entries;
  const auto neighbours = element_neighbours<dim>(body.elements());
  for (std::size_t e = 0; e < neighbours.size(); ++e) {
    const int row = static_cast<int>(e);
    if (neighbours[e].empty()) continue;
    entries.emplace_back(row, row, 1);
    for (const int k : neighbours[e]) entries.emplace_back(row, k, -1.0 / double(neighbours[e].size()));
  }
  SparseMatrix L(body.element_count(), body.element_count());
  L.setFromTriplets(entries.begin(), entries.end());
  return L;
}

template <int dim>
void check_pose(const Solid<dim>& body, const MaterialPose<dim>& pose, std::size_t number)
{
  const Eigen::Index size = body.rest_positions().size();
  if (pose.target.size() != size || pose.start.size() != size ||
      (pose.fixed.free.size() != 0 && pose.fixed.free.size() != size))
    throw InputError(fmt::format("pose {} has {} target coordinates, the body {}: poses need the body's own vertices",
                                 number, pose.target.size(), size));
  for (int e = 0; e < body.element_count(); ++e)
    if (!(body.deformation_gradient(pose.target, e).determinant() > 0))
      throw InputError(fmt::format("pose {} turns element {} over: untangle the target", number, e));
}

}  // namespace

template <int dim>
MaterialDesign<dim>::MaterialDesign(const Solid<dim>& body, std::vector<MaterialPose<dim>> poses,
                                    EquilibriumLimits limits)
    : body_(body),
      poses_(std::move(poses)),
      limits_(limits),
      boundary_(boundary_vertices<dim>(body.elements())),
      smoothing_(smoothing_matrix<dim>(body)),
      smoothing_hessian_(smoothing_.transpose() * smoothing_),
      tangents_(poses_.size()),
      mixed_(poses_.size()),
      distance_weights_(poses_.size())
{
  for (std::size_t i = 0; i < poses_.size(); ++i) check_pose<dim>(body, poses_[i], i);
  // With every diagonal entry, so that the weights can be added in place.
  SparseMatrix identity(body.element_count(), body.element_count());
  identity.setIdentity();
  smoothing_hessian_ = smoothing_hessian_ + 0.0 * identity;
}

template <int dim>
LoadedSolid<dim> MaterialDesign<dim>::potential(const MaterialPose<dim>& pose, const Vec& rho) const
{
  return LoadedSolid<dim>(body_, rho, pose.dead_loads, pose.pins, pose.strings);
}

template <int dim>
std::optional<Vec> MaterialDesign<dim>::equilibrium(std::size_t pose, const Vec& rho, const Vec& from, const Vec& guess,
                                                    const NewtonOptions& options) const
{
  const LoadedSolid<dim> problem = potential(poses_[pose], rho);
  const bool is_guess_better = guess.size() > 0 && problem.value(guess) < problem.value(from);
  Equilibrium found =
      solve_equilibrium(problem, is_guess_better ? guess : from, newton_factorization_, options, poses_[pose].fixed);
  if (!found.report.converged()) return std::nullopt;
  return std::move(found.x);
}

// Of the boundary's vertices, in their order.
template <int dim>
Vec MaterialDesign<dim>::squared_distances(std::size_t pose, const Vec& x) const
{
  Vec squares(std::ssize(boundary_));
  for (Eigen::Index k = 0; k < squares.size(); ++k) {
    const Eigen::Index i = dim * Eigen::Index(boundary_[static_cast<std::size_t>(k)]);
    squares[k] = (x - poses_[pose].target).template segment<dim>(i).squaredNorm();
  }
  return squares;
}

template <int dim>
void MaterialDesign<dim>::measure(State& state) const
{
  state.distance = state.largest = 0;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Vec squares = squared_distances(i, state.x[i]);
    state.distance += squares.mean() / double(poses_.size());
    state.largest = std::max(state.largest, squares.maxCoeff());
  }
}

// Of the squared coordinate differences in f, (dim n) [1/m^2].
template <int dim>
Vec MaterialDesign<dim>::distance_weights(std::size_t pose, const State& state, const MaterialWeights& weights) const
{
  const Vec squares = squared_distances(pose, state.x[pose]);
  Vec result = Vec::Zero(state.x[pose].size());
  for (Eigen::Index k = 0; k < squares.size(); ++k) {
    const double weight =
        1.0 / double(squares.size() * std::ssize(poses_)) + (squares[k] == state.largest ? weights.largest : 0.0);
    result.template segment<dim>(dim * Eigen::Index(boundary_[static_cast<std::size_t>(k)]))
        .setConstant(weight / (weights.length * weights.length));
  }
  return result;
}

template <int dim>
std::optional<typename MaterialDesign<dim>::State> MaterialDesign<dim>::start(const Vec& rho) const
{
  State starts{rho, {}, 0, 0};
  for (const MaterialPose<dim>& pose : poses_) starts.x.push_back(pose.start);
  return restart(starts, rho);
}

template <int dim>
std::optional<typename MaterialDesign<dim>::State> MaterialDesign<dim>::restart(const State& from, const Vec& rho) const
{
  State state{rho, {}, 0, 0};
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    auto x = equilibrium(i, rho, from.x[i], {}, {});
    if (!x) return std::nullopt;
    state.x.push_back(std::move(*x));
  }
  measure(state);
  return state;
}

template <int dim>
std::optional<typename MaterialDesign<dim>::State> MaterialDesign<dim>::move(const State& from, const Vec& rho,
                                                                             const std::vector<Vec>& guess) const
{
  NewtonOptions options;
  options.max_iterations = limits_.max_iterations;
  State state{rho, {}, 0, 0};
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    auto x = equilibrium(i, rho, from.x[i], guess.empty() ? Vec() : Vec(from.x[i] + guess[i]), options);
    if (!x || largest_nodal_norm(*x - from.x[i], dim) > limits_.largest_displacement) {
      ++refused_moves_;
      return std::nullopt;
    }
    state.x.push_back(std::move(*x));
  }
  measure(state);
  return state;
}

template <int dim>
double MaterialDesign<dim>::objective(const State& state, const MaterialWeights& weights) const
{
  const Vec& rho = state.rho;
  return (state.distance + weights.largest * state.largest) / (weights.length * weights.length) +
         (weights.crisp * rho.dot((1 - rho.array()).matrix()) + weights.smooth * (smoothing_ * rho).squaredNorm() +
          weights.soft * rho.squaredNorm()) /
             double(rho.size());
}

template <int dim>
const SparseMatrix& MaterialDesign<dim>::regulariser_hessian(const MaterialWeights& weights) const
{
  const double per_element = 2.0 / body_.element_count();
  regulariser_ = weights.smooth * per_element * smoothing_hessian_;
  shift_diagonal(regulariser_, weights.soft * per_element);
  return regulariser_;
}

template <int dim>
bool MaterialDesign<dim>::linearize(const State& state, const MaterialWeights& weights)
{
  const Vec& rho = state.rho;
  gradient_ = regulariser_hessian(weights) * rho + weights.crisp / double(rho.size()) * (1 - 2 * rho.array()).matrix();
  SparseMatrix K;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const FixedDofs& fixed = poses_[i].fixed;
    potential(poses_[i], rho).hessian(state.x[i], K);
    fixed.project(K, K.diagonal().cwiseAbs().mean());
    if (!tangents_[i].cholesky(K)) return false;
    body_.mixed_hessian(state.x[i], rho, mixed_[i]);
    if (fixed.free.size() > 0) mixed_[i] = fixed.free.asDiagonal() * mixed_[i];
    distance_weights_[i] = distance_weights(i, state, weights);
    const Vec adjoint = tangents_[i].solve(2 * distance_weights_[i].cwiseProduct(state.x[i] - poses_[i].target));
    gradient_ -= mixed_[i].transpose() * adjoint;
  }
  return gradient_.allFinite();
}

template <int dim>
void MaterialDesign<dim>::gradient(Vec& g) const
{
  g = gradient_;
}

template <int dim>
void MaterialDesign<dim>::distance_product(ConstVec v, Vec& Hv) const
{
  Hv.setZero(v.size());
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Vec dx = tangents_[i].solve(mixed_[i] * v);
    const Vec adjoint = tangents_[i].solve(2 * distance_weights_[i].cwiseProduct(dx));
    Hv += mixed_[i].transpose() * adjoint;
  }
}

template <int dim>
std::vector<Vec> MaterialDesign<dim>::predict(ConstVec drho) const
{
  std::vector<Vec> displacements;
  for (std::size_t i = 0; i < poses_.size(); ++i) displacements.push_back(-tangents_[i].solve(mixed_[i] * drho));
  return displacements;
}

template <int dim>
int MaterialDesign<dim>::linear_solves() const
{
  int sum = newton_factorization_.attempts();
  for (const SparseFactorization& tangent : tangents_) sum += tangent.attempts();
  return sum;
}

template class MaterialDesign<2>;
template class MaterialDesign<3>;

}  // namespace softform
