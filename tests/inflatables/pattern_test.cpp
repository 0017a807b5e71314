#include "softform/inflatables/pattern.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <dxflib/dl_creationadapter.h>
#include <dxflib/dl_dxf.h>
#include <gtest/gtest.h>

#include "softform/inflatables/nesting.hpp"
#include "softform/inflatables/pattern_files.hpp"
#include "support/expect_input_error.hpp"
#include "support/temporary_folder.hpp"

namespace softform {
namespace {

using Vec2 = Eigen::Vector2d;

FlatPositions polygon(std::initializer_list<Vec2> points)
{
  FlatPositions result(static_cast<Eigen::Index>(points.size()), 2);
  Eigen::Index i = 0;
  for (const Vec2& p : points) result.row(i++) = p.transpose();
  return result;
}

double area(const FlatPositions& p)
{
  double twice = 0;
  for (Eigen::Index i = 0; i < p.rows(); ++i) {
    const Eigen::Index k = (i + 1) % p.rows();
    twice += p(i, 0) * p(k, 1) - p(i, 1) * p(k, 0);
  }
  return twice / 2;
}

double distance(const Vec2& p, const FlatPositions& outline)
{
  double least = 1e9;
  for (Eigen::Index i = 0; i < outline.rows(); ++i) {
    const Vec2 a = outline.row(i), ab = outline.row((i + 1) % outline.rows()).transpose() - a;
    const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (a + t * ab - p).norm());
  }
  return least;
}

bool is_inside(const Vec2& p, const FlatPositions& outline)
{
  bool inside = false;
  for (Eigen::Index i = 0; i < outline.rows(); ++i) {
    const Vec2 a = outline.row(i), b = outline.row((i + 1) % outline.rows());
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      inside = !inside;
  }
  return inside;
}

std::vector<FlatPositions> cuts_on(const PatternPiece& sheet)
{
  std::vector<FlatPositions> cuts;
  for (const PatternLine& line : sheet.lines)
    if (line.layer == PatternLayer::Cut) cuts.push_back(line.points);
  return cuts;
}

int count(const std::vector<PatternPiece>& sheets, PatternLayer layer)
{
  int lines = 0;
  for (const PatternPiece& sheet : sheets)
    lines += static_cast<int>(std::count_if(sheet.lines.begin(), sheet.lines.end(),
                                            [&](const PatternLine& line) { return line.layer == layer; }));
  return lines;
}

TEST(Widened, ASquareGrowsByTheWidth)
{
  const FlatPositions square = polygon({{0, 0}, {0.1, 0}, {0.1, 0.1}, {0, 0.1}});
  EXPECT_NEAR(area(widened(square, 0.01)), 0.12 * 0.12, 1e-8);
}

TEST(Widened, IsNowhereCloserThanTheWidth)
{
  const PanelLayout layout = three_lune_sphere(0.1, 11);
  for (const PatternPiece& piece : pattern_pieces(layout)) {
    const FlatPositions& seam = piece.lines[1].points;
    for (Eigen::Index i = 0; i < piece.cut().rows(); ++i) {
      const Vec2 p = piece.cut().row(i), next = piece.cut().row((i + 1) % piece.cut().rows());
      EXPECT_GE(distance(p, seam), 8e-3 - 1e-6);
      EXPECT_LE(distance(p, seam), 2 * 8e-3 + 1e-6);
      EXPECT_GE(distance(0.5 * (p + next), seam), 8e-3 - 1e-6);
    }
  }
}

TEST(Widened, RefusesNoWidthAndOverlaps)
{
  const FlatPositions square = polygon({{0, 0}, {0.1, 0}, {0.1, 0.1}, {0, 0.1}});
  test::expect_input_error([&] { widened(square, 0); }, {"allowance", "above 0"});
  test::expect_input_error([&] { widened(square, -1); }, {"allowance", "above 0"});
  const FlatPositions bow_tie = polygon({{0, 0}, {0.1, 0.1}, {0.1, 0}, {0, 0.15}});
  test::expect_input_error([&] { widened(bow_tie, 0.01); }, {"overlaps itself", "seam"});
  // A spiral that covers itself without a vertex of its own inside.
  const FlatPositions spiral =
      polygon({{0, 0}, {0.3, 0}, {0.3, 0.1}, {0.1, 0.1}, {0.1, -0.1}, {0.2, -0.1}, {0.2, 0.2}, {0, 0.2}});
  test::expect_input_error([&] { widened(spiral, 0.001); }, {"overlaps itself"});
}

TEST(Pattern, NotchesAndNumbersMatchOnBothSides)
{
  const PanelLayout layout = three_lune_sphere(0.1, 11);
  const auto pieces = pattern_pieces(layout);
  ASSERT_EQ(pieces.size(), 3U);
  // One notch for every 50 mm of each of the six sides, one of them double.
  const double length = side_lengths(layout, layout.seams[0])[0];
  EXPECT_EQ(count(pieces, PatternLayer::Notches), 6 * (1 + static_cast<int>(std::lround(length / 0.05))));
  std::map<std::string, int> numbers;
  for (const PatternPiece& piece : pieces) {
    for (const PatternText& text : piece.texts) ++numbers[text.text];
    for (const PatternLine& line : piece.lines) {
      if (line.layer != PatternLayer::Notches) continue;
      EXPECT_NEAR(distance(line.points.row(0), piece.lines[1].points), 0, 1e-9);
      EXPECT_FALSE(is_inside(line.points.row(1), piece.lines[1].points));
      EXPECT_TRUE(is_inside(line.points.row(1), piece.cut()));
    }
    for (const PatternText& text : piece.texts) EXPECT_TRUE(is_inside(text.center, piece.lines[1].points));
  }
  for (const char* number : {"1", "2", "3"}) EXPECT_EQ(numbers[number], 2);
}

TEST(Pattern, SeamTableComparesSides)
{
  PanelLayout layout = three_lune_sphere(0.1, 11);
  layout.flat.middleRows(layout.panels[0].first_vertex, layout.panels[0].vertex_count) *= 1.1;
  layout.seams[0].name = "a \"b\"";
  const std::string table = seam_table(layout);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4);
  EXPECT_NE(table.find("1,\"a \"\"b\"\"\",\"1\",\"3\","), std::string::npos) << table;
  EXPECT_NE(table.find(",0.095238\n"), std::string::npos) << table;  // 2 (1.1 - 1) / (1.1 + 1)
  EXPECT_NE(table.find(",0.000000\n"), std::string::npos) << table;
}

TEST(Nesting, PiecesLieOnTheirSheetsWithoutOverlap)
{
  const auto pieces = pattern_pieces(three_lune_sphere(0.1, 11));
  for (const bool keeps_grain : {false, true}) {
    NestingOptions options;
    options.sheet_width = 0.36;
    options.sheet_height = 0.4;
    options.keeps_grain = keeps_grain;
    std::size_t placed = 0;
    for (const PatternPiece& sheet : nested(pieces, options)) {
      const auto cuts = cuts_on(sheet);
      placed += cuts.size();
      for (std::size_t a = 0; a < cuts.size(); ++a) {
        EXPECT_GE(cuts[a].minCoeff(), options.gap - 1e-6);
        EXPECT_LE(cuts[a].col(0).maxCoeff(), options.sheet_width - options.gap + 1e-6);
        EXPECT_LE(cuts[a].col(1).maxCoeff(), options.sheet_height - options.gap + 1e-6);
        for (std::size_t b = 0; b < cuts.size(); ++b) {
          if (a == b) continue;
          for (Eigen::Index i = 0; i < cuts[b].rows(); ++i) {
            EXPECT_FALSE(is_inside(cuts[b].row(i), cuts[a]));
            EXPECT_GE(distance(cuts[b].row(i), cuts[a]), options.gap - 1e-6);
          }
        }
      }
      for (const PatternText& text : sheet.texts) {
        if (keeps_grain && text.text.size() > 1) {
          EXPECT_NEAR(std::sin(text.angle), 0, 1e-9);
        }
      }
    }
    EXPECT_EQ(placed, 3U);
  }
}

TEST(Nesting, FillsASheetWithSquares)
{
  std::vector<PatternPiece> squares;
  for (int i = 0; i < 6; ++i)
    squares.push_back(
        {"square", {{PatternLayer::Cut, polygon({{0, 0}, {0.09, 0}, {0.09, 0.09}, {0, 0.09}}), true}}, {}});
  NestingOptions options;
  options.sheet_width = 0.31;
  options.sheet_height = 0.21;
  EXPECT_EQ(nested(squares, options).size(), 1U);
}

TEST(Nesting, NamesThePanelThatIsTooLarge)
{
  NestingOptions options;
  options.sheet_width = 0.2;
  options.sheet_height = 0.2;
  test::expect_input_error([&] { nested(pattern_pieces(three_lune_sphere(0.1, 11)), options); },
                           {"panel '1'", "200 x 200 mm", "larger sheet"});
}

/// What dxflib reads.
class Reader : public DL_CreationAdapter {
 public:
  std::set<std::string> layers;
  std::map<std::string, int> polylines, closed, texts;
  double right = 0;

  void addLayer(const DL_LayerData& layer) override { layers.insert(layer.name); }
  void addPolyline(const DL_PolylineData& data) override
  {
    ++polylines[getAttributes().getLayer()];
    closed[getAttributes().getLayer()] += data.flags & 1;
  }
  void addVertex(const DL_VertexData& vertex) override { right = std::max(right, vertex.x); }
  void addText(const DL_TextData& text) override { ++texts[text.text]; }
};

TEST(PatternFiles, DxfReadsBackInMillimetres)
{
  const test::TemporaryFolder folder;
  const auto sheets = nested(pattern_pieces(three_lune_sphere(0.1, 11)), {});
  write_pattern_dxf(folder / "panels.dxf", sheets);
  Reader reader;
  DL_Dxf dxf;
  ASSERT_TRUE(dxf.in((folder / "panels.dxf").string(), &reader));
  for (const char* layer : {"cut", "seam", "notches", "labels", "grain", "sheet"})
    EXPECT_EQ(reader.layers.count(layer), 1U);
  EXPECT_EQ(reader.polylines["cut"], 3);
  EXPECT_EQ(reader.closed["cut"], 3);
  EXPECT_EQ(reader.polylines["seam"], 3);
  EXPECT_EQ(reader.polylines["notches"], count(sheets, PatternLayer::Notches));
  EXPECT_EQ(reader.closed["notches"], 0);
  EXPECT_EQ(reader.texts["panel 1"], 1);
  EXPECT_EQ(reader.texts["2"], 2);
  EXPECT_NEAR(reader.right, 600, 1e-9);
}

TEST(PatternFiles, AreWhollyThereOrNotAtAll)
{
  const test::TemporaryFolder folder;
  const auto sheets = nested(pattern_pieces(three_lune_sphere(0.1, 11)), {});
  const auto file = folder.write("file", "");
  test::expect_input_error([&] { write_pattern_svg(file / "panels.svg", sheets); }, {"panels.svg"});
  test::expect_input_error([&] { write_pattern_dxf(file / "panels.dxf", sheets); }, {"panels.dxf"});
  test::expect_input_error([&] { write_pattern_pdf(file / "panels.pdf", sheets); }, {"panels.pdf"});
}

}  // namespace
}  // namespace softform
