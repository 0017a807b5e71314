#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace softform::render {

using Color = std::array<double, 3>;  ///< red, green, blue in [0, 1]

enum class ColorMap { Viridis, Coolwarm, Categories };

/// A field of the surface shown in colours, with its colour bar.
struct Scalar {
  std::string field, title, unit;
  double factor = 1;  ///< shown = factor * stored, for example 100 for m -> cm
  std::optional<std::array<double, 2>> range;
  ColorMap map = ColorMap::Viridis;
};

struct Cell {
  std::string surface;  ///< file name in the results folder
  std::string title;    ///< below the picture
  std::optional<Color> color;
  bool edges = false;
  std::optional<Scalar> scalar;
};

struct ColumnStyle {
  std::string title;
  Color color{0.72, 0.74, 0.78};
};

/// One model: all cells share the view and the scale.
struct Row {
  std::string title;
  std::array<double, 3> view{0, -1, 0};  ///< the direction from the model to the eye
  std::array<double, 3> up{0, 0, 1};
  std::vector<std::optional<Cell>> cells;
};

struct Layout {
  int width = 2400;  ///< of the picture [px]
  int blocks = 1;    ///< how many times the columns stand side by side; the rows fill one block after the other
  std::vector<ColumnStyle> columns;
  std::vector<Row> rows;
};

/// The layout's keys in words, for --help.
extern const char* const layout_help;

/// Reads and checks a layout. Throws InputError naming the file, the place and the cure; unknown keys are refused.
Layout read_layout(const std::filesystem::path& file);

}  // namespace softform::render
