#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <ceres/jet.h>

#include "softform/optimizers/nonlinear_program.hpp"

/// Small programmes from formulas, with exact first and second derivatives.
namespace softform::testing {

// Numbers that carry exact first and second derivatives in up to five variables.
constexpr int most_variables = 5;
using Dual = ceres::Jet<double, most_variables>;
using Number = ceres::Jet<Dual, most_variables>;
using Numbers = std::vector<Number>;
using Functions = std::function<Numbers(const Numbers&)>;

inline double value(const Number& f) { return f.a.a; }
inline double slope(const Number& f, int i) { return f.v[i].a; }
inline double curvature(const Number& f, int i, int j) { return f.v[i].v[j]; }

inline Numbers variables(ConstVec z)
{
  Numbers x;
  for (int i = 0; i < z.size(); ++i) {
    x.emplace_back(Dual(z[i], i));
    x.back().v[i] = Dual(1);
  }
  return x;
}

// Every entry is stored, zeros too: the pattern is the same at every call.
inline void store(const Eigen::MatrixXd& dense, SparseMatrix& matrix)
{
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < dense.cols(); ++j)
    for (int i = 0; i < dense.rows(); ++i) entries.emplace_back(i, j, dense(i, j));
  matrix.resize(dense.rows(), dense.cols());
  matrix.setFromTriplets(entries.begin(), entries.end());
}

// min |r(z)|^2 + f0(z)  subject to  c(z) = 0 and bounds.
struct Definition {
  std::string name;
  Vec start;
  Functions residuals;
  Functions rest;  // one entry f0, or none
  Functions constraints;
  Vec lower, upper;  // empty: none
};

inline Numbers none(const Numbers&) { return {}; }

class SmallProgram : public NonlinearProgram {
 public:
  explicit SmallProgram(Definition definition) : definition_(std::move(definition))
  {
    constraint_count_ = static_cast<int>(definition_.constraints(variables(definition_.start)).size());
  }

  std::string name() const override { return definition_.name; }
  int variable_count() const override { return static_cast<int>(definition_.start.size()); }
  int constraint_count() const override { return constraint_count_; }
  Vec initial_point() const override { return definition_.start; }
  Vec lower_bounds() const override
  {
    return definition_.lower.size() > 0 ? definition_.lower : NonlinearProgram::lower_bounds();
  }
  Vec upper_bounds() const override
  {
    return definition_.upper.size() > 0 ? definition_.upper : NonlinearProgram::upper_bounds();
  }
  double objective(ConstVec z) const override { return value(objective_number(z)); }
  void objective_gradient(ConstVec z, Vec& g) const override
  {
    const Number f = objective_number(z);
    g.resize(z.size());
    for (int i = 0; i < z.size(); ++i) g[i] = slope(f, i);
  }
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override
  {
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(z.size(), z.size());
    for (const Number& r : definition_.residuals(variables(z)))
      for (int i = 0; i < z.size(); ++i)
        for (int j = 0; j < z.size(); ++j) dense(i, j) += 2 * slope(r, i) * slope(r, j);
    store(dense, H);
  }
  void constraints(ConstVec z, Vec& c) const override
  {
    const Numbers numbers = definition_.constraints(variables(z));
    c.resize(constraint_count_);
    for (int k = 0; k < constraint_count_; ++k) c[k] = value(numbers[static_cast<std::size_t>(k)]);
  }
  void constraint_jacobian(ConstVec z, SparseMatrix& J) const override
  {
    const Numbers numbers = definition_.constraints(variables(z));
    Eigen::MatrixXd dense(constraint_count_, z.size());
    for (int k = 0; k < constraint_count_; ++k)
      for (int i = 0; i < z.size(); ++i) dense(k, i) = slope(numbers[static_cast<std::size_t>(k)], i);
    store(dense, J);
  }
  bool lagrangian_hessian(ConstVec z, ConstVec lambda, SparseMatrix& H) const override
  {
    Number L = objective_number(z);
    const Numbers c = definition_.constraints(variables(z));
    for (int k = 0; k < constraint_count_; ++k) L += Dual(lambda[k]) * c[static_cast<std::size_t>(k)];
    Eigen::MatrixXd dense(z.size(), z.size());
    for (int i = 0; i < z.size(); ++i)
      for (int j = 0; j < z.size(); ++j) dense(i, j) = curvature(L, i, j);
    store(dense, H);
    return true;
  }

 private:
  Number objective_number(ConstVec z) const
  {
    const Numbers x = variables(z);
    Number f(Dual(0));
    for (const Number& r : definition_.residuals(x)) f += r * r;
    for (const Number& f0 : definition_.rest(x)) f += f0;
    return f;
  }

  Definition definition_;
  int constraint_count_;
};

inline Vec vec(const std::vector<double>& entries)
{
  return Eigen::Map<const Vec>(entries.data(), static_cast<Eigen::Index>(entries.size()));
}

inline Number number(double constant) { return Number(Dual(constant)); }
inline Number square(const Number& a) { return a * a; }
inline Number cube(const Number& a) { return a * a * a; }

}  // namespace softform::testing
