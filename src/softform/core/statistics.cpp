#include "softform/core/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace softform {
namespace {

// Ranks about their mean.
Vec centred_ranks(ConstVec values)
{
  std::vector<int> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) { return values[i] < values[j]; });
  Vec ranks(values.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    for (std::size_t k = begin; k < end; ++k) ranks[order[k]] = 0.5 * static_cast<double>(begin + end - 1);
    begin = end;
  }
  return ranks.array() - ranks.mean();
}

}  // namespace

double rank_correlation(ConstVec a, ConstVec b)
{
  const Vec ranks_a = centred_ranks(a), ranks_b = centred_ranks(b);
  return ranks_a.dot(ranks_b) / (ranks_a.norm() * ranks_b.norm());
}

double max_or_nan(double a, double b) { return std::isnan(a) || b <= a ? a : b; }

}  // namespace softform
