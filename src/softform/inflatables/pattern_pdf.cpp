#include <cairo-pdf.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "softform/inflatables/pattern_files.hpp"
#include "softform/io/atomic_write.hpp"

namespace softform {
namespace {

// In millimetres: the paper, what printers leave white, and the tile that is left.
constexpr double paper_width = 210, paper_height = 297, margin = 15;
constexpr double tile_width = paper_width - 2 * margin, tile_height = paper_height - 2 * margin;
constexpr double points_per_mm = 72 / 25.4;
constexpr double mm = 1e3;

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

/// A tile of a sheet: its lower left corner [mm].
struct Tile {
  double x, y;
};

bool touches(const PatternPiece& sheet, const Tile& tile)
{
  return std::any_of(sheet.lines.begin(), sheet.lines.end(), [&](const PatternLine& line) {
    if (line.layer == PatternLayer::Sheet) return false;
    const Eigen::RowVector2d low = mm * line.points.colwise().minCoeff(), high = mm * line.points.colwise().maxCoeff();
    return low[0] < tile.x + tile_width && high[0] > tile.x && low[1] < tile.y + tile_height && high[1] > tile.y;
  });
}

/// Draws pages with millimetres as unit.
class Pages {
 public:
  explicit Pages(cairo_t* cairo) : cairo_(cairo) { cairo_scale(cairo, points_per_mm, points_per_mm); }

  void draw(const PatternPiece& sheet, const Tile& tile, const std::string& title)
  {
    cairo_save(cairo_);
    cairo_rectangle(cairo_, margin, margin, tile_width, tile_height);
    cairo_clip(cairo_);
    // To sheet coordinates, whose second axis points up.
    cairo_translate(cairo_, margin - tile.x, margin + tile_height + tile.y);
    cairo_scale(cairo_, 1, -1);
    for (const PatternLine& line : sheet.lines) stroke(line);
    for (const PatternText& text : sheet.texts) write(text);
    cairo_restore(cairo_);
    draw_margins(title);
    cairo_show_page(cairo_);
  }

 private:
  void use(const LayerStyle& style)
  {
    const auto channel = [&](int i) {
      return std::stoi(std::string(style.color).substr(static_cast<std::size_t>(1 + 2 * i), 2), nullptr, 16) / 255.0;
    };
    cairo_set_source_rgb(cairo_, channel(0), channel(1), channel(2));
    cairo_set_line_width(cairo_, mm * style.width);
    const double dash = mm * style.dash;
    cairo_set_dash(cairo_, &dash, dash > 0 ? 1 : 0, 0);
  }

  void stroke(const PatternLine& line)
  {
    use(style_of(line.layer));
    for (Eigen::Index i = 0; i < line.points.rows(); ++i)
      cairo_line_to(cairo_, mm * line.points(i, 0), mm * line.points(i, 1));
    if (line.is_closed) cairo_close_path(cairo_);
    cairo_stroke(cairo_);
  }

  void write(const PatternText& text)
  {
    use(style_of(text.layer));
    cairo_save(cairo_);
    cairo_translate(cairo_, mm * text.center.x(), mm * text.center.y());
    cairo_rotate(cairo_, text.angle);
    cairo_scale(cairo_, 1, -1);
    show_text(text.text, mm * text.height, true);
    cairo_restore(cairo_);
  }

  /// From the current origin, or centred on it.
  void show_text(const std::string& text, double height, bool is_centered)
  {
    cairo_select_font_face(cairo_, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo_, height / 0.72);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo_, text.c_str(), &extents);
    cairo_move_to(cairo_, is_centered ? -0.5 * extents.x_advance : 0, is_centered ? 0.5 * height : 0);
    cairo_show_text(cairo_, text.c_str());
  }

  void draw_margins(const std::string& title)
  {
    constexpr double arm = 5, rule = 100, tick = 3;
    cairo_set_source_rgb(cairo_, 0, 0, 0);
    cairo_set_dash(cairo_, nullptr, 0, 0);
    cairo_set_line_width(cairo_, 0.1);
    for (const double x : {margin, margin + tile_width}) {
      for (const double y : {margin, margin + tile_height}) {
        cairo_move_to(cairo_, x - arm, y), cairo_line_to(cairo_, x + arm, y);
        cairo_move_to(cairo_, x, y - arm), cairo_line_to(cairo_, x, y + arm);
      }
    }
    const double y = paper_height - 0.45 * margin;
    cairo_move_to(cairo_, margin, y - tick), cairo_line_to(cairo_, margin, y);
    cairo_line_to(cairo_, margin + rule, y), cairo_line_to(cairo_, margin + rule, y - tick);
    cairo_stroke(cairo_);
    cairo_save(cairo_);
    cairo_translate(cairo_, margin + rule + 4, y);
    show_text("100 mm: print at true scale", 2.5, false);
    cairo_restore(cairo_);
    cairo_save(cairo_);
    cairo_translate(cairo_, margin + arm + 2, 0.6 * margin);
    show_text(title, 3, false);
    cairo_restore(cairo_);
  }

  cairo_t* cairo_;
};

}  // namespace

void write_pattern_pdf(const std::filesystem::path& path, const std::vector<PatternPiece>& sheets)
{
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    const Surface surface(
        cairo_pdf_surface_create(temporary.c_str(), paper_width * points_per_mm, paper_height * points_per_mm),
        cairo_surface_destroy);
    // The same file every time.
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
    const Context cairo(cairo_create(surface.get()), cairo_destroy);
    Pages pages(cairo.get());
    for (const PatternPiece& sheet : sheets) {
      const Eigen::RowVector2d size = mm * sheet.lines.front().points.colwise().maxCoeff();
      for (int row = 0; row * tile_height < size[1]; ++row) {
        for (int column = 0; column * tile_width < size[0]; ++column) {
          const Tile tile{column * tile_width, row * tile_height};
          if (touches(sheet, tile))
            pages.draw(sheet, tile, fmt::format("{}, row {} from below, column {}", sheet.name, row + 1, column + 1));
        }
      }
    }
    cairo_surface_finish(surface.get());
    return cairo_surface_status(surface.get()) == CAIRO_STATUS_SUCCESS;
  });
}

}  // namespace softform
