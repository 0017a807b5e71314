#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace softform::cli {

enum class Mark { Line, Cross, Dot };

/// Points in the plane; dots are black, what they are compared with has a colour.
struct Series {
  std::string label;
  std::vector<std::array<double, 2>> points;
  Mark mark = Mark::Line;
};

/// One set of axes. Its range is that of the series drawn as dots, with a margin; all else is cut off there.
struct Panel {
  std::string title, x_title, y_title;
  std::vector<Series> series;
};

/// Draws panels side by side with one legend into a PNG; it needs no display. Series of the same place in their panels
/// share colour and label. Throws InputError naming the file when it cannot be written.
void draw_panels(const std::filesystem::path& png, const std::vector<Panel>& panels);

}  // namespace softform::cli
