// softform model: the surface of a solid described by simple parts that melt into each other.
#include <filesystem>
#include <memory>

#include <spdlog/spdlog.h>

#include "commands.hpp"
#include "files.hpp"
#include "softform/core/error.hpp"
#include "softform/io/mesh_io.hpp"
#include "softform/io/model_file.hpp"

namespace softform::cli {
namespace {

constexpr const char* examples = R"(Example:
  softform model datasets/models/mouse.json --vertices 2633 --out mouse.obj
The mesh is watertight, has exactly the vertices asked for and is written in millimetres.)";

struct ModelInput {
  std::string model, out;
  int vertices = 0;
};

void run(const ModelInput& input)
{
  mesh_format(input.out);  // refuses an unknown one before the work
  require_writable(std::filesystem::absolute(input.out).parent_path());
  const ImplicitModel model = read_model(input.model);
  TriangleMesh mesh;
  try {
    mesh = mesh_model(model, input.vertices);
  } catch (const InputError& error) {
    throw InputError(input.model + ": " + error.what());
  }
  mesh.vertices *= 1e3;  // in millimetres
  write_mesh(input.out, mesh);
  spdlog::info("{} vertices are in {}", input.vertices, input.out);
}

}  // namespace

void add_model_command(CLI::App& program, ExitCode& exit_code)
{
  CLI::App* command = program.add_subcommand("model", "Mesh a solid that a JSON file describes");
  auto input = std::make_shared<ModelInput>();
  command->add_option("MODEL", input->model, "Description (JSON)")->required();
  command->add_option("--vertices", input->vertices, "How many vertices the mesh is to have")
      ->required()
      ->check(CLI::Range(100, 10'000'000));
  command->add_option("--out", input->out, "Mesh to write: OBJ, OFF, PLY or STL")->required();
  command->footer(std::string(examples) + "\n\n" + model_file_help);
  command->callback([input, &exit_code] {
    run(*input);
    exit_code = Success;
  });
}

}  // namespace softform::cli
