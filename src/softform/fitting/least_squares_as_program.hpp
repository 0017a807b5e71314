#pragma once

#include <memory>

#include "softform/fitting/least_squares.hpp"
#include "softform/optimizers/least_squares_program.hpp"

namespace softform {

/// A fit as a programme without constraints from `start` (n) within bounds (n), for the optimisers that know nothing of
/// fits. Functions are NaN where the problem has no values.
std::unique_ptr<LeastSquaresProgram> least_squares_program(std::shared_ptr<const LeastSquaresProblem> problem,
                                                           Vec start, Vec lower, Vec upper);

}  // namespace softform
