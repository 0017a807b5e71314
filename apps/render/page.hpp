#pragma once

#include <filesystem>

#include "layout.hpp"

namespace softform::render {

/// Draws the layout's surfaces, read from `results`, as one PNG on white ground. Needs an X server (xvfb-run -a).
/// Throws InputError naming a missing file or field.
void draw_page(const Layout& layout, const std::filesystem::path& results, const std::filesystem::path& png);

}  // namespace softform::render
