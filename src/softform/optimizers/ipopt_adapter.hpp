#pragma once

#include "softform/optimizers/optimizer.hpp"

namespace softform {

struct IpoptOptions {
  /// IPOPT's tolerance in units of StopCriteria's: it tests a scaled optimality error, which may hide a digit.
  double tolerance_factor = 0.1;
};

/// IPOPT, the interior-point method of Waechter and Biegler 2006, on our programmes: the reference for the others. It
/// gets exact Hessians where the programme has them, and limited-memory updates elsewhere. What it returns is evaluated
/// again. Built with SOFTFORM_WITH_IPOPT only (it is under the EPL).
class IpoptAdapter : public Optimizer {
 public:
  explicit IpoptAdapter(const IpoptOptions& options = {}) : options_(options) {}
  Solution minimize(const NonlinearProgram& program, const StopCriteria& stop = {},
                    const IterationObserver& observer = {}) const override;

 private:
  IpoptOptions options_;
};

}  // namespace softform
