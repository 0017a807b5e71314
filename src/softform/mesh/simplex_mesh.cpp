#include "softform/mesh/simplex_mesh.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace softform {
namespace {

// The corners of face k of an element, the one opposite to corner k, oriented outwards.
template <int dim>
std::array<int, dim> face(const Simplices<dim>& elements, int e, int k)
{
  std::array<int, dim> corners;
  for (int i = 0; i < dim; ++i) corners[static_cast<std::size_t>(i)] = elements(e, i < k ? i : i + 1);
  if (k % 2 == 1) std::swap(corners[0], corners[1]);
  return corners;
}

// The elements of every face, by its sorted corners: (element, opposite corner).
template <int dim>
auto faces_of(const Simplices<dim>& elements)
{
  std::map<std::array<int, dim>, std::vector<std::pair<int, int>>> owners;
  for (int e = 0; e < elements.rows(); ++e)
    for (int k = 0; k <= dim; ++k) {
      auto corners = face<dim>(elements, e, k);
      std::sort(corners.begin(), corners.end());
      owners[corners].emplace_back(e, k);
    }
  return owners;
}

// The orders in which a path along the axes goes from a cell's first corner to its last: one simplex each.
template <int dim>
std::vector<std::array<int, dim>> axis_orders()
{
  std::array<int, dim> order;
  std::iota(order.begin(), order.end(), 0);
  std::vector<std::array<int, dim>> orders;
  do orders.push_back(order);
  while (std::next_permutation(order.begin(), order.end()));
  return orders;
}

template <int dim>
bool is_odd(const std::array<int, dim>& order)
{
  int inversions = 0;
  for (std::size_t i = 0; i < dim; ++i)
    for (std::size_t j = 0; j < i; ++j) inversions += order[j] > order[i];
  return inversions % 2 == 1;
}

// Where vertex or cell number `index` of a grid with `counts` along the axes lies; the first axis runs fastest.
template <int dim>
std::array<int, dim> place(int index, const std::array<int, dim>& counts)
{
  std::array<int, dim> at;
  for (std::size_t a = 0; a < dim; ++a) {
    at[a] = index % counts[a];
    index /= counts[a];
  }
  return at;
}

template <int dim>
int number(const std::array<int, dim>& at, const std::array<int, dim>& counts)
{
  int index = 0;
  for (std::size_t a = dim; a-- > 0;) index = index * counts[a] + at[a];
  return index;
}

template <int dim>
int product(const std::array<int, dim>& counts)
{
  return std::accumulate(counts.begin(), counts.end(), 1, std::multiplies<>());
}

}  // namespace

template <int dim>
SimplexMesh<dim> grid(const Eigen::Matrix<double, dim, 1>& size, const std::array<int, dim>& cells)
{
  std::array<int, dim> counts = cells;
  for (int& count : counts) ++count;
  SimplexMesh<dim> mesh;
  mesh.positions.resize(dim * product<dim>(counts));
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    const auto at = place<dim>(i, counts);
    for (std::size_t a = 0; a < dim; ++a) mesh.positions[dim * i + int(a)] = at[a] * size[int(a)] / cells[a];
  }
  const auto orders = axis_orders<dim>();
  mesh.elements.resize(product<dim>(cells) * Eigen::Index(orders.size()), dim + 1);
  int e = 0;
  for (int cell = 0; cell < product<dim>(cells); ++cell) {
    const auto at = place<dim>(cell, cells);
    int mirrored_axes = 0;
    for (const int a : at) mirrored_axes += a % 2;
    for (const auto& order : orders) {
      // From the corner with even coordinates to the opposite one.
      std::array<int, dim> corner;
      for (std::size_t a = 0; a < dim; ++a) corner[a] = at[a] + at[a] % 2;
      mesh.elements(e, 0) = number<dim>(corner, counts);
      for (std::size_t step = 0; step < dim; ++step) {
        const auto a = static_cast<std::size_t>(order[step]);
        corner[a] += at[a] % 2 == 0 ? 1 : -1;
        mesh.elements(e, int(step) + 1) = number<dim>(corner, counts);
      }
      if (is_odd<dim>(order) != (mirrored_axes % 2 == 1)) std::swap(mesh.elements(e, 0), mesh.elements(e, 1));
      ++e;
    }
  }
  return mesh;
}

SimplexMesh<3> extruded(const SimplexMesh<2>& mesh, double thickness)
{
  const int n = mesh.vertex_count();
  SimplexMesh<3> plate{Vec(6 * n), Tetrahedra(3 * mesh.element_count(), 4)};
  for (int i = 0; i < 2 * n; ++i)
    plate.positions.segment<3>(3 * i) << mesh.positions.segment<2>(2 * (i % n)), i < n ? 0 : thickness;
  for (int t = 0; t < mesh.element_count(); ++t) {
    // The prism's sides are cut from their lower vertex with the smaller number: neighbours agree.
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int i, int j) { return mesh.elements(t, i) < mesh.elements(t, j); });
    std::array<int, 3> c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = mesh.elements(t, order[k]);
    plate.elements.row(3 * t) << c[0], c[1], c[2], c[2] + n;
    plate.elements.row(3 * t + 1) << c[0], c[1], c[2] + n, c[1] + n;
    plate.elements.row(3 * t + 2) << c[0], c[0] + n, c[1] + n, c[2] + n;
    if (is_odd<3>(order))
      for (int k = 0; k < 3; ++k) std::swap(plate.elements(3 * t + k, 0), plate.elements(3 * t + k, 1));
  }
  return plate;
}

template <int dim>
BoundaryFaces<dim> boundary_faces(const Simplices<dim>& elements)
{
  std::vector<std::array<int, dim>> outer;
  BoundaryFaces<dim> boundary;
  for (const auto& [corners, owners] : faces_of<dim>(elements)) {
    if (owners.size() != 1) continue;
    outer.push_back(face<dim>(elements, owners[0].first, owners[0].second));
    boundary.elements.push_back(owners[0].first);
  }
  boundary.faces.resize(Eigen::Index(outer.size()), dim);
  for (std::size_t i = 0; i < outer.size(); ++i)
    for (std::size_t k = 0; k < dim; ++k) boundary.faces(Eigen::Index(i), Eigen::Index(k)) = outer[i][k];
  return boundary;
}

template <int dim>
std::vector<int> boundary_vertices(const Simplices<dim>& elements)
{
  const auto faces = boundary_faces<dim>(elements).faces;
  const std::set<int> vertices(faces.data(), faces.data() + faces.size());
  return {vertices.begin(), vertices.end()};
}

template <int dim>
std::vector<std::vector<int>> element_neighbours(const Simplices<dim>& elements)
{
  std::vector<std::vector<int>> neighbours(static_cast<std::size_t>(elements.rows()));
  for (const auto& [corners, owners] : faces_of<dim>(elements)) {
    if (owners.size() != 2) continue;
    neighbours[static_cast<std::size_t>(owners[0].first)].push_back(owners[1].first);
    neighbours[static_cast<std::size_t>(owners[1].first)].push_back(owners[0].first);
  }
  for (auto& list : neighbours) std::sort(list.begin(), list.end());
  return neighbours;
}

template SimplexMesh<2> grid<2>(const Eigen::Vector2d&, const std::array<int, 2>&);
template SimplexMesh<3> grid<3>(const Eigen::Vector3d&, const std::array<int, 3>&);
template BoundaryFaces<2> boundary_faces<2>(const Simplices<2>&);
template BoundaryFaces<3> boundary_faces<3>(const Simplices<3>&);
template std::vector<int> boundary_vertices<2>(const Simplices<2>&);
template std::vector<int> boundary_vertices<3>(const Simplices<3>&);
template std::vector<std::vector<int>> element_neighbours<2>(const Simplices<2>&);
template std::vector<std::vector<int>> element_neighbours<3>(const Simplices<3>&);

}  // namespace softform
