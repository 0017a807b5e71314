// Drawings of outlines: geometry, units and what is refused.
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "softform/inflatables/pillow.hpp"
#include "softform/io/svg_outlines.hpp"
#include "softform/io/text_file.hpp"
#include "softform/mesh/remesh.hpp"
#include "support/expect_input_error.hpp"
#include "support/temporary_folder.hpp"

namespace softform::testing {
namespace {

using softform::test::expect_input_error;
using softform::test::TemporaryFolder;

std::vector<SvgOutline> outlines_of(const std::string& content, const std::string& attributes = "")
{
  const TemporaryFolder folder;
  const auto file = folder.path() / "drawing.svg";
  write_text(file, "<svg xmlns='http://www.w3.org/2000/svg' " + attributes + ">" + content + "</svg>");
  return read_svg_outlines(file);
}

const std::string millimetres = "width='100mm' height='100mm' viewBox='0 0 100 100'";
constexpr double mm = 1e-3, mm2 = 1e-6;

TEST(SvgOutlines, ShapesHaveTheirAreas)
{
  const auto area = [](const std::string& content) {
    const auto outlines = outlines_of(content, millimetres);
    EXPECT_EQ(outlines.size(), 1U) << content;
    return signed_area(outlines.at(0).points) / mm2;
  };
  const double pi = std::numbers::pi;
  EXPECT_NEAR(area("<rect x='10' y='20' width='30' height='40'/>"), 1200, 1e-9);
  EXPECT_NEAR(area("<polygon points='0,0 10,0 0,10'/>"), 50, 1e-9);
  EXPECT_NEAR(area("<circle cx='50' cy='50' r='20'/>"), 400 * pi, 1);
  EXPECT_NEAR(area("<ellipse cx='50' cy='50' rx='20' ry='10'/>"), 200 * pi, 1);
  EXPECT_NEAR(area("<path d='M0 0H10V10H0Z'/>"), 100, 1e-9);
  EXPECT_NEAR(area("<path d='m 5,5 10,0 0,10 -10,0 z'/>"), 100, 1e-9);
  // Quarter circles by the usual cubic, off by 0.03 % of the radius; the parabola has two thirds of its box.
  EXPECT_NEAR(
      area("<path d='M20 0C20 11.0457 11.0457 20 0 20S-20 11.0457 -20 0-11.0457 -20 0 -20 20 -11.0457 20 0z'/>"),
      400 * pi, 2);
  EXPECT_NEAR(area("<path d='M0 0Q10 20 20 0Z'/>"), 400.0 / 3, 0.5);
  EXPECT_NEAR(area("<path d='M-20 0A20 20 0 0 1 20 0Z'/>"), 200 * pi, 1);
  EXPECT_NEAR(area("<path d='M0 -20A20 20 0 1020 0L0 0Z'/>"), 300 * pi, 2);
}

TEST(SvgOutlines, TransformsAndUnits)
{
  const std::string square = "<rect width='10' height='10'/>";
  const auto area = [&](const std::string& content, const std::string& attributes) {
    return signed_area(outlines_of(content, attributes).at(0).points);
  };
  EXPECT_NEAR(area(square, millimetres), 100 * mm2, 1e-12);
  EXPECT_NEAR(area(square, "width='10cm' viewBox='0 0 100 100'"), 100 * mm2, 1e-12);
  EXPECT_NEAR(area(square, ""), std::pow(10 * 25.4 / 96 * mm, 2), 1e-12);
  EXPECT_NEAR(
      area("<g transform='scale(2)'><g transform='rotate(30, 5, 5) translate(3)'>" + square + "</g></g>", millimetres),
      400 * mm2, 1e-12);
  const auto moved =
      outlines_of("<g transform='translate(10 20) matrix(0 1 -1 0 0 0)'>" + square + "</g>", millimetres);
  EXPECT_NEAR(moved[0].points.col(0).minCoeff(), 0, 1e-12);
  EXPECT_NEAR(moved[0].points.col(1).minCoeff(), -30 * mm, 1e-12);
  EXPECT_EQ(outlines_of("<defs>" + square + "</defs>" + square + square, millimetres).size(), 2U);
}

TEST(SvgOutlines, RefusesWhatIsNoOutline)
{
  expect_input_error([] { outlines_of("<path id='arm' d='M0 0L10 0L10 10'/>"); },
                     {"drawing.svg", "'arm'", "open", "close"});
  expect_input_error([] { outlines_of("<path d='M0 0L10'/>"); }, {"character 8", "number"});
  expect_input_error([] { outlines_of("<path d='0 0L10 0Z'/>"); }, {"without a command"});
  expect_input_error([] { outlines_of("<path d='M0 0K10 0Z'/>"); }, {"'K'"});
  expect_input_error([] { outlines_of("<text>hello</text>"); }, {"no closed outline"});
  expect_input_error([] { outlines_of("<use href='#a'/>"); }, {"unlink"});
  expect_input_error([] { outlines_of("<g transform='skewX(3)'><rect width='1' height='1'/></g>"); }, {"skewX"});
  expect_input_error([] { outlines_of("<rect"); }, {"drawing.svg", "SVG"});
  expect_input_error([] { read_svg_outlines("missing.svg"); }, {"missing.svg", "check the path"});
}

TEST(Triangulated, FillsAnOutlineWithGoodTriangles)
{
  const auto heart =
      outlines_of("<path d='M50 90C0 50 10 10 35 10 45 10 50 20 50 25 50 20 55 10 65 10 90 10 100 50 50 90Z'/>",
                  millimetres)[0]
          .points;
  const PanelLayout layout = pillow(heart, heart, 2 * mm);
  double flat_area = 0;
  for (int t = 0; t < layout.triangle_count(); ++t) {
    const Eigen::RowVector2d u = layout.flat.row(layout.triangles(t, 1)) - layout.flat.row(layout.triangles(t, 0)),
                             v = layout.flat.row(layout.triangles(t, 2)) - layout.flat.row(layout.triangles(t, 0));
    EXPECT_GT(u.x() * v.y() - u.y() * v.x(), 0);
    flat_area += 0.5 * (u.x() * v.y() - u.y() * v.x());
  }
  EXPECT_NEAR(flat_area, 2 * signed_area(heart), 0.01 * flat_area);
  Positions flat = Positions::Zero(layout.vertex_count(), 3);
  flat.leftCols<2>() = layout.flat;
  EXPECT_GT(smallest_angle({flat, layout.triangles}), 15);
  for (const double length : side_lengths(layout, layout.seams[0]))
    EXPECT_NEAR(length, perimeter(heart), 0.01 * length);
}

TEST(Triangulated, RefusesOutlinesThatCannotBeSewn)
{
  Polygon square(4, 2), larger, bow_tie(4, 2);
  square << 0, 0, 1, 0, 1, 1, 0, 1;
  larger = 1.1 * square;
  bow_tie << 0, 0, 1, 1, 1, 0, 0, 1;
  expect_input_error([&] { pillow(square, larger, 0.1); }, {"4000 mm", "4400 mm", "2 %"});
  expect_input_error([&] { triangulated(bow_tie, 0.1); }, {"crosses"});
  expect_input_error([&] { triangulated(square.colwise().reverse(), 0.1); }, {"clockwise"});
}

}  // namespace
}  // namespace softform::testing
