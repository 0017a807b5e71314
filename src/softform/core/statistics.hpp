#pragma once

#include "softform/core/types.hpp"

namespace softform {

/// Spearman's rank correlation of two samples (n), in [-1, 1]; equal values share their mean rank.
/// Precondition: n >= 2, neither sample constant.
double rank_correlation(ConstVec a, ConstVec b);

/// The larger of two numbers, and NaN where one of them is: a running maximum of errors that forgets none.
double max_or_nan(double a, double b);

}  // namespace softform
