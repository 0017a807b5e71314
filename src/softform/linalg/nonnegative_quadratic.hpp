#pragma once

#include "softform/core/types.hpp"

namespace softform {

/// The minimum of  1/2 y^t M y + q^t y  over y >= 0, M (n, n) dense and positive definite, by the active set of Lawson
/// and Hanson (1974, chapter 23): entries are freed one at a time, those that turn negative are held at zero again. At
/// the end y > 0 and M y + q = 0 on the free entries, and M y + q >= 0 on the others, to round-off.
Vec nonnegative_minimum(const Eigen::MatrixXd& M, const Vec& q);

}  // namespace softform
