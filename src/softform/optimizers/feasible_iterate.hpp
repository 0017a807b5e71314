#pragma once

#include "softform/optimizers/nonlinear_program.hpp"
#include "softform/optimizers/optimizer.hpp"

namespace softform {

/// The iterate of a method that stays feasible: after every step the programme restores it, and it is accepted on the
/// true objective alone.
class FeasibleIterate {
 public:
  /// Both outlive this object. Point and objective are kept in the solution, the time of restoration in its report.
  FeasibleIterate(const NonlinearProgram& program, Solution& solution) : program_(program), solution_(solution) {}

  /// Restores the first point. Returns false, and leaves it as it is, where that fails.
  bool start(const Vec& z);
  /// Restores the point at the step d; when its objective is lower, it is the new iterate.
  bool accepts(const Vec& d);

  /// Of the last accepted step: how much the objective fell, and how far the point moved, restoration included.
  double decrease() const { return decrease_; }
  double step_norm() const { return step_norm_; }

 private:
  std::optional<Vec> restore(const Vec& z);

  const NonlinearProgram& program_;
  Solution& solution_;
  double decrease_ = 0, step_norm_ = 0;
};

}  // namespace softform
