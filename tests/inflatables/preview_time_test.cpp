#include "softform/inflatables/preview_time.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "softform/mesh/shapes.hpp"

namespace softform {
namespace {

TEST(PreviewTime, IsWhenShapesStayCloseToTheLastOne)
{
  PreviewTime preview;
  EXPECT_TRUE(std::isnan(preview.within(1)));
  // Radii close to the last one, away from it again, and back: on other meshes each time.
  const double radii[] = {0.5, 0.99, 0.8, 0.96, 0.98, 1.0};
  for (int i = 0; i < 6; ++i) preview.record(10 + i, sphere(radii[i], 1000 + 100 * i));
  EXPECT_EQ(preview.within(0.05), 13);
  EXPECT_EQ(preview.within(0.25), 11);
  EXPECT_EQ(preview.within(1), 10);
  EXPECT_EQ(preview.within(1e-6), 15);
}

}  // namespace
}  // namespace softform
