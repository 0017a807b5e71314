#include "softform/characters/islands.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include "softform/mesh/disjoint_sets.hpp"
#include "softform/mesh/distance.hpp"
#include "softform/mesh/planar_mesh.hpp"

namespace softform {
namespace {

template <int dim>
using Corners = Eigen::Matrix<double, dim, dim + 1>;

template <int dim>
Corners<dim> corners_of(const SimplexMesh<dim>& mesh, int e)
{
  Corners<dim> corners;
  for (int k = 0; k <= dim; ++k) corners.col(k) = mesh.positions.template segment<dim>(dim * mesh.elements(e, k));
  return corners;
}

template <int dim>
double volume_of(const Corners<dim>& corners)
{
  return (corners.rightCols(dim).colwise() - corners.col(0)).determinant() / (dim == 2 ? 2 : 6);
}

// Centre of the inscribed ball: the corners weighted by the sizes of the faces opposite to them.
template <int dim>
Eigen::Matrix<double, dim, 1> incentre(const Corners<dim>& corners)
{
  Eigen::Matrix<double, dim + 1, 1> sizes;
  for (int k = 0; k <= dim; ++k) {
    const auto at = [&](int i) { return corners.col((k + i) % (dim + 1)); };
    if constexpr (dim == 2)
      sizes[k] = (at(2) - at(1)).norm();
    else
      sizes[k] = (at(2) - at(1)).cross(at(3) - at(1)).norm();
  }
  return corners * sizes / sizes.sum();
}

// Distances [m] of points (dim, k) to the boundary of a region.
Vec distances(const SimplexMesh<3>& mesh, const BoundaryFaces<3>& boundary, const Eigen::Matrix3Xd& points)
{
  return SurfaceDistance({unflatten(mesh.positions), boundary.faces}).distances(Positions(points.transpose()));
}

Vec distances(const SimplexMesh<2>& mesh, const BoundaryFaces<2>& boundary, const Eigen::Matrix2Xd& points)
{
  Vec result = Vec::Constant(points.cols(), std::numeric_limits<double>::infinity());
  for (const auto& edge : boundary.faces.rowwise()) {
    const Eigen::Vector2d a = mesh.positions.segment<2>(2 * edge[0]);
    const Eigen::Vector2d along = mesh.positions.segment<2>(2 * edge[1]) - a;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const Eigen::Vector2d from = points.col(i) - a;
      const double t = std::clamp(from.dot(along) / along.squaredNorm(), 0.0, 1.0);
      result[i] = std::min(result[i], (from - t * along).norm());
    }
  }
  return result;
}

// A region by itself, and how deep its points lie.
template <int dim>
class Region {
 public:
  Region(const SimplexMesh<dim>& mesh, const std::vector<int>& elements)
      : mesh_{mesh.positions, mesh.elements(elements, Eigen::all)}, boundary_(boundary_faces<dim>(mesh_.elements))
  {
    Eigen::Matrix<double, dim, Eigen::Dynamic> centres(dim, mesh_.element_count());
    for (int e = 0; e < mesh_.element_count(); ++e) centres.col(e) = incentre<dim>(corners_of<dim>(mesh_, e));
    depths_ = distances(mesh_, boundary_, centres);
  }

  double inscribed_diameter() const
  {
    const std::vector<int> outer = boundary_vertices<dim>(mesh_.elements);
    std::set<int> inner(mesh_.elements.data(), mesh_.elements.data() + mesh_.elements.size());
    for (const int i : outer) inner.erase(i);
    Eigen::Matrix<double, dim, Eigen::Dynamic> points(dim, inner.size());
    Eigen::Index k = 0;
    for (const int i : inner) points.col(k++) = mesh_.positions.template segment<dim>(dim * i);
    const double of_vertices = k > 0 ? distances(mesh_, boundary_, points).maxCoeff() : 0;
    return 2 * std::max(depths_.maxCoeff(), of_vertices);
  }

  // The parts of what lies at least half a printable size deep, joined where the way through a face is as wide. A part
  // counts where it is half as thick again: the end of a tip that tapers is none.
  int necks(double printable_size) const
  {
    const double depth = printable_size / 2;
    std::vector<std::pair<int, int>> pairs;
    const auto neighbours = element_neighbours<dim>(mesh_.elements);
    for (int e = 0; e < mesh_.element_count(); ++e)
      for (const int other : neighbours[static_cast<std::size_t>(e)])
        if (e < other && depths_[e] >= depth && depths_[other] >= depth) pairs.emplace_back(e, other);
    Eigen::Matrix<double, dim, Eigen::Dynamic> middles(dim, pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i)
      middles.col(Eigen::Index(i)) = middle_of_common_face(pairs[i].first, pairs[i].second);
    DisjointSets sets(static_cast<std::size_t>(mesh_.element_count()));
    if (!pairs.empty()) {
      const Vec depths = distances(mesh_, boundary_, middles);
      for (std::size_t i = 0; i < pairs.size(); ++i)
        if (depths[Eigen::Index(i)] >= depth) sets.unite(pairs[i].first, pairs[i].second);
    }
    std::set<int> parts;
    for (int e = 0; e < mesh_.element_count(); ++e)
      if (depths_[e] >= 1.5 * depth) parts.insert(sets.root(e));
    return std::max(0, static_cast<int>(parts.size()) - 1);
  }

 private:
  Eigen::Matrix<double, dim, 1> middle_of_common_face(int e, int other) const
  {
    Eigen::Matrix<double, dim, 1> sum = Eigen::Matrix<double, dim, 1>::Zero();
    for (const int i : mesh_.elements.row(e))
      if ((mesh_.elements.row(other).array() == i).any()) sum += mesh_.positions.template segment<dim>(dim * i);
    return sum / dim;
  }

  SimplexMesh<dim> mesh_;
  BoundaryFaces<dim> boundary_;
  Vec depths_;  // of the elements' incentres [m]
};

template <int dim>
void measure(const SimplexMesh<dim>& mesh, double printable_size, Island& island)
{
  island.lower_corner.setConstant(std::numeric_limits<double>::infinity());
  island.upper_corner = -island.lower_corner;
  for (const int e : island.elements) {
    const Corners<dim> corners = corners_of<dim>(mesh, e);
    const double volume = volume_of<dim>(corners);
    island.volume += volume;
    island.centre.template head<dim>() += volume * corners.rowwise().mean();
    auto lower = island.lower_corner.template head<dim>();
    auto upper = island.upper_corner.template head<dim>();
    lower = lower.cwiseMin(corners.rowwise().minCoeff());
    upper = upper.cwiseMax(corners.rowwise().maxCoeff());
  }
  if (dim == 2) island.lower_corner.z() = island.upper_corner.z() = 0;
  island.centre /= island.volume;
  const Region<dim> region(mesh, island.elements);
  island.inscribed_diameter = region.inscribed_diameter();
  island.necks = region.necks(printable_size);
}

}  // namespace

template <int dim>
std::vector<Island> find_islands(const SimplexMesh<dim>& mesh, const Vec& densities, double printable_size)
{
  DisjointSets sets(static_cast<std::size_t>(mesh.element_count()));
  const auto is_stiff = [&](int e) { return densities[e] >= 0.5; };
  const auto neighbours = element_neighbours<dim>(mesh.elements);
  for (int e = 0; e < mesh.element_count(); ++e)
    for (const int other : neighbours[static_cast<std::size_t>(e)])
      if (is_stiff(e) == is_stiff(other)) sets.unite(e, other);
  std::map<int, Island> by_root;
  for (int e = 0; e < mesh.element_count(); ++e) {
    Island& island = by_root[sets.root(e)];
    island.material = is_stiff(e) ? CharacterMaterial::Stiff : CharacterMaterial::Soft;
    island.elements.push_back(e);
  }
  std::vector<Island> islands;
  for (auto& [root, island] : by_root) {
    measure<dim>(mesh, printable_size, island);
    islands.push_back(std::move(island));
  }
  std::stable_sort(islands.begin(), islands.end(), [](const auto& a, const auto& b) { return a.volume > b.volume; });
  return islands;
}

template <int dim>
std::string island_table(const std::vector<Island>& islands, double printable_size)
{
  std::string text = fmt::format(
      "island,material,elements,{},x [mm],y [mm],z [mm],size_x [mm],size_y [mm],size_z [mm],inscribed_diameter "
      "[mm],necks,remark\n",
      dim == 2 ? "area [mm^2]" : "volume [mm^3]");
  const double unit = dim == 2 ? 1e6 : 1e9;
  for (std::size_t i = 0; i < islands.size(); ++i) {
    const Island& island = islands[i];
    const Vec3 at = 1e3 * island.centre, size = 1e3 * (island.upper_corner - island.lower_corner);
    text += fmt::format("{},{},{},{:.4g},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{},{}\n", i + 1,
                        island.material == CharacterMaterial::Stiff ? "stiff" : "soft", island.elements.size(),
                        unit * island.volume, at.x(), at.y(), at.z(), size.x(), size.y(), size.z(),
                        1e3 * island.inscribed_diameter, island.necks,
                        !island.is_printable(printable_size) ? "too small to print"
                        : island.necks > 0                   ? "thin necks"
                                                             : "");
  }
  return text;
}

template std::vector<Island> find_islands<2>(const SimplexMesh<2>&, const Vec&, double);
template std::vector<Island> find_islands<3>(const SimplexMesh<3>&, const Vec&, double);
template std::string island_table<2>(const std::vector<Island>&, double);
template std::string island_table<3>(const std::vector<Island>&, double);

}  // namespace softform
