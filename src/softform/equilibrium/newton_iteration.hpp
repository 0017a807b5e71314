#pragma once

#include <string>

#include "softform/equilibrium/newton.hpp"

namespace softform {

/// What the Newton methods under pressure and under volume control have in common.

/// The shift beta of an indefinite tangent, relative to its mean diagonal: fourfold after every failed factorisation,
/// a fifth after every full step. Near the equilibrium a shift that sufficed at once is given up: what is left of it
/// would keep the last steps from being quadratic.
class TangentShift {
 public:
  explicit TangentShift(const NewtonOptions& options) : first_(options.first_shift) {}

  double value() const { return beta_; }
  /// Returns by how much the shift grew.
  double raise();
  /// After a full step that led to the relative residual.
  void relax(double residual);
  /// No finite matrix needs as much.
  bool is_hopeless() const { return beta_ > 1e8; }

 private:
  double first_;
  double beta_ = 0;
  bool was_raised_ = false;  // since the last call to relax
};

void finish(Equilibrium& state, Termination termination, std::string message);

/// Writes the termination of iteration k into the report and returns true when the solve is over: because it
/// `is_balanced`, because something is not finite, at the iteration limit, or on interruption.
bool is_finished(Equilibrium& state, int k, double energy, bool is_balanced, const NewtonOptions& options);

}  // namespace softform
