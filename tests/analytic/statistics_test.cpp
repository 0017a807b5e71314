// Statistics of samples, and what becomes of NaN in them.
#include <cmath>

#include <gtest/gtest.h>

#include "softform/core/statistics.hpp"

namespace softform {
namespace {

TEST(MaxOrNan, KeepsNanWhereverItComes)
{
  EXPECT_EQ(max_or_nan(1, 2), 2);
  EXPECT_EQ(max_or_nan(2, 1), 2);
  EXPECT_TRUE(std::isnan(max_or_nan(1, NAN)));
  EXPECT_TRUE(std::isnan(max_or_nan(NAN, 1)));
}

TEST(RankCorrelation, SeesTheOrderAlone)
{
  const Vec a = Vec::LinSpaced(5, 0, 4), b = a.array().exp(), c = Vec{{0, 1, 1, 0}}, d = Vec{{1, 3, 3, 1}};
  EXPECT_DOUBLE_EQ(rank_correlation(a, b), 1);
  EXPECT_DOUBLE_EQ(rank_correlation(a, -b), -1);
  EXPECT_DOUBLE_EQ(rank_correlation(c, d), 1);
}

}  // namespace
}  // namespace softform
