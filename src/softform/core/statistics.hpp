#pragma once

#include "softform/core/types.hpp"

namespace softform {

/// Spearman's rank correlation of two samples (n), in [-1, 1]; equal values share their mean rank.
/// Precondition: n >= 2, neither sample constant.
double rank_correlation(ConstVec a, ConstVec b);

}  // namespace softform
