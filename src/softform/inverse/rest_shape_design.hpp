#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "softform/core/types.hpp"
#include "softform/equilibrium/pressurized_membrane.hpp"
#include "softform/objectives/weighted_sum.hpp"
#include "softform/optimizers/nonlinear_program.hpp"

namespace softform {

/// The inverse problem of chapter 4 (3.39, 4.13): the rest positions X of a membrane under a fixed pressure, such that
/// its equilibrium x(X) minimises
///     sum_k w_k E_k(x) + sum_l v_l R_l(X)   subject to   f(x, X) = dW/dx - p dV/dx = 0.
/// Forces are divided by p times the mean vertex area of the target, which makes them dimensionless.
struct RestShapeDesign {
  std::shared_ptr<const Membrane> membrane;
  double pressure = 0;                          ///< [Pa]
  double force_scale = 1;                       ///< [N]
  Vec x0;                                       ///< (3n) first equilibrium [m]
  Vec rest_positions0;                          ///< (3n) first design [m]
  std::vector<WeightedObjective> state_terms;   ///< E_k(x)
  std::vector<WeightedObjective> design_terms;  ///< R_l(X)
  /// Rest positions that may be made: others are refused before an equilibrium is sought. Empty: all of them.
  std::function<bool(ConstVec rest_positions)> is_admissible;
  NewtonOptions newton;
  /// Shown every forward solve, for what it cost.
  std::function<void(const Equilibrium& found)> on_equilibrium;
  /// Coordinates that stay at x0 and rest_positions0, in state and design both (3n): there, derivatives are zero, f
  /// too, and its Jacobian has an entry on the diagonal. Empty: none.
  FixedDofs fixed;
};

/// Both the state and the design as variables, z = (x, X), with f as constraints. `restore` solves for the equilibrium
/// at the design of z, starting from its state; it refuses unstable ones and designs that are not admissible.
std::unique_ptr<NonlinearProgram> full_space_program(const RestShapeDesign& design);

/// The design alone, z = X: the objective at the equilibrium x(X), its gradient by one adjoint solve, no constraints.
/// The objective is +infinity where there is no stable equilibrium or the design is not admissible.
/// The Gauss-Newton Hessian is that of the design terms; the state's contribution has no sparse form.
std::unique_ptr<NonlinearProgram> reduced_program(const RestShapeDesign& design);

}  // namespace softform
