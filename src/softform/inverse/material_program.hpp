#pragma once

#include <memory>

#include "softform/inverse/material_design.hpp"
#include "softform/optimizers/nonlinear_program.hpp"

namespace softform {

/// The reduced problem of a material design at fixed weights as a programme for any optimiser that takes bounds: z =
/// rho in [0, 1], no constraints. Every equilibrium is sought from the first state, so that the objective is a function
/// of rho alone; it is +infinity where none is found. The design must outlive it.
template <int dim>
std::unique_ptr<NonlinearProgram> material_program(MaterialDesign<dim>& design,
                                                   const typename MaterialDesign<dim>::State& first,
                                                   const MaterialWeights& weights);

}  // namespace softform
