#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <CGAL/Side_of_triangle_mesh.h>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/core/parallel.hpp"
#include "softform/mesh/cgal_mesh_internal.hpp"
#include "softform/mesh/distance.hpp"
#include "softform/mesh/solids.hpp"

namespace softform {
namespace {

using Cell = std::array<int, 3>;

// The signed distance of a solid, negative inside.
class SignedDistance {
 public:
  explicit SignedDistance(const TriangleMesh& solid)
      : surface_(cgal::to_surface_mesh(solid).value()), distance_(solid), side_(surface_)
  {
    side_(cgal::point(solid.vertices, 0));  // builds its tree, before queries run in parallel
  }
  double operator()(const Vec3& p) const
  {
    const bool is_inside = side_({p.x(), p.y(), p.z()}) == CGAL::ON_BOUNDED_SIDE;
    return is_inside ? -distance_.distance(p) : distance_.distance(p);
  }

 private:
  cgal::SurfaceMesh surface_;
  SurfaceDistance distance_;
  CGAL::Side_of_triangle_mesh<cgal::SurfaceMesh, cgal::Kernel> side_;
};

// The values of a distance field minus a level on a grid, exact near the level and of the right sign elsewhere.
class Grid {
 public:
  Grid(const TriangleMesh& solid, double level, double cell) : cell_(cell)
  {
    constexpr double most_points = 5e7;
    lower_ = solid.vertices.colwise().minCoeff().transpose().array() - 1.5 * cell;
    const Vec3 extent = solid.vertices.colwise().maxCoeff().transpose().array() + 1.5 * cell - lower_.array();
    if (!((extent / cell).prod() < most_points))
      throw InputError(fmt::format("cells of {:.3g} are too fine for a solid of {:.3g}", cell, extent.maxCoeff()));
    // Whole blocks, with one layer of points more.
    for (std::size_t d = 0; d < 3; ++d)
      points_[d] = block * static_cast<int>(std::ceil(extent[Eigen::Index(d)] / (block * cell))) + 1;
    values_.resize(std::size_t(points_[0]) * std::size_t(points_[1]) * std::size_t(points_[2]));
    sample(SignedDistance(solid), level);
  }

  const Cell& points() const { return points_; }
  std::int64_t index(const Cell& p) const
  {
    return p[0] + std::int64_t(points_[0]) * (p[1] + std::int64_t(points_[1]) * p[2]);
  }
  double value(std::int64_t index) const { return values_[std::size_t(index)]; }
  Vec3 position(const Cell& p) const { return lower_ + cell_ * Vec3(p[0], p[1], p[2]); }

 private:
  static constexpr int block = 4;

  // A block whose centre is farther from the level than its corners are from its centre has one sign.
  void sample(const SignedDistance& distance, double level)
  {
    const Cell blocks{points_[0] / block + 1, points_[1] / block + 1, points_[2] / block + 1};
    parallel_for(blocks[0] * blocks[1] * blocks[2], [&](int b) {
      const Cell first{block * (b % blocks[0]), block * (b / blocks[0] % blocks[1]),
                       block * (b / (blocks[0] * blocks[1]))};
      const double half = 0.5 * (block - 1);
      const double middle = distance(position(first) + cell_ * Vec3::Constant(half)) - level;
      const bool is_far = std::abs(middle) > 1.01 * std::sqrt(3.0) * (half + 1) * cell_;
      for (int k = 0; k < block * block * block; ++k) {
        const Cell p{first[0] + k % block, first[1] + k / block % block, first[2] + k / (block * block)};
        if (p[0] >= points_[0] || p[1] >= points_[1] || p[2] >= points_[2]) continue;
        values_[std::size_t(index(p))] = is_far ? middle : distance(position(p)) - level;
      }
    });
  }

  double cell_;
  Vec3 lower_;
  Cell points_{};
  std::vector<double> values_;
};

// Marching tetrahedra: every cell is cut into six tetrahedra around its diagonal, the same way, so that neighbours fit
// and the surface is closed. Negative is inside.
class Marching {
 public:
  explicit Marching(const Grid& grid) : grid_(grid) {}

  TriangleMesh surface()
  {
    const Cell& n = grid_.points();
    for (int z = 0; z + 1 < n[2]; ++z)
      for (int y = 0; y + 1 < n[1]; ++y)
        for (int x = 0; x + 1 < n[0]; ++x) march({x, y, z});
    TriangleMesh mesh{Positions(Eigen::Index(vertices_.size()), 3), Triangles(Eigen::Index(triangles_.size()), 3)};
    for (std::size_t i = 0; i < vertices_.size(); ++i) mesh.vertices.row(Eigen::Index(i)) = vertices_[i];
    for (std::size_t t = 0; t < triangles_.size(); ++t) mesh.triangles.row(Eigen::Index(t)) = triangles_[t];
    return mesh;
  }

 private:
  void march(const Cell& cell)
  {
    std::array<Cell, 8> corners{};
    int inside = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      corners[k] = {cell[0] + int(k & 1), cell[1] + int(k >> 1 & 1), cell[2] + int(k >> 2)};
      inside += is_inside(corners[k]) ? 1 : 0;
    }
    if (inside == 0 || inside == 8) return;
    // From corner 0 to corner 7 along three edges in every order; the sign of the order is the orientation.
    for (const auto& [a, b] : {std::pair{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}}) {
      // (b after a turns one way around the diagonal where the path is even: a has one bit, b two, or the reverse.)
      const bool a_is_first = a == 1 || a == 2 || a == 4;
      march_tetrahedron(
          {corners[0], corners[std::size_t(a_is_first ? a : b)], corners[std::size_t(a_is_first ? b : a)], corners[7]},
          a_is_first);
    }
  }

  void march_tetrahedron(std::array<Cell, 4> p, bool is_even)
  {
    // Inside corners first; every exchange turns the tetrahedron inside out.
    for (std::size_t pass = 0; pass < 3; ++pass)
      for (std::size_t k = 0; k + 1 < 4; ++k)
        if (!is_inside(p[k]) && is_inside(p[k + 1])) {
          std::swap(p[k], p[k + 1]);
          is_even = !is_even;
        }
    const auto inside = std::count_if(p.begin(), p.end(), [this](const Cell& c) { return is_inside(c); });
    if (inside == 1) add(cut(p[0], p[1]), cut(p[0], p[2]), cut(p[0], p[3]), is_even);
    if (inside == 3) add(cut(p[0], p[3]), cut(p[1], p[3]), cut(p[2], p[3]), is_even);
    if (inside == 2) {
      const int a = cut(p[0], p[2]), b = cut(p[0], p[3]), c = cut(p[1], p[3]), d = cut(p[1], p[2]);
      add(a, b, c, is_even);
      add(a, c, d, is_even);
    }
  }

  bool is_inside(const Cell& p) const { return grid_.value(grid_.index(p)) < 0; }

  // The vertex on the grid's edge (p, q), kept off its ends so that no triangle degenerates.
  int cut(const Cell& p, const Cell& q)
  {
    constexpr double off_end = 0.02;
    const std::int64_t i = grid_.index(p), j = grid_.index(q);
    const auto [entry, is_new] = index_of_.try_emplace(std::min(i, j) * 64 + direction(p, q), int(vertices_.size()));
    if (is_new) {
      const double t = std::clamp(grid_.value(i) / (grid_.value(i) - grid_.value(j)), off_end, 1 - off_end);
      vertices_.emplace_back((1 - t) * grid_.position(p) + t * grid_.position(q));
    }
    return entry->second;
  }

  // Which of the directions with components 0 and 1 an edge has, whichever end comes first.
  static int direction(const Cell& p, const Cell& q)
  {
    return std::abs(p[0] - q[0]) + 2 * std::abs(p[1] - q[1]) + 4 * std::abs(p[2] - q[2]);
  }

  void add(int a, int b, int c, bool is_even)
  {
    if (is_even)
      triangles_.emplace_back(a, b, c);
    else
      triangles_.emplace_back(a, c, b);
  }

  const Grid& grid_;
  std::vector<Eigen::RowVector3d> vertices_;
  std::vector<Eigen::RowVector3i> triangles_;
  std::unordered_map<std::int64_t, int> index_of_;
};

}  // namespace

TriangleMesh inner_offset(const TriangleMesh& solid, double depth, double cell)
{
  if (!(depth > 0 && cell > 0))
    throw InputError(fmt::format("a wall of {} on cells of {}: both must be positive", depth, cell));
  return Marching(Grid(solid, -depth, cell)).surface();
}

}  // namespace softform
