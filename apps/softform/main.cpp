// The command line; one file a subcommand.
#include <cstdio>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "commands.hpp"
#include "softform/core/error.hpp"

namespace {

constexpr const char* examples = R"(Examples:
  softform check bunny.off
  softform inflate bunny.off --material silicone --thickness 0.3mm --volume-ratio 5 --out inflated
  softform balloon bunny.off --material silicone --thickness 0.3mm --size 146mm --out bunny
  softform mould bunny/rest.obj --nozzle 217 --wall 2mm --out bunny/mould
  softform panels bear.off --seams bear.json --size 40cm --out bear
  softform inflatable bear.off --seams bear.json --material mylar --size 40cm --out bear
  softform fit --uniaxial tension.csv --equibiaxial bulge.csv --model all --out rubber
  softform model datasets/models/mouse.json --vertices 2633 --out mouse.obj
  softform pillow heart.svg --pressure 1kPa --out heart
  softform character docs/examples/palm.json --out palm
Every subcommand explains itself: softform balloon --help
Exit codes: 0 done, 2 the input cannot be used (nothing was written), 3 no equilibrium or no minimum was reached (what was computed
is written), 130 interrupted by Ctrl-C (the best result so far is written).)";

}  // namespace

int main(int argc, char** argv)
{
  using namespace softform::cli;
  spdlog::set_default_logger(spdlog::stderr_color_mt("softform"));
  spdlog::set_pattern("%n: %^%v%$");

  CLI::App program(
      "softform: balloons, inflatables and posed characters that take the shape that you want, and what they are made "
      "of",
      "softform");
  program.set_version_flag("--version", SOFTFORM_VERSION);
  program.require_subcommand(1);
  program.footer(examples);
  ExitCode exit_code = Success;
  add_character_command(program, exit_code);
  add_check_command(program, exit_code);
  add_inflate_command(program, exit_code);
  add_balloon_command(program, exit_code);
  add_mould_command(program, exit_code);
  add_panels_command(program, exit_code);
  add_fit_command(program, exit_code);
  add_model_command(program, exit_code);
  add_inflatable_command(program, exit_code);
  add_pillow_command(program, exit_code);

  try {
    program.parse(argc, argv);
    return exit_code;
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? Success : BadInput;
  } catch (const softform::InputError& error) {
    spdlog::error("{}", error.what());
    return BadInput;
  } catch (const std::exception& error) {
    spdlog::critical("internal error: {}", error.what());
    return EXIT_FAILURE;
  }
}
