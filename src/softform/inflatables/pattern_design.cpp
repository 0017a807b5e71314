#include "softform/inflatables/pattern_design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "softform/equilibrium/rigid_motions.hpp"

namespace softform {
namespace {

/// The balance of forces (6.15), divided by the pressure on a node.
class InflatableConstraint : public EquilibriumConstraint {
 public:
  InflatableConstraint(const PanelLayout& layout, const InflationSettings& settings)
      : inflatable_(layout, settings.material, settings.thickness, settings.pressure),
        newton_(settings.newton),
        least_quality_(std::clamp(0.5 * smallest_quality(flat_vector(layout)), 0.0, 0.1))
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
  /// Nothing where a panel has a triangle turned over, which the energy would not notice, or nearly so: a panel that
  /// one step folds into a sliver can hardly be meshed anew.
  std::optional<Vec> equilibrium(ConstVec x, ConstVec flat) override
  {
    if (!(smallest_quality(flat) > least_quality_)) return std::nullopt;
    Equilibrium found = inflate(inflatable_, flat, x, factorization_, newton_);
    if (!found.report.converged()) return std::nullopt;
    return std::move(found.x);
  }
  int linear_solves() const override { return factorization_.attempts(); }

 private:
  // Of all triangles the least signed area over the sum of the squared edges, 1 for equilateral ones.
  double smallest_quality(ConstVec flat) const
  {
    const Triangles& triangles = inflatable_.membrane().rest_triangles();
    double smallest = HUGE_VAL;
    for (int t = 0; t < triangles.rows(); ++t) {
      const FlatTriangleEdges e(flat, triangles(t, 0), triangles(t, 1), triangles(t, 2));
      const double doubled_area = e.u.x() * e.v.y() - e.u.y() * e.v.x();
      smallest = std::min(smallest, doubled_area / (e.u.squaredNorm() + e.v.squaredNorm() + (e.u - e.v).squaredNorm()));
    }
    return 2 * std::sqrt(3.0) * smallest;
  }

  Inflatable inflatable_;
  NewtonOptions newton_;
  double least_quality_;  // of a design's triangles
  SparseFactorization factorization_;
  SparseMatrix K_;
};

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
  design.constraint = std::make_shared<InflatableConstraint>(layout, inflation);
  design.x0 = x0;
  design.p0 = flat_vector(layout);
  design.state_terms = state_objectives(layout, std::move(target), objectives.unit_length, objectives.weights);
  design.design_terms = design_objectives(layout, objectives.unit_length, objectives.weights, objectives.laplacian);
  design.metric = [metric](ConstVec flat, SparseMatrix& D) { metric->evaluate(flat, D); };
  return std::make_unique<FullSpaceProgram>(std::move(design), "pattern optimisation (6.16)");
}

}  // namespace softform
