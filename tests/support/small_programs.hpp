#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "softform/optimizers/least_squares_program.hpp"
#include "support/auto_program.hpp"

/// Small programmes with known optima, and broken ones.
namespace softform::testing {

/// An optimum with its multipliers of L = f + lambda . c.
struct Optimum {
  Vec z, lambda;
};

struct Problem {
  std::unique_ptr<NonlinearProgram> program;
  Optimum optimum;
};

inline Vec vec(std::initializer_list<double> values)
{
  return Eigen::Map<const Vec>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

/// What the models share: sizes, and no bounds.
template <int variables, int equations>
struct Model {
  static constexpr int n = variables, m = equations;
  std::array<double, n> lower = filled(-HUGE_VAL), upper = filled(HUGE_VAL);

 private:
  static constexpr std::array<double, n> filled(double value)
  {
    std::array<double, n> entries;
    entries.fill(value);
    return entries;
  }
};

// Hock and Schittkowski 1981, problems 6, 7, 28 and 39; multipliers by hand from f' + J^t lambda = 0.
struct Hs6 : Model<2, 1> {
  static constexpr auto name = "hs6";
  std::array<double, n> start{-1.2, 1};
  template <class S>
  S f(const S* z) const
  {
    return (1.0 - z[0]) * (1.0 - z[0]);
  }
  template <class S>
  void c(const S* z, S* out) const
  {
    out[0] = 10.0 * (z[1] - z[0] * z[0]);
  }
};

struct Hs7 : Model<2, 1> {
  static constexpr auto name = "hs7";
  std::array<double, n> start{2, 2};
  template <class S>
  S f(const S* z) const
  {
    using std::log;
    return log(1.0 + z[0] * z[0]) - z[1];
  }
  template <class S>
  void c(const S* z, S* out) const
  {
    const S a = 1.0 + z[0] * z[0];
    out[0] = a * a + z[1] * z[1] - 4.0;
  }
};

struct Hs28 : Model<3, 1> {
  static constexpr auto name = "hs28";
  std::array<double, n> start{-4, 1, 1};
  template <class S>
  S f(const S* z) const
  {
    const S a = z[0] + z[1], b = z[1] + z[2];
    return a * a + b * b;
  }
  template <class S>
  void c(const S* z, S* out) const
  {
    out[0] = z[0] + 2.0 * z[1] + 3.0 * z[2] - 1.0;
  }
};

struct Hs39 : Model<4, 2> {
  static constexpr auto name = "hs39";
  std::array<double, n> start{2, 2, 2, 2};
  template <class S>
  S f(const S* z) const
  {
    return -1.0 * z[0];
  }
  template <class S>
  void c(const S* z, S* out) const
  {
    out[0] = z[1] - z[0] * z[0] * z[0] - z[2] * z[2];
    out[1] = z[0] * z[0] - z[1] - z[3] * z[3];
  }
};

/// HS 7 with its constraint a second time, doubled: J never has full rank; lambda_1 + 2 lambda_2 is unique.
struct Degenerate : Hs7 {
  static constexpr auto name = "degenerate hs7";
  static constexpr int m = 2;
  template <class S>
  void c(const S* z, S* out) const
  {
    Hs7::c(z, out);
    out[1] = 2.0 * out[0];
  }
};

/// Powell 1986's example of the Maratos effect: f falls along the unit circle, but full Newton steps leave it.
struct Maratos : Model<2, 1> {
  static constexpr auto name = "maratos";
  std::array<double, n> start{std::cos(0.5), std::sin(0.5)};
  template <class S>
  S f(const S* z) const
  {
    return 2.0 * (z[0] * z[0] + z[1] * z[1] - 1.0) - z[0];
  }
  template <class S>
  void c(const S* z, S* out) const
  {
    out[0] = z[0] * z[0] + z[1] * z[1] - 1.0;
  }
};

/// f is not finite left of zero, where the first full step goes.
struct LogBarrier : Model<1, 0> {
  static constexpr auto name = "log barrier";
  std::array<double, n> start{10};
  template <class S>
  S f(const S* z) const
  {
    using std::log;
    return z[0] - log(z[0]);
  }
  template <class S>
  void c(const S*, S*) const
  {}
};

struct NotFiniteAtStart : LogBarrier {
  static constexpr auto name = "not finite at the start";
  std::array<double, n> start{-1};
};

/// Two parallel lines.
struct Infeasible : Model<2, 2> {
  static constexpr auto name = "infeasible";
  std::array<double, n> start{3, -1};
  template <class S>
  S f(const S* z) const
  {
    return z[0] * z[0] + z[1] * z[1];
  }
  template <class S>
  void c(const S* z, S* out) const
  {
    out[0] = z[0] + z[1];
    out[1] = z[0] + z[1] - 2.0;
  }
};

/// z^2 + 1 is never zero.
struct InfeasibleCurve : Model<1, 1> {
  static constexpr auto name = "infeasible curve";
  std::array<double, n> start{2};
  template <class S>
  S f(const S* z) const
  {
    return z[0];
  }
  template <class S>
  void c(const S* z, S* out) const
  {
    out[0] = z[0] * z[0] + 1.0;
  }
};

struct UnboundedBelow : Model<2, 1> {
  static constexpr auto name = "unbounded below";
  std::array<double, n> start{1, 1};
  template <class S>
  S f(const S* z) const
  {
    return -1.0 * z[0] - z[1] * z[1];
  }
  template <class S>
  void c(const S* z, S* out) const
  {
    out[0] = z[0] - z[1];
  }
};

template <class M>
Problem problem(const Vec& z, const Vec& lambda)
{
  return {std::make_unique<AutoProgram<M>>(), {z, lambda}};
}

inline std::vector<Problem> equality_problems()
{
  std::vector<Problem> problems;
  problems.push_back(problem<Hs6>(vec({1, 1}), vec({0})));
  problems.push_back(problem<Hs7>(vec({0, std::sqrt(3)}), vec({0.5 / std::sqrt(3)})));
  problems.push_back(problem<Hs28>(vec({.5, -.5, .5}), vec({0})));
  problems.push_back(problem<Hs39>(vec({1, 1, 0, 0}), vec({-1, -1})));
  problems.push_back(problem<Maratos>(vec({1, 0}), vec({-1.5})));
  return problems;
}

/// Rosenbrock's residuals (10 (y - x^2), 1 - x) with x <= limit: for limit < 1 the optimum is (limit, limit^2), where
/// the bound's multiplier is limit - 1.
class Rosenbrock : public LeastSquaresProgram {
 public:
  explicit Rosenbrock(double limit = HUGE_VAL) : limit_(limit) {}
  std::string name() const override { return "rosenbrock"; }
  int variable_count() const override { return 2; }
  int residual_count() const override { return 2; }
  Vec initial_point() const override { return vec({-1.2, 1}); }
  Vec upper_bounds() const override { return vec({limit_, HUGE_VAL}); }
  void residuals(ConstVec z, Vec& r) const override { r = vec({10 * (z[1] - z[0] * z[0]), 1 - z[0]}); }
  void residual_jacobian(ConstVec z, SparseMatrix& R) const override
  {
    R.resize(2, 2);
    R.insert(0, 0) = -20 * z[0];
    R.insert(1, 0) = -1;
    R.insert(0, 1) = 10;
    R.makeCompressed();
  }

 private:
  double limit_;
};

/// Another programme without its exact Hessian.
class WithoutExactHessian : public NonlinearProgram {
 public:
  explicit WithoutExactHessian(const NonlinearProgram& program) : program_(program) {}
  std::string name() const override { return program_.name(); }
  int variable_count() const override { return program_.variable_count(); }
  int constraint_count() const override { return program_.constraint_count(); }
  Vec initial_point() const override { return program_.initial_point(); }
  double objective(ConstVec z) const override { return program_.objective(z); }
  void objective_gradient(ConstVec z, Vec& g) const override { program_.objective_gradient(z, g); }
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override { program_.gauss_newton_hessian(z, H); }
  void constraints(ConstVec z, Vec& c) const override { program_.constraints(z, c); }
  void constraint_jacobian(ConstVec z, SparseMatrix& J) const override { program_.constraint_jacobian(z, J); }

 private:
  const NonlinearProgram& program_;
};

}  // namespace softform::testing
