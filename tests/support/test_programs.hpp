#pragma once

#include <memory>
#include <string>
#include <vector>

#include "softform/optimizers/nonlinear_program.hpp"

/// Small nonlinear programmes whose outcome is known, with exact first and second derivatives.
namespace softform::testing {

/// A programme and its optimum, with multipliers in the sign convention of NonlinearProgram.
struct PublishedProgram {
  std::shared_ptr<const NonlinearProgram> program;
  Vec optimum;
  Vec lagrange_multipliers;    ///< empty where they are not unique
  Vec bound_multipliers;       ///< zero where no bound is active
  bool is_degenerate = false;  ///< the Hessian is singular at the optimum: z is known only to a root of the tolerance
};

/// Hock and Schittkowski, Test Examples for Nonlinear Programming Codes (1981), by their numbers; Rosenbrock's
/// function; and programmes of our own with dependent constraints and a domain that ends (closed forms).
const std::vector<PublishedProgram>& published_programs();

/// One of these by its name, for example "HS 6".
const PublishedProgram& published_program(const std::string& name);

/// Powell 1986's example of the Maratos effect: f falls along the unit circle, but full Newton steps leave it. The
/// optimum is (1, 0), lambda = -1.5.
PublishedProgram maratos_program();
/// z - log z from z = 10, where the first full step leaves the domain; the optimum is 1.
std::shared_ptr<const NonlinearProgram> logarithmic_program();

/// Programmes without an optimum.
std::shared_ptr<const NonlinearProgram> infeasible_program();           ///< |c| has its minimum 1 at z = 0
std::shared_ptr<const NonlinearProgram> parallel_lines_program();       ///< two linear constraints that contradict
std::shared_ptr<const NonlinearProgram> unbounded_on_a_line_program();  ///< f falls for ever along its constraint
std::shared_ptr<const NonlinearProgram> unbounded_program();            ///< no constraints, f falls for ever
std::shared_ptr<const NonlinearProgram> undefined_program();            ///< f is NaN at the start and around it
std::shared_ptr<const NonlinearProgram> irregular_program();  ///< min z s.t. z^2 = 0: the optimum has no multiplier

enum class ControlBounds { None, Active };

/// A sparse programme of any size, 2 m^2 variables: a state s on a grid of spacing h follows its control d,
///     min 1/2 |s - t|^2 + 1/2 |d|^2   subject to   K s + h^2 s^3 - d = 0
/// with the five-point stencil K, and a target t that |d| <= 8 h^2 keeps out of reach. It can be restored. It has no
/// published optimum.
std::shared_ptr<const NonlinearProgram> control_program(int m, ControlBounds bounds);

}  // namespace softform::testing
