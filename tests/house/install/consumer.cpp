#include <cmath>

#include "softform/core/units.hpp"
#include "softform/mesh/triangle_mesh.hpp"

/// The volume of a corner of a cube of 3 cm: 27/6 cm^3.
int main()
{
  const double side = softform::parse_length("3cm");
  softform::TriangleMesh corner;
  corner.vertices.resize(4, 3);
  corner.vertices << 0, 0, 0, side, 0, 0, 0, side, 0, 0, 0, side;
  corner.triangles.resize(4, 3);
  corner.triangles << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
  return std::abs(softform::enclosed_volume(corner) - 4.5e-6) < 1e-15 ? 0 : 1;
}
