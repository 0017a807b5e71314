#include "softform/inflatables/pattern_objectives.hpp"

#include <cmath>
#include <map>
#include <set>

#include "softform/fem/membrane_element.hpp"
#include "softform/inflatables/inflatable.hpp"
#include "softform/inflatables/seam_lengths.hpp"
#include "softform/objectives/linear_least_squares.hpp"
#include "softform/objectives/sampled_distance.hpp"

namespace softform {
namespace {

/// Collects the rows of A x - b, `dimension` of them at a time.
class LinearResiduals {
 public:
  LinearResiduals(int dimension, int vertex_count, double unit_length)
      : dimension_(dimension), columns_(dimension * vertex_count), unit_(unit_length)
  {}

  /// weight (sum_i c_i x_i - b) / unit, b (dimension) [m].
  void add(const std::vector<std::pair<int, double>>& coefficients, double weight, const Vec& b)
  {
    for (int k = 0; k < dimension_; ++k) {
      for (const auto& [vertex, c] : coefficients)
        entries_.emplace_back(rows(), dimension_ * vertex + k, weight * c / unit_);
      b_.push_back(weight * b[k] / unit_);
    }
  }
  std::shared_ptr<const Objective> objective() const
  {
    SparseMatrix A(rows(), columns_);
    A.setFromTriplets(entries_.begin(), entries_.end());
    return std::make_shared<LinearLeastSquares>(A, Eigen::Map<const Vec>(b_.data(), rows()));
  }

 private:
  int rows() const { return static_cast<int>(b_.size()); }

  int dimension_, columns_;
  double unit_;
  std::vector<Eigen::Triplet<double>> entries_;
  std::vector<double> b_;
};

/// (6.18): the nodes of a seam at their places on the target.
std::shared_ptr<const Objective> seam_places(const PanelLayout& layout, double unit_length)
{
  LinearResiduals residuals(3, layout.node_count(), unit_length);
  std::map<int, double> weights;  // of the nodes; where seams meet, that of the most important one
  for (const Seam& seam : layout.seams)
    for (const int v : seam.sides[0].vertices) {
      double& weight = weights[layout.node_of[std::size_t(v)]];
      weight = std::max(weight, seam.weight);
    }
  for (const auto& [node, weight] : weights)
    if (weight > 0) residuals.add({{node, 1}}, std::sqrt(weight), layout.nodes.row(node).transpose());
  return residuals.objective();
}

/// (6.20): second differences along the sides of the seams; corners are their ends.
std::shared_ptr<const Objective> boundary_smoothness(const PanelLayout& layout, double unit_length)
{
  LinearResiduals residuals(2, layout.vertex_count(), unit_length);
  for (const Seam& seam : layout.seams)
    for (const SeamSide& side : seam.sides) {
      const std::vector<int>& v = side.vertices;
      const std::size_t last = v.size() - 1;
      for (std::size_t i = 1; i < last; ++i) residuals.add({{v[i - 1], 1}, {v[i], -2}, {v[i + 1], 1}}, 1, Vec::Zero(2));
      if (v[0] == v[last]) residuals.add({{v[last - 1], 1}, {v[0], -2}, {v[1], 1}}, 1, Vec::Zero(2));
    }
  return residuals.objective();
}

using Weights = std::vector<std::map<int, double>>;  // of the neighbours of every vertex

/// Mean value weights tan(a/2) + tan(b/2) over the length, a and b the angles beside the edge (Floater 2003).
void add_mean_value(const PanelLayout& layout, int t, Weights& weights)
{
  for (int k = 0; k < 3; ++k) {
    const int i = layout.triangles(t, k), j = layout.triangles(t, (k + 1) % 3), l = layout.triangles(t, (k + 2) % 3);
    const Eigen::Vector2d u = layout.flat.row(j) - layout.flat.row(i), v = layout.flat.row(l) - layout.flat.row(i);
    const double cross = u.x() * v.y() - u.y() * v.x();
    const double half_tangent = std::tan(0.5 * std::atan2(std::abs(cross), u.dot(v)));
    weights[std::size_t(i)][j] += half_tangent / u.norm();
    weights[std::size_t(i)][l] += half_tangent / v.norm();
  }
}

/// (6.21): interior vertices at the weighted mean of their neighbours.
std::shared_ptr<const Objective> interior_smoothness(const PanelLayout& layout, double unit_length,
                                                     InteriorLaplacian laplacian)
{
  Weights weights(static_cast<std::size_t>(layout.vertex_count()));
  for (int t = 0; t < layout.triangle_count(); ++t) {
    if (laplacian == InteriorLaplacian::MeanValue) {
      add_mean_value(layout, t, weights);
    } else {
      for (int k = 0; k < 3; ++k)
        for (const int other : {layout.triangles(t, (k + 1) % 3), layout.triangles(t, (k + 2) % 3)})
          weights[std::size_t(layout.triangles(t, k))][other] = 1;
    }
  }
  std::set<int> boundary;
  for (int panel = 0; panel < static_cast<int>(layout.panels.size()); ++panel)
    for (const std::vector<int>& loop : boundary_loops(layout, panel)) boundary.insert(loop.begin(), loop.end());

  LinearResiduals residuals(2, layout.vertex_count(), unit_length);
  for (int v = 0; v < layout.vertex_count(); ++v) {
    if (boundary.count(v) > 0) continue;
    double sum = 0;
    for (const auto& [other, weight] : weights[std::size_t(v)]) sum += weight;
    std::vector<std::pair<int, double>> coefficients{{v, -1}};
    for (const auto& [other, weight] : weights[std::size_t(v)]) coefficients.emplace_back(other, weight / sum);
    residuals.add(coefficients, 1, Vec::Zero(2));
  }
  return residuals.objective();
}

}  // namespace

Vec flat_areas(const PanelLayout& layout)
{
  const Vec flat = flat_vector(layout);
  Vec areas(layout.triangle_count());
  for (int t = 0; t < layout.triangle_count(); ++t)
    areas[t] = FlatTriangleEdges(flat, layout.triangles(t, 0), layout.triangles(t, 1), layout.triangles(t, 2))
                   .products()
                   .area();
  return areas;
}

std::vector<WeightedObjective> state_objectives(const PanelLayout& layout, std::shared_ptr<const ImlsField> target,
                                                double unit_length, const PatternWeights& weights)
{
  const Triangles triangles = node_triangles(layout);
  int skin_triangles = 0;  // skins come first
  for (const Panel& panel : layout.panels)
    if (!panel.is_wall) skin_triangles += panel.triangle_count;
  const Vec areas = flat_areas(layout).head(skin_triangles);
  return {{weights.distance, std::make_shared<SampledDistance>(triangles.topRows(skin_triangles), layout.node_count(),
                                                               areas, std::move(target), unit_length)},
          {weights.seams, seam_places(layout, unit_length)}};
}

std::vector<WeightedObjective> design_objectives(const PanelLayout& layout, double unit_length,
                                                 const PatternWeights& weights, InteriorLaplacian laplacian)
{
  return {{weights.length, std::make_shared<SeamLengths>(layout, unit_length)},
          {weights.boundary, boundary_smoothness(layout, unit_length)},
          {weights.interior, interior_smoothness(layout, unit_length, laplacian)}};
}

}  // namespace softform
