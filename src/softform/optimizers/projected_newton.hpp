#pragma once

#include "softform/linalg/sparse_factorization.hpp"
#include "softform/optimizers/augmented_function.hpp"
#include "softform/optimizers/counted_program.hpp"
#include "softform/optimizers/monitor.hpp"

namespace softform {

struct ProjectedNewtonOptions {
  HessianModel hessian = HessianModel::Exact;
  /// First damping alpha of H + alpha M, its factors after a good and a bad step, and its range: it falls fast, so that
  /// Newton's quadratic convergence is kept, and ends where only round-off is left to gain.
  double damping = 1e-3;
  double damping_decrease = 0.1;
  double damping_increase = 4;
  double smallest_damping = 1e-14;
  double largest_damping = 1e12;
  /// Faces of the box explored in a step: each one costs a factorisation and finds more of the active bounds.
  int largest_face_count = 8;
};

/// Minimises the augmented function within the bounds (3.54) for fixed multipliers and penalty, by gradient projection:
/// each step minimises the damped quadratic model first along the projected gradient, which gives the Cauchy point, and
/// then on the face of the box where that lies (3.55; Nocedal and Wright 2000, 16.6; Lin and More 1999). Without bounds
/// this is Newton's method, damped after Levenberg and Marquardt. Every step goes into the trace.
class ProjectedNewton {
 public:
  enum class Outcome {
    Done,     ///< stationary to the tolerance, or too little progress to go on
    Stalled,  ///< no step lowers the function, however small
    Ended,    ///< the whole run has to end; its report says why
  };

  /// All arguments but the options outlive this object.
  ProjectedNewton(const NonlinearProgram& program, const ProjectedNewtonOptions& options, const StopCriteria& stop,
                  const IterationObserver& observer);

  /// Records the start, projected into the bounds. Returns false when the run has to end there.
  bool start();
  Outcome minimize(double tolerance);

  AugmentedFunction& function() { return function_; }
  const AugmentedPoint& point() const { return point_; }
  /// Relative to the gradient of f, see StopCriteria.
  double stationarity() const { return stationarity(point_); }

  /// Ends a run at a feasible point: Converged where it is stationary, Stalled where the last minimisation was already
  /// asked for that and failed. Returns false where there is hope.
  bool finish_feasible(double inner_tolerance);
  /// Ends a run with the penalty at its cap: Infeasible where the constraints' norm has a minimum, Stalled elsewhere.
  void finish_infeasible();
  Solution solution() &&;

 private:
  void finish(Termination termination, const std::string& message) { monitor_.finish(termination, message); }
  bool refresh();
  bool record(double step_norm);
  bool advance();
  bool lowers_value(AugmentedPoint& trial, double predicted);
  bool lowers_gradient(AugmentedPoint& trial);
  std::optional<Vec> model_minimizer(const SparseMatrix& A);
  Vec cauchy_point(const SparseMatrix& A) const;
  std::optional<Vec> face_minimizer(const SparseMatrix& A, ConstVec z);
  double model_value(const SparseMatrix& A, ConstVec s) const;
  Vec projected(const Vec& z, const Vec& v) const;
  double stationarity(const AugmentedPoint& point) const;
  Vec project(ConstVec z) const { return z.cwiseMax(lower_).cwiseMin(upper_); }

  Solution solution_;
  CountedProgram program_;
  ProjectedNewtonOptions options_;
  const StopCriteria& stop_;
  Monitor monitor_;
  AugmentedFunction function_;
  Vec lower_, upper_;
  bool has_bounds_;
  AugmentedPoint point_;
  double damping_;
  int k_ = 0;
  SparseMatrix face_;
  SparseFactorization factorization_;
};

}  // namespace softform
