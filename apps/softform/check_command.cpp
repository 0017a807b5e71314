// softform check: what a mesh is, and what is wrong with it.
#include <memory>

#include <fmt/format.h>

#include "commands.hpp"
#include "softform/io/mesh_io.hpp"
#include "softform/mesh/check.hpp"

namespace softform::cli {
namespace {

constexpr const char* examples = R"(Example:
  softform check bunny.off
A mesh can be used when it is closed, manifold, faces outwards and does not cut itself. Every problem comes with the
first element that has it (counted from 0) and its cure. Exit code 0 if the mesh can be used, 2 if not.)";

void print(const std::string& file, const TriangleMesh& mesh, const MeshReport& report)
{
  const Vec3 extent = report.upper_corner - report.lower_corner;
  fmt::print("{}\n", file);
  fmt::print("  vertices, edges, triangles  {}, {}, {}\n", report.vertices, report.edges, report.triangles);
  fmt::print("  separate parts              {}\n", report.components);
  if (report.genus) fmt::print("  genus                       {}\n", *report.genus);
  fmt::print("  extent                      {:.6g} x {:.6g} x {:.6g} of the file's units\n", extent.x(), extent.y(),
             extent.z());
  fmt::print("  size                        {:.6g} (largest distance between two vertices)\n", diameter(mesh.vertices));
  fmt::print("  volume                      {:.6g}\n", report.volume);
  fmt::print("  smallest angle              {:.1f} degrees\n", report.smallest_angle);
  if (report.self_intersections) fmt::print("  self-intersections          {}\n", *report.self_intersections);
  for (const std::string& note : report.notes) fmt::print("  note: {}\n", note);
  for (const MeshProblem& problem : report.problems)
    fmt::print("  problem ({} of this kind): {}\n", problem.count, problem.message);
  fmt::print("{}\n", report.usable() ? "It can be used." : "It cannot be used.");
}

}  // namespace

void add_check_command(CLI::App& program, ExitCode& exit_code)
{
  CLI::App* command = program.add_subcommand("check", "Say what a mesh is and what is wrong with it");
  auto file = std::make_shared<std::string>();
  command->add_option("MESH", *file, "Surface: OBJ, OFF, PLY or STL")->required();
  command->footer(examples);
  command->callback([file, &exit_code] {
    const TriangleMesh mesh = read_mesh(*file);
    const MeshReport report = check_mesh(mesh);
    print(*file, mesh, report);
    exit_code = report.usable() ? Success : BadInput;
  });
}

}  // namespace softform::cli
