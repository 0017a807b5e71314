#include "softform/mesh/disc.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {

TriangleMesh disc(double radius, int rings)
{
  if (!(radius > 0) || rings < 2)
    throw InputError(
        fmt::format("a disc of radius {} m and {} rings: give a positive radius and 2 rings or more", radius, rings));
  TriangleMesh mesh;
  mesh.vertices.setZero(disc_vertex_count(rings), 3);
  mesh.triangles.resize(6 * rings * rings, 3);
  const auto index = [](int ring, int place) {
    return ring == 0 ? 0 : disc_vertex_count(ring - 1) + place % (6 * ring);
  };
  Eigen::Index t = 0;
  for (int ring = 1; ring <= rings; ++ring) {
    for (int place = 0; place < 6 * ring; ++place) {
      const double angle = 2 * std::numbers::pi * place / (6 * ring), distance = radius * ring / rings;
      mesh.vertices.row(index(ring, place)) << distance * std::cos(angle), distance * std::sin(angle), 0;
    }
    // The strip to the ring inside, sector by sector: `ring` triangles that stand on this ring, one less on the other.
    for (int sector = 0; sector < 6; ++sector) {
      for (int i = 0; i < ring; ++i) {
        const int outer = sector * ring + i, inner = sector * (ring - 1) + i;
        mesh.triangles.row(t++) << index(ring - 1, inner), index(ring, outer), index(ring, outer + 1);
        if (i + 1 < ring)
          mesh.triangles.row(t++) << index(ring - 1, inner), index(ring, outer + 1), index(ring - 1, inner + 1);
      }
    }
  }
  return mesh;
}

}  // namespace softform
