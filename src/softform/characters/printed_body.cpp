#include "softform/characters/printed_body.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/io/mesh_io.hpp"
#include "softform/io/text_file.hpp"
#include "softform/io/threemf.hpp"
#include "softform/mesh/check.hpp"

namespace softform {
namespace {

PrintedMaterial printed_material(const SimplexMesh<3>& rest, const Vec& densities, CharacterMaterial material,
                                 const ContactOptions& contacts)
{
  std::vector<bool> is_inside;
  for (const double rho : densities) is_inside.push_back((rho >= 0.5) == (material == CharacterMaterial::Stiff));
  PrintedMaterial printed{material, region_surface(rest, is_inside, contacts), 0, {}};
  const MeshReport report = check_mesh(printed.surface.mesh);
  printed.volume = report.volume;
  for (const MeshProblem& problem : report.problems)
    if (problem.kind != MeshProblemKind::SeveralComponents)  // islands are what is expected
      printed.problems.push_back(fmt::format("{} ({} such)", problem.message, problem.count));
  return printed;
}

PrintedBody printed(const SimplexMesh<3>& rest, const Vec& densities, std::vector<Island> islands,
                    const ContactOptions& contacts)
{
  PrintedBody body;
  body.islands = std::move(islands);
  for (const auto material : {CharacterMaterial::Soft, CharacterMaterial::Stiff})
    if (std::any_of(body.islands.begin(), body.islands.end(), [&](const auto& i) { return i.material == material; }))
      body.materials.push_back(printed_material(rest, densities, material, contacts));
  body.volume = enclosed_volume(rest.positions, boundary_faces<3>(rest.elements).faces);
  return body;
}

}  // namespace

PrintedBody printed_body(const SimplexMesh<2>& rest, const Vec& densities, const PrintOptions& options)
{
  if (!(options.thickness > 0))
    throw InputError(fmt::format("a thickness of {} m cannot be printed: give a positive one", options.thickness));
  ContactOptions contacts = options.contacts;
  contacts.keeps_height = true;
  Vec of_plate(3 * densities.size());
  for (Eigen::Index t = 0; t < densities.size(); ++t) of_plate.segment<3>(3 * t).setConstant(densities[t]);
  return printed(extruded(rest, options.thickness), of_plate, find_islands<2>(rest, densities, options.printable_size),
                 contacts);
}

PrintedBody printed_body(const SimplexMesh<3>& rest, const Vec& densities, const PrintOptions& options)
{
  return printed(rest, densities, find_islands<3>(rest, densities, options.printable_size), options.contacts);
}

const char* to_string(CharacterMaterial material) { return material == CharacterMaterial::Stiff ? "stiff" : "soft"; }

void write_printed_body(const std::filesystem::path& folder, const PrintedBody& body, bool is_planar,
                        const PrintOptions& options)
{
  std::vector<PrintedPart> parts;
  for (const PrintedMaterial& material : body.materials) {
    const std::string name = to_string(material.material);
    parts.push_back({name, material.surface.mesh});
    TriangleMesh in_millimetres = material.surface.mesh;
    in_millimetres.vertices *= 1e3;
    write_mesh(folder / (name + ".stl"), in_millimetres);
  }
  write_3mf(folder / "print.3mf", parts);
  write_text(folder / "islands.csv", is_planar ? island_table<2>(body.islands, options.printable_size)
                                               : island_table<3>(body.islands, options.printable_size));
}

}  // namespace softform
