#include "plot.hpp"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include <fmt/format.h>

#include "softform/io/atomic_write.hpp"

namespace softform::cli {
namespace {

// All lengths in pixels of the picture.
constexpr double least_panel_width = 560, panel_height = 460, left = 90, right = 25, top = 50, bottom = 75,
                 legend_height = 60;
constexpr double font_size = 19, dot_radius = 4.5, line_width = 2.6;

struct Color {
  double red, green, blue;
};
// Okabe and Ito's, told apart by everyone; dots are black.
constexpr std::array<Color, 6> colors{Color{0, 0.447, 0.698}, {0.835, 0.369, 0}, {0, 0.62, 0.451},
                                      {0.8, 0.475, 0.655},    {0.9, 0.62, 0},    {0.337, 0.706, 0.914}};

struct Interval {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  void include(double value)
  {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double length() const { return high - low; }
};

/// Of the dots, widened by 6 %.
Interval range_of(const Panel& panel, std::size_t axis)
{
  Interval range;
  for (const Series& series : panel.series)
    if (series.mark == Mark::Dot)
      for (const auto& point : series.points) range.include(point[axis]);
  const double margin = 0.06 * std::max(range.length(), 1e-9);
  return {range.low - margin, range.high + margin};
}

/// 1, 2 or 5 times a power of ten: some five steps in the interval.
double tick_step(double length)
{
  const double power = std::pow(10, std::floor(std::log10(length / 5)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (length / (factor * power) <= 6) return factor * power;
  return 10 * power;
}

class Canvas {
 public:
  Canvas(double width, double height)
      : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, int(width), int(height)), cairo_surface_destroy),
        cairo_(cairo_create(surface_.get()), cairo_destroy)
  {
    cairo_set_source_rgb(cairo_.get(), 1, 1, 1);
    cairo_paint(cairo_.get());
    cairo_select_font_face(cairo_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo_.get(), font_size);
  }

  cairo_t* get() const { return cairo_.get(); }

  void set_color(const Series& series, std::size_t index) const
  {
    const Color color = series.mark == Mark::Dot ? Color{0, 0, 0} : colors[index % colors.size()];
    cairo_set_source_rgb(get(), color.red, color.green, color.blue);
  }

  /// The anchor is a fraction of the text's size: (0.5, 0.5) centres it.
  double text(const std::string& words, double x, double y, double anchor_x, double anchor_y,
              bool upright = false) const
  {
    cairo_text_extents_t extents;
    cairo_text_extents(get(), words.c_str(), &extents);
    cairo_save(get());
    cairo_set_source_rgb(get(), 0.1, 0.1, 0.1);
    cairo_translate(get(), x, y);
    if (upright) cairo_rotate(get(), -std::numbers::pi / 2);
    cairo_move_to(get(), -anchor_x * extents.x_advance, (1 - anchor_y) * 0.7 * font_size);
    cairo_show_text(get(), words.c_str());
    cairo_restore(get());
    return extents.x_advance;
  }

  void dot(double x, double y) const
  {
    cairo_arc(get(), x, y, dot_radius, 0, 2 * std::numbers::pi);
    cairo_fill(get());
  }

  void cross(double x, double y) const
  {
    cairo_move_to(get(), x - dot_radius, y - dot_radius);
    cairo_rel_line_to(get(), 2 * dot_radius, 2 * dot_radius);
    cairo_move_to(get(), x - dot_radius, y + dot_radius);
    cairo_rel_line_to(get(), 2 * dot_radius, -2 * dot_radius);
  }

  bool write(const std::filesystem::path& png) const
  {
    return cairo_surface_write_to_png(surface_.get(), png.c_str()) == CAIRO_STATUS_SUCCESS;
  }

 private:
  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
  std::unique_ptr<cairo_t, decltype(&cairo_destroy)> cairo_;
};

/// A panel at its place on the canvas.
class Axes {
 public:
  Axes(const Canvas& canvas, const Panel& panel, double offset, double panel_width)
      : canvas_(canvas),
        panel_(panel),
        x_(range_of(panel, 0)),
        y_(range_of(panel, 1)),
        offset_(offset),
        width_(panel_width - left - right)
  {}

  void draw() const
  {
    draw_grid();
    cairo_save(canvas_.get());
    cairo_rectangle(canvas_.get(), offset_ + left, top, width(), height());
    cairo_clip(canvas_.get());
    for (std::size_t k = 0; k < panel_.series.size(); ++k) draw_series(panel_.series[k], k);
    cairo_restore(canvas_.get());
    canvas_.text(panel_.title, offset_ + left + width() / 2, top / 2, 0.5, 0.5);
    canvas_.text(panel_.x_title, offset_ + left + width() / 2, panel_height - 18, 0.5, 0.5);
    canvas_.text(panel_.y_title, offset_ + 18, top + height() / 2, 0.5, 0.5, true);
  }

 private:
  double width() const { return width_; }
  static double height() { return panel_height - top - bottom; }
  double pixel_x(double x) const { return offset_ + left + (x - x_.low) / x_.length() * width(); }
  double pixel_y(double y) const { return top + (y_.high - y) / y_.length() * height(); }

  void draw_grid() const
  {
    cairo_set_line_width(canvas_.get(), 1);
    const auto line = [this](double x1, double y1, double x2, double y2) {
      cairo_set_source_rgb(canvas_.get(), 0.85, 0.85, 0.85);
      cairo_move_to(canvas_.get(), x1, y1);
      cairo_line_to(canvas_.get(), x2, y2);
      cairo_stroke(canvas_.get());
    };
    const double bottom_y = top + height(), left_x = offset_ + left;
    for (double step = tick_step(x_.length()), x = std::ceil(x_.low / step) * step; x <= x_.high; x += step) {
      line(pixel_x(x), top, pixel_x(x), bottom_y);
      canvas_.text(label(x, step), pixel_x(x), bottom_y + 20, 0.5, 0.5);
    }
    for (double step = tick_step(y_.length()), y = std::ceil(y_.low / step) * step; y <= y_.high; y += step) {
      line(left_x, pixel_y(y), left_x + width(), pixel_y(y));
      canvas_.text(label(y, step), left_x - 8, pixel_y(y), 1, 0.5);
    }
  }

  static std::string label(double value, double step)
  {
    return fmt::format("{:.6g}", std::abs(value) < 1e-9 * step ? 0 : value);
  }

  void draw_series(const Series& series, std::size_t index) const
  {
    canvas_.set_color(series, index);
    cairo_set_line_width(canvas_.get(), line_width);
    for (const auto& [x, y] : series.points) {
      if (!std::isfinite(y)) continue;
      const double beyond = std::clamp(y, y_.low - y_.length(), y_.high + y_.length());  // cairo's integers are short
      if (series.mark == Mark::Line)
        cairo_line_to(canvas_.get(), pixel_x(x), pixel_y(beyond));
      else if (series.mark == Mark::Cross)
        canvas_.cross(pixel_x(x), pixel_y(beyond));
      else
        canvas_.dot(pixel_x(x), pixel_y(y));
    }
    cairo_stroke(canvas_.get());
  }

  const Canvas& canvas_;
  const Panel& panel_;
  Interval x_, y_;
  double offset_, width_;
};

void draw_legend(const Canvas& canvas, const Panel& panel)
{
  double x = left;
  const double y = panel_height + legend_height / 2;
  for (std::size_t k = 0; k < panel.series.size(); ++k) {
    const Series& series = panel.series[k];
    canvas.set_color(series, k);
    cairo_set_line_width(canvas.get(), line_width);
    if (series.mark == Mark::Line) {
      cairo_move_to(canvas.get(), x, y);
      cairo_line_to(canvas.get(), x + 30, y);
    } else if (series.mark == Mark::Cross) {
      canvas.cross(x + 15, y);
    } else {
      canvas.dot(x + 15, y);
    }
    cairo_stroke(canvas.get());
    x += 40 + canvas.text(series.label, x + 38, y, 0, 0.5) + 20;
  }
}

double legend_width(const Panel& panel)
{
  double width = left + right;
  for (const Series& series : panel.series) width += 60 + 0.62 * font_size * double(series.label.size());
  return width;
}

}  // namespace

void draw_panels(const std::filesystem::path& png, const std::vector<Panel>& panels)
{
  // Wide enough for the legend below.
  const double count = double(panels.size()),
               panel_width = std::max(least_panel_width, legend_width(panels.front()) / count);
  const Canvas canvas(count * panel_width, panel_height + legend_height);
  double offset = 0;
  for (const Panel& panel : panels) {
    Axes(canvas, panel, offset, panel_width).draw();
    offset += panel_width;
  }
  draw_legend(canvas, panels.front());
  write_atomically(png, [&](const std::filesystem::path& temporary) { return canvas.write(temporary); });
}

}  // namespace softform::cli
