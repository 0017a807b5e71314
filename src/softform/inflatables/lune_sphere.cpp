#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "softform/inflatables/panel_layout.hpp"

namespace softform {
namespace {

/// Vertices in rings between the poles, ring i < 2 rows of 3 min(i, 2 rows - i) vertices; the poles are rings of one.
class RingNumbering {
 public:
  explicit RingNumbering(int rows) : rows_(rows) {}

  int columns(int ring) const { return 3 * std::min(ring, 2 * rows_ - ring); }
  int vertex_count() const { return first(2 * rows_) + 1; }
  int operator()(int ring, int column) const
  {
    return ring == 0 || ring == 2 * rows_ ? first(ring) : first(ring) + column % columns(ring);
  }

 private:
  /// 1 + 3 (1 + 2 + ... ) before the ring, counted from the nearer pole.
  int first(int ring) const
  {
    const auto cap = [](int n) { return 1 + 3 * n * (n - 1) / 2; };
    const int all = 2 + 3 * rows_ * rows_;
    return ring == 0 ? 0 : ring <= rows_ ? cap(ring) : all - cap(2 * rows_ - ring + 1);
  }
  int rows_;
};

TriangleMesh ring_sphere(double radius, int rows)
{
  const RingNumbering number(rows);
  TriangleMesh mesh;
  mesh.vertices.resize(number.vertex_count(), 3);
  for (int ring = 0; ring <= 2 * rows; ++ring) {
    const double polar = std::numbers::pi * ring / (2 * rows);
    const int columns = std::max(1, number.columns(ring));
    for (int c = 0; c < columns; ++c) {
      const double longitude = 2 * std::numbers::pi * c / columns;
      mesh.vertices.row(number(ring, c)) << std::sin(polar) * std::cos(longitude),
          std::sin(polar) * std::sin(longitude), std::cos(polar);
    }
  }
  mesh.vertices *= radius;

  mesh.triangles.resize(6 * rows * rows, 3);
  int t = 0;
  for (int lune = 0; lune < 3; ++lune) {
    // From each pole: row i has i columns of the lune, joined with the i + 1 of the next.
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j <= i; ++j) {
        const auto north = [&](int ring, int k) { return number(ring, lune * ring + k); };
        const auto south = [&](int ring, int k) { return number(2 * rows - ring, lune * ring + k); };
        mesh.triangles.row(t++) << north(i, j), north(i + 1, j), north(i + 1, j + 1);
        mesh.triangles.row(t++) << south(i, j), south(i + 1, j + 1), south(i + 1, j);
        if (j == i) continue;
        mesh.triangles.row(t++) << north(i, j), north(i + 1, j + 1), north(i, j + 1);
        mesh.triangles.row(t++) << south(i, j), south(i, j + 1), south(i + 1, j + 1);
      }
    }
  }
  return mesh;
}

}  // namespace

PanelLayout three_lune_sphere(double radius, int rows)
{
  std::vector<SeamChain> meridians;
  const RingNumbering number(rows);
  for (int lune = 0; lune < 3; ++lune) {
    SeamChain& chain = meridians.emplace_back(SeamChain{"meridian " + std::to_string(120 * lune), 0, {}});
    for (int ring = 0; ring <= 2 * rows; ++ring)
      chain.vertices.push_back(number(ring, lune * number.columns(ring) / 3));
  }
  PanelLayout layout = split_along(ring_sphere(radius, rows), meridians);

  for (int lune = 0; lune < 3; ++lune) {
    const Panel& panel = layout.panels[static_cast<std::size_t>(lune)];
    const double middle = 2 * std::numbers::pi * (lune + 0.5) / 3;
    for (int v = panel.first_vertex; v < panel.first_vertex + panel.vertex_count; ++v) {
      const Vec3 node = layout.nodes.row(layout.node_of[static_cast<std::size_t>(v)]) / radius;
      const double from_axis = std::hypot(node.x(), node.y());
      const double longitude = std::remainder(std::atan2(node.y(), node.x()) - middle, 2 * std::numbers::pi);
      layout.flat.row(v) << radius * from_axis * longitude, radius * std::atan2(node.z(), from_axis);
    }
  }
  return layout;
}

}  // namespace softform
