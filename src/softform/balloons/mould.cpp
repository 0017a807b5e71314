#include "softform/balloons/mould.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/mesh/check.hpp"
#include "softform/mesh/slivers.hpp"
#include "softform/mesh/solids.hpp"

namespace softform {
namespace {

constexpr double no_printer_sees = 2e-6;  // of slivers where parts meet [m]
constexpr double clearance = 1e-3;        // of holes from tube and edge, and of the plate from the rest shape [m]

double in_mm(double metres) { return 1e3 * metres; }

// The mould's frame: the nozzle's centre and the tube's axis, towards the plate.
struct Frame {
  Vec3 origin;
  Eigen::Matrix3d axes;

  Vec3 axis() const { return axes.col(2); }
  Positions coordinates(const Positions& points) const { return (points.rowwise() - origin.transpose()) * axes; }
  Vec3 at(double x, double y, double z) const { return origin + axes * Vec3(x, y, z); }
};

// Distance of the screws' centres from the plate's edges.
double screw_inset(const MouldOptions& options) { return options.screw_diameter / 2 + 2 * clearance; }

void validate(const Nozzle& nozzle, const MouldOptions& options)
{
  const auto require_positive = [](double value, const char* name) {
    if (!(value > 0) || !std::isfinite(value))
      throw InputError(fmt::format("{} is {} m: it must be positive", name, value));
  };
  require_positive(options.tube_length, "the tube's length");
  for (const double side : options.plate) require_positive(side, "a side of the plate");
  if (options.screws != 0 && options.screws != 4)
    throw InputError(fmt::format("a plate with {} screw holes: there are moulds with 0 or 4", options.screws));
  const double shorter = std::min(options.plate.x(), options.plate.y());
  if (shorter / 2 < nozzle.radius + clearance)
    throw InputError(fmt::format("a plate {:.3g} mm wide does not hold a tube of {:.3g} mm: ask for {:.3g} mm or more",
                                 in_mm(shorter), in_mm(2 * nozzle.radius), in_mm(2 * (nozzle.radius + clearance))));
  if (options.screws == 4) {
    require_positive(options.screw_diameter, "the screw holes' diameter");
    const Eigen::Vector2d hole = options.plate.head<2>().array() / 2 - screw_inset(options);
    if (hole.minCoeff() <= 0 || hole.norm() < nozzle.radius + options.screw_diameter / 2 + clearance)
      throw InputError(
          fmt::format("screw holes of {:.3g} mm do not fit beside the tube on a plate of {:.3g} x {:.3g} mm: "
                      "ask for a larger plate or smaller screws",
                      in_mm(options.screw_diameter), in_mm(options.plate.x()), in_mm(options.plate.y())));
  }
  if (!options.wall) return;
  require_positive(*options.wall, "the wall");
  if (*options.wall >= 0.9 * nozzle.radius)
    throw InputError(
        fmt::format("a wall of {:.3g} mm closes a tube of {:.3g} mm: ask for a thinner wall or a solid mould",
                    in_mm(*options.wall), in_mm(2 * nozzle.radius)));
}

void require_clear_plate(const TriangleMesh& rest, const Frame& frame, const MouldOptions& options)
{
  const Positions local = frame.coordinates(rest.vertices);
  double highest = 0;
  for (const auto& p : local.rowwise())
    if (std::abs(p.x()) < options.plate.x() / 2 + clearance && std::abs(p.y()) < options.plate.y() / 2 + clearance)
      highest = std::max(highest, p.z());
  if (highest + clearance > options.tube_length)
    throw InputError(
        fmt::format("the rest shape reaches {:.3g} mm beyond the nozzle and would touch the plate: ask for a "
                    "tube of {:.3g} mm or more",
                    in_mm(highest), std::ceil(in_mm(highest + clearance))));
}

// From inside the rest shape to `end` along the axis.
TriangleMesh tube_to(double end, const TriangleMesh& rest, const Nozzle& nozzle, const Frame& frame)
{
  const Positions disc = rest.vertices(nozzle.vertices, Eigen::all);
  const double start = frame.coordinates(disc).col(2).minCoeff() - 0.25 * nozzle.radius;
  return cylinder(frame.at(0, 0, start), frame.axis(), nozzle.radius, end - start);
}

// Through the plate, near its corners.
std::vector<TriangleMesh> screw_holes(const Frame& frame, const MouldOptions& options)
{
  std::vector<TriangleMesh> holes;
  if (options.screws == 0) return holes;
  const Eigen::Vector2d hole = options.plate.head<2>().array() / 2 - screw_inset(options);
  for (const double x : {-hole.x(), hole.x()})
    for (const double y : {-hole.y(), hole.y()})
      holes.push_back(cylinder(frame.at(x, y, options.tube_length - clearance), frame.axis(),
                               options.screw_diameter / 2, options.plate.z() + 2 * clearance, 48));
  return holes;
}

// What is hollowed out of rest shape and tube: the part that opens through the plate. `closed_off` receives the volume
// of the others.
TriangleMesh bore(const TriangleMesh& rest, const Nozzle& nozzle, const Frame& frame, const MouldOptions& options,
                  double& closed_off)
{
  const double wall = *options.wall;
  const double cell = std::min(wall, nozzle.radius - wall) / 2;
  const double end = options.tube_length + options.plate.z() + wall + 3 * cell;
  const TriangleMesh outside = ExactSolid(rest).unite(tube_to(end, rest, nozzle, frame)).surface();
  std::vector<TriangleMesh> parts = parts_of(inner_offset(outside, wall, cell));
  closed_off = 0;
  std::optional<TriangleMesh> open;
  for (TriangleMesh& part : parts) {
    if (frame.coordinates(part.vertices).col(2).maxCoeff() > options.tube_length + options.plate.z())
      open = std::move(part);
    else
      closed_off += enclosed_volume(part);
  }
  const auto reaches_in = [&] { return frame.coordinates(open->vertices).col(2).minCoeff() < -nozzle.radius; };
  if (!open || !reaches_in())
    throw InputError(
        fmt::format("a wall of {:.3g} mm leaves no hollow in the rest shape that the tube opens: ask for a "
                    "thinner wall or a solid mould",
                    in_mm(wall)));
  return *open;
}

// STL and 3MF hold single precision, in millimetres: what is checked is what will be read.
void round_to_single(Positions& metres) { metres = (1e3 * metres).cast<float>().cast<double>() / 1e3; }

}  // namespace

Mould make_mould(const TriangleMesh& rest, const Nozzle& nozzle, const MouldOptions& options)
{
  validate(nozzle, options);
  const Frame frame{nozzle.position, frame_along(nozzle.axis)};
  require_clear_plate(rest, frame, options);

  Mould mould;
  const TriangleMesh tube = tube_to(options.tube_length + options.plate.z() / 2, rest, nozzle, frame);
  ExactSolid solid(rest);
  const MeshReport on_tube = check_mesh(without_slivers(solid.unite(tube).surface(), no_printer_sees));
  if (!on_tube.genus || *on_tube.genus != 0 || on_tube.components != 1)
    throw InputError(
        fmt::format("the tube of {:.3g} mm meets the rest shape in more than the nozzle: ask for another "
                    "place or a smaller nozzle",
                    in_mm(2 * nozzle.radius)));
  solid.unite(box(frame.at(0, 0, options.tube_length + options.plate.z() / 2), frame.axes, options.plate));
  for (const TriangleMesh& hole : screw_holes(frame, options)) solid.subtract(hole);
  if (options.wall) solid.subtract(bore(rest, nozzle, frame, options, mould.closed_off));
  mould.surface = without_slivers(solid.surface(), no_printer_sees);
  round_to_single(mould.surface.vertices);
  require_closed_surface(mould.surface, "the mould");
  mould.genus = check_mesh(mould.surface).genus.value();
  return mould;
}

}  // namespace softform
