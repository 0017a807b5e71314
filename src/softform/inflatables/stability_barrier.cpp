#include "softform/inflatables/stability_barrier.hpp"

#include <cmath>

namespace softform {
namespace {

double barrier(double t) { return t < 1 ? -(1 - t) * (1 - t) * std::log(t) : 0; }
double barrier_slope(double t) { return t < 1 ? (1 - t) * (2 * std::log(t) - (1 - t) / t) : 0; }
double barrier_curvature(double t)
{
  const double u = (1 - t) / t;
  return t < 1 ? u * (u + 4) - 2 * std::log(t) : 0;
}

}  // namespace

// As many as the barrier sees, and one more.
void StabilityBarrier::find_modes(ConstVec x, ConstVec p)
{
  if (x_.size() == x.size() && x_ == x && p_ == p) return;
  x_ = x;
  p_ = p;
  gradients_.resize(0, 0);
  constraint_->state_jacobian(x, p, K_);
  constexpr int most_modes = 24;
  for (int count = 3; count <= most_modes; count *= 2) {
    modes_ = soft_modes(K_, masses_, x, count, factorization_);
    if (modes_.stiffness.size() < count || modes_.stiffness[count - 1] >= 1) break;
  }
}

double StabilityBarrier::value(ConstVec x, ConstVec p)
{
  find_modes(x, p);
  if (modes_.stiffness.size() == 0) return HUGE_VAL;
  double sum = 0;
  for (const double sigma : modes_.stiffness) sum += barrier(sigma);
  return weight_ * sum;
}

// sigma = v^t K v, and a change of v does not change it.
void StabilityBarrier::find_gradients(ConstVec x, ConstVec p)
{
  find_modes(x, p);
  if (gradients_.rows() > 0) return;
  gradients_.resize(x.size() + p.size(), (modes_.stiffness.array() < 1).count());
  for (int i = 0; i < gradients_.cols(); ++i) {
    const Vec v = modes_.shapes.col(i);
    constraint_->force_hessian(x, p, v, xx_, mixed_, pp_);
    gradients_.col(i) << xx_ * v, mixed_.transpose() * v;
  }
}

Vec StabilityBarrier::gradient(ConstVec x, ConstVec p)
{
  find_gradients(x, p);
  Vec g = Vec::Zero(x.size() + p.size());
  for (int i = 0; i < gradients_.cols(); ++i) g += weight_ * barrier_slope(modes_.stiffness[i]) * gradients_.col(i);
  return g;
}

Eigen::MatrixXd StabilityBarrier::curvature_factors(ConstVec x, ConstVec p)
{
  find_gradients(x, p);
  Eigen::MatrixXd U = gradients_;
  for (int i = 0; i < U.cols(); ++i) U.col(i) *= std::sqrt(weight_ * barrier_curvature(modes_.stiffness[i]));
  return U;
}

}  // namespace softform
