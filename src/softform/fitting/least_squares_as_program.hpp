#pragma once

#include <memory>

#include "softform/fitting/least_squares.hpp"
#include "softform/optimizers/least_squares_program.hpp"

namespace softform {

/// A fit as an unconstrained programme from `start` (n), for the optimisers that know nothing of fits.
std::unique_ptr<LeastSquaresProgram> least_squares_program(std::shared_ptr<const LeastSquaresProblem> problem,
                                                           Vec start);

}  // namespace softform
