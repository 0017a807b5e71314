#include "softform/characters/tension_model.hpp"

#include "softform/linalg/nonnegative_quadratic.hpp"

namespace softform {
namespace {

constexpr double mm = 1e-3;  // [m]

// Factorises the tangent of the free coordinates; a target need not be near a stable equilibrium.
void factorize(const PosedBody& posed, const Vec& x, SparseFactorization& factorization)
{
  SparseMatrix K;
  posed.body.hessian(x, posed.densities, Projection::None, K);
  const double diagonal = K.diagonal().cwiseAbs().mean();
  posed.held.project(K, diagonal);
  if (factorization.cholesky(K)) return;
  posed.body.hessian(x, posed.densities, Projection::PositiveDefinite, K);
  posed.held.project(K, diagonal);
  shift_diagonal(K, 1e-6 * diagonal);
  factorization.cholesky(K);
}

// Displacements [mm] for unit forces at the candidates' sites, two columns a site.
Eigen::MatrixXd site_responses(const StringCandidates& candidates, const FixedDofs& held, Eigen::Index size,
                               const SparseFactorization& factorization)
{
  const auto sites = static_cast<Eigen::Index>(candidates.sites.size());
  Eigen::MatrixXd responses(size, 2 * sites);
  for (Eigen::Index k = 0; k < 2 * sites; ++k) {
    Vec load = Vec::Zero(size);
    for (const BoundaryWeight& w : candidates.sites[static_cast<std::size_t>(k / 2)].weights)
      load[2 * w.vertex + k % 2] = w.value;
    held.project(load);
    responses.col(k) = factorization.solve(load) / mm;
  }
  return responses;
}

}  // namespace

TensionModel::TensionModel(const PosedBody& posed, const StringCandidates& candidates, double tension_weight)
{
  SparseFactorization factorization;
  for (const Vec& x : posed.targets) {
    factorize(posed, x, factorization);
    Vec g;
    posed.body.gradient(x, posed.densities, g);
    posed.held.project(g);
    const Vec offset = -factorization.solve(g) / mm;
    const Eigen::MatrixXd responses = site_responses(candidates, posed.held, x.size(), factorization);
    Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(responses.cols(), candidates.count());
    for (int j = 0; j < candidates.count(); ++j)
      directions.col(j).segment<2>(2 * static_cast<Eigen::Index>(candidates.lines[static_cast<std::size_t>(j)].site)) =
          candidates.direction(j, x);
    const Eigen::MatrixXd gram = responses.transpose() * responses;
    poses_.push_back({offset.squaredNorm() / 2, directions.transpose() * (responses.transpose() * offset),
                      directions.transpose() * (gram * directions)});
    poses_.back().M.diagonal().array() += tension_weight;
  }
}

std::vector<Vec> TensionModel::best_tensions(const std::vector<int>& chosen) const
{
  std::vector<Vec> tensions;
  for (const Pose& pose : poses_) tensions.push_back(nonnegative_minimum(pose.M(chosen, chosen), pose.q(chosen)));
  return tensions;
}

double TensionModel::least_error(const std::vector<int>& chosen) const
{
  const std::vector<Vec> tensions = best_tensions(chosen);
  double sum = 0;
  // At the minimum  tau . M tau = -q . tau.
  for (std::size_t i = 0; i < poses_.size(); ++i) sum += poses_[i].constant + poses_[i].q(chosen).dot(tensions[i]) / 2;
  return sum;
}

}  // namespace softform
