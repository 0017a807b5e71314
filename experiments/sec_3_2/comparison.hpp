// What the experiments that compare optimisers share: a problem in both of its formulations, every registered method
// that can take it, what each made of it, and the table of outcomes.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "softform/experiment/run.hpp"
#include "softform/optimizers/optimizer.hpp"

namespace softform {

/// One problem, in the full space, in the design alone, or both. Every method gets a programme of its own: programmes
/// remember where they were evaluated last.
struct Instance {
  std::string name;
  double largest_cpu_s = HUGE_VAL;
  std::function<std::unique_ptr<NonlinearProgram>()> full, reduced;
  bool has_potential = false;  // its stability is the sign of the eigenvalues of df/dx
};

/// What a method made of an instance.
struct Outcome {
  std::string formulation, method;
  Solution solution;
  double cpu_s = 0;
  // Of the result, and of the stable equilibrium at its design, where there is one.
  int negative_eigenvalues = -1;  // of df/dx at the result; -1 is not known
  bool has_equilibrium = true;
  double moved = 0, objective = NAN;
  // Until the best objective is reached within 5 %, balanced; infinite where it never is.
  double reached_s = HUGE_VAL, reached_solves = HUGE_VAL;

  std::string name() const { return method + "_" + formulation; }
  const Iterate& last() const { return solution.report.trace.back(); }
};

/// All methods on all instances, and the table of outcomes.
class Comparison {
 public:
  explicit Comparison(Run& run) : run_(run) {}

  /// Methods that do not come within 5 % of the best objective on one balloon are not tried on the next, larger one.
  void balloon(const Instance& instance);
  void sheet(const Instance& instance);
  void rubber(const Instance& instance);
  /// A layout of two materials.
  void layout(const Instance& instance);

 private:
  std::pair<std::vector<Outcome>, double> compare(const Instance& instance, double relative_decrease);

  Run& run_;
  std::set<std::string> given_up_;
  std::string table_ =
      "instance,formulation,method,termination,objective,infeasibility,stationarity,linear_solves,cpu [s],"
      "reached_linear_solves,reached_cpu [s],negative_eigenvalues,has_equilibrium,moved,resolved_objective\n";
};

}  // namespace softform
