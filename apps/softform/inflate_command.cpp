// softform inflate: a closed surface as a rubber balloon under a given pressure or at a given volume.
#include <limits>
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands.hpp"
#include "files.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "softform/core/interrupt.hpp"
#include "softform/equilibrium/volume_control.hpp"
#include "softform/materials/material_file.hpp"

namespace softform::cli {
namespace {

constexpr const char* examples = R"(Examples:
  softform inflate bunny.off --material silicone --thickness 0.3mm --volume-ratio 5 --out inflated
  softform inflate bunny.off --material my_rubber.json --thickness 0.2mm --pressure 1.5kPa --size 80mm --out inflated
The mesh is the unstretched balloon. --pressure finds the first equilibrium on the way from rest to that pressure;
behind a pressure peak, where a given pressure has no equilibrium or several, use --volume-ratio.
Lengths take um, mm, cm, m, in; pressures Pa, hPa, kPa, MPa, mbar, bar, mmHg, psi. A bare number is refused.
Writes DIR/inflated.vtp (metres, for ParaView) and DIR/metrics.csv (metric,value,unit; SI).)";

struct InflateInput : BalloonInput {
  std::optional<double> pressure;      ///< [Pa]
  std::optional<double> volume_ratio;  ///< of inflated to rest volume
};

Equilibrium inflate(const PressurizedMembrane& balloon, const InflateInput& input, SparseFactorization& factorization,
                    Progress& progress)
{
  const InflationObserver show = [&](const InflationStep& step, const Vec&) {
    progress.step(
        fmt::format("volume ratio {:.4g}, pressure {:.4g} Pa", step.volume / balloon.rest_volume(), step.pressure));
    return !interrupted();
  };
  if (input.pressure) return inflate_to_pressure(balloon, *input.pressure, factorization, {}, 1000, {}, show);
  return inflate_to_volume(balloon, *input.volume_ratio * balloon.rest_volume(), factorization, {}, {}, show);
}

/// Of the equilibrium under its pressure where that was prescribed, at its volume where that was; NaN when not known.
double negative_eigenvalues(const PressurizedMembrane& balloon, const Equilibrium& equilibrium,
                            SparseFactorization& factorization)
{
  int count = equilibrium.negative_eigenvalues;
  if (count < 0 && equilibrium.report.converged()) {
    SparseMatrix K;
    PressurePotential(balloon, equilibrium.pressure, equilibrium.x).hessian(equilibrium.x, K);
    count = count_negative_eigenvalues(K, factorization);
  }
  return count < 0 ? std::numeric_limits<double>::quiet_NaN() : count;
}

ExitCode conclude(const Equilibrium& equilibrium, const std::string& out)
{
  if (equilibrium.report.converged()) return Success;
  if (equilibrium.report.termination == Termination::Interrupted) {
    spdlog::warn("interrupted: the last state on the way is in {}", out);
    return Interrupted;
  }
  spdlog::error("no equilibrium was reached ({}: {}); the last state on the way is in {}",
                to_string(equilibrium.report.termination), equilibrium.report.message, out);
  return NotReached;
}

ExitCode run(const InflateInput& input)
{
  require_writable(input.out);
  const std::shared_ptr<const Material> material = load_material(input.material);
  const TriangleMesh mesh = read_closed_mesh(input.mesh, input.size);

  catch_interrupts();
  Progress progress;
  const Membrane membrane(mesh.triangles, mesh.vertex_count(), material,
                          Vec::Constant(mesh.triangle_count(), *input.thickness));
  const PressurizedMembrane balloon(membrane, flatten(mesh.vertices));
  SparseFactorization factorization;
  const Equilibrium equilibrium = inflate(balloon, input, factorization, progress);
  progress.end();

  const Vec& rest = balloon.rest_positions();
  const double volume = balloon.volume().value(equilibrium.x);
  const TriangleMesh inflated{unflatten(equilibrium.x), mesh.triangles};
  write_vtp(input.out + "/inflated.vtp", inflated, {{}, {stretch_field(inflated, mesh)}});
  write_metrics(input.out, {{"pressure", equilibrium.pressure, "Pa"},
                            {"volume", volume, "m^3"},
                            {"volume_ratio", volume / balloon.rest_volume(), "1"},
                            {"mean_stretch", membrane.mean_stretch(equilibrium.x, rest), "1"},
                            {"max_residual", equilibrium.residual, "1"},
                            {"negative_eigenvalues", negative_eigenvalues(balloon, equilibrium, factorization), "1"},
                            {"newton_iterations", double(equilibrium.iterations), "1"},
                            {"time", progress.elapsed_s(), "s"}});
  return conclude(equilibrium, input.out);
}

}  // namespace

void add_inflate_command(CLI::App& program, ExitCode& exit_code)
{
  CLI::App* command = program.add_subcommand("inflate", "Inflate a closed surface made of rubber");
  auto input = std::make_shared<InflateInput>();
  add_balloon_input(*command, *input, "MESH");
  CLI::Option_group* load = command->add_option_group("load", "what inflates it, one of");
  add_pressure(*load, "--pressure", input->pressure, "Pressure inside above that outside, for example 1kPa");
  add_number(*load, "--volume-ratio", input->volume_ratio, 1, "Volume relative to the one at rest, above 1");
  load->require_option(1);
  command->footer(examples);
  command->callback([input, &exit_code] { exit_code = run(*input); });
}

}  // namespace softform::cli
