#include "softform/inflatables/pattern_design.hpp"

#include <limits>
#include <set>
#include <utility>

#include "softform/equilibrium/rigid_motions.hpp"
#include "softform/inflatables/stability_barrier.hpp"

namespace softform {
namespace {

/// The balance of forces (6.15), divided by the pressure on a node.
class InflatableConstraint : public EquilibriumConstraint {
 public:
  InflatableConstraint(const PanelLayout& layout, const InflationSettings& settings,
                       const PatternObjectiveSettings& objectives)
      : inflatable_(layout, settings.material, settings.thickness, settings.pressure),
        newton_(settings.newton),
        least_quality_(objectives.least_quality)
  {}

  void forces(ConstVec x, ConstVec flat, Vec& f) override
  {
    inflatable_.gradient(x, flat, f);
    f /= inflatable_.force_scale();
  }
  void state_jacobian(ConstVec x, ConstVec flat, SparseMatrix& K) override
  {
    inflatable_.hessian(x, flat, K);
    K.coeffs() /= inflatable_.force_scale();
  }
  void design_jacobian(ConstVec x, ConstVec flat, SparseMatrix& B) override
  {
    inflatable_.mixed_hessian(x, flat, B);
    B.coeffs() /= inflatable_.force_scale();
  }
  void force_hessian(ConstVec x, ConstVec flat, ConstVec lambda, SparseMatrix& xx, SparseMatrix& mixed,
                     SparseMatrix& XX) override
  {
    inflatable_.force_hessian(x, flat, lambda / inflatable_.force_scale(), xx, mixed, XX);
  }
  Vec solve_state(ConstVec x, ConstVec flat, const Vec& b) override
  {
    state_jacobian(x, flat, K_);
    shift_diagonal(K_, newton_.rigid_shift * K_.diagonal().cwiseAbs().mean());
    if (!factorization_.cholesky(K_)) return Vec::Constant(b.size(), std::numeric_limits<double>::quiet_NaN());
    return without_rigid_motions(factorization_.solve(without_rigid_motions(b, x)), x);
  }
  /// Nothing where a panel has a triangle turned over or worse than it may be, which the energy would not notice.
  std::optional<Vec> equilibrium(ConstVec x, ConstVec flat) override
  {
    const Vec quality = flat_quality(flat, inflatable_.membrane().rest_triangles());
    if (!(quality.minCoeff<Eigen::PropagateNaN>() > least_quality_)) return std::nullopt;
    Equilibrium found = inflate(inflatable_, flat, x, factorization_, newton_);
    if (!found.report.converged()) return std::nullopt;
    return std::move(found.x);
  }
  const Inflatable& inflatable() const { return inflatable_; }
  int linear_solves() const override { return factorization_.attempts(); }

 private:
  Inflatable inflatable_;
  NewtonOptions newton_;
  double least_quality_;  // of a design's triangles
  SparseFactorization factorization_;
  SparseMatrix K_;
};

/// Areas around the nodes (3n), the pressure on them over the size: what stiffness the stability barrier begins at.
Vec stability_masses(const PanelLayout& layout, const Inflatable& inflatable, double unit_length)
{
  const Triangles triangles = node_triangles(layout);
  const Vec areas = flat_areas(layout);
  Vec masses = Vec::Zero(3 * Eigen::Index(layout.node_count()));
  for (int t = 0; t < triangles.rows(); ++t)
    for (const int node : triangles.row(t)) masses.segment<3>(3 * Eigen::Index(node)).array() += areas[t] / 3;
  return masses * (inflatable.pressure() / (unit_length * inflatable.force_scale()));
}

/// sum_e (t_e . (dX_j - dX_i))^2 / l_e^2 over the edges of the flat panels, t_e their directions and l_e their lengths.
class EdgeStrainMetric {
 public:
  explicit EdgeStrainMetric(const PanelLayout& layout)
  {
    std::set<std::pair<int, int>> edges;
    for (int t = 0; t < layout.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k) edges.insert(std::minmax(layout.triangles(t, k), layout.triangles(t, (k + 1) % 3)));
    edges_.assign(edges.begin(), edges.end());
  }

  void evaluate(ConstVec flat, SparseMatrix& D) const
  {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(16 * edges_.size());
    for (const auto& [i, j] : edges_) {
      const Eigen::Vector2d e = flat.segment<2>(2 * Eigen::Index(j)) - flat.segment<2>(2 * Eigen::Index(i));
      const Eigen::Matrix2d block = e * e.transpose() / (e.squaredNorm() * e.squaredNorm());
      for (int r = 0; r < 2; ++r)
        for (int c = 0; c < 2; ++c) {
          entries.emplace_back(2 * i + r, 2 * i + c, block(r, c));
          entries.emplace_back(2 * j + r, 2 * j + c, block(r, c));
          entries.emplace_back(2 * i + r, 2 * j + c, -block(r, c));
          entries.emplace_back(2 * j + r, 2 * i + c, -block(r, c));
        }
    }
    D.resize(flat.size(), flat.size());
    D.setFromTriplets(entries.begin(), entries.end());
  }

 private:
  std::vector<std::pair<int, int>> edges_;
};

}  // namespace

std::unique_ptr<FullSpaceProgram> pattern_program(const PanelLayout& layout, const Vec& x0,
                                                  const InflationSettings& inflation,
                                                  std::shared_ptr<const ImlsField> target,
                                                  const PatternObjectiveSettings& objectives)
{
  const auto metric = std::make_shared<EdgeStrainMetric>(layout);
  InverseDesign design;
  const auto constraint = std::make_shared<InflatableConstraint>(layout, inflation, objectives);
  design.constraint = constraint;
  if (const double weight = objectives.weights.stability * layout.node_count(); weight > 0)
    design.coupled_term = std::make_shared<StabilityBarrier>(
        constraint, stability_masses(layout, constraint->inflatable(), objectives.unit_length), weight);
  design.x0 = x0;
  design.p0 = flat_vector(layout);
  design.state_terms = state_objectives(layout, std::move(target), objectives.unit_length, objectives.weights);
  design.design_terms = design_objectives(layout, objectives.unit_length, objectives.weights, objectives.laplacian);
  design.metric = [metric](ConstVec flat, SparseMatrix& D) { metric->evaluate(flat, D); };
  return std::make_unique<FullSpaceProgram>(std::move(design), "pattern optimisation (6.16)");
}

}  // namespace softform
