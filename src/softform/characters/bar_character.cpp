#include "softform/characters/bar_character.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/io/vtk_io.hpp"

namespace softform {
namespace {

SimplexMesh<3> bar_mesh(const BarOptions& options)
{
  for (const int cells : options.cells)
    if (cells < 1) throw InputError(fmt::format("bar: {} cells along an axis; give at least one", cells));
  if (!(options.size.minCoeff() > 0)) throw InputError("bar: all three sizes must be positive");
  if (options.cap_cells < 1 || 2 * options.cap_cells >= options.cells[0])
    throw InputError(fmt::format("bar: caps of {} cells at both ends of {}: they must leave cells between them",
                                 options.cap_cells, options.cells[0]));
  return grid<3>(options.size, options.cells);
}

Mixture bar_mixture(const BarOptions& options)
{
  const auto material = [&](double shear_modulus) {
    return neo_hookean_solid(shear_modulus, bulk_modulus(shear_modulus, options.poisson_ratio));
  };
  return {material(options.soft_shear_modulus), material(options.contrast * options.soft_shear_modulus),
          MixturePath::Geometric};
}

}  // namespace

BarCharacter::BarCharacter(const BarOptions& options, std::vector<Bend> bends)
    : options_(options),
      bends_(std::move(bends)),
      mesh_(bar_mesh(options)),
      body_(mesh_.elements, mesh_.positions, bar_mixture(options)),
      caps_(end_caps(mesh_, options.cap_cells * options.size.x() / options.cells[0]))
{
  for (const Bend& bend : bends_)
    if (!(bend.end - bend.begin > 2 * bend_fade) || bend.begin < 0 || bend.end > options.size.x())
      throw InputError(fmt::format("bar: a bend from {} to {} m must lie on the bar and be longer than {} m",
                                   bend.begin, bend.end, 2 * bend_fade));
}

double BarCharacter::turn() const
{
  double sum = 0;
  for (const Bend& bend : bends_) sum += bend.angle;
  return std::abs(sum);
}

PoseTrace BarCharacter::trace(const Vec& densities) const
{
  return trace_pose<3>(LoadedSolid<3>(body_, densities), caps_, [this](double fraction) { return pose(fraction); });
}

MaterialLayout<3> BarCharacter::optimize(const Vec& uniform_pose, const LayoutObserver& observer) const
{
  MaterialDesign<3> design(body_, {{pose(1), uniform_pose, caps_, {}, {}, {}}});
  const auto first = design.start(Vec::Constant(body_.element_count(), options_.first_density));
  if (!first) {
    MaterialLayout<3> failed;
    failed.report.termination = Termination::Infeasible;
    failed.report.message = "the uniform bar has no equilibrium in this pose";
    return failed;
  }
  return optimize_layout<3>(design, *first, options_.layout, observer);
}

void BarCharacter::write(const std::filesystem::path& stem, const Vec& x, const Vec& densities) const
{
  const char* name = "density [1]";
  write_vtu<3>(stem.string() + ".vtu", {x, mesh_.elements}, {}, {{name, densities}});
  const BoundaryFaces<3> boundary = boundary_faces<3>(mesh_.elements);
  const Vec of_faces = densities(boundary.elements);
  write_vtp(stem.string() + ".vtp", {unflatten(x), boundary.faces}, {{}, {{name, of_faces}}});
}

std::vector<QuestionMark> question_marks()
{
  const auto bend = [](double begin_mm, double end_mm, double degrees) {
    return Bend{begin_mm * 1e-3, end_mm * 1e-3, degrees * std::numbers::pi / 180};
  };
  return {{"round", {bend(5, 46, -220), bend(48, 64, 50)}},
          {"tall", {bend(5, 25, -85), bend(25, 47, -135), bend(51, 65, 45)}},
          {"square", {bend(6, 20, -75), bend(22, 36, -75), bend(38, 52, -75), bend(54, 67, 50)}},
          {"swan", {bend(5, 35, -165), bend(35, 50, -75), bend(52, 72, 75)}}};
}

}  // namespace softform
