#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "layout.hpp"
#include "page.hpp"
#include "softform/core/error.hpp"

/// Draws a grid of surfaces as a paper would print them.
int main(int argc, char** argv)
{
  std::string layout, results, png;
  CLI::App app("softform-render: a grid of surfaces as one picture, drawn off-screen (run it under xvfb-run -a)");
  app.footer(softform::render::layout_help);
  app.add_option("LAYOUT", layout, "JSON file that says what to draw")->required();
  app.add_option("--results", results, "folder of the surfaces (.vtp)")->required();
  app.add_option("--out", png, "the picture (.png)")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    softform::render::draw_page(softform::render::read_layout(layout), results, png);
    return 0;
  } catch (const softform::InputError& error) {
    fmt::print(stderr, "softform-render: {}\n", error.what());
    return 2;
  }
}
