#include "softform/optimizers/trust_region.hpp"

#include <cmath>
#include <utility>

namespace softform {

TrustRegionModel::TrustRegionModel(const KktSystem& metric, const SparseMatrix& H, const Eigen::MatrixXd& U,
                                   const Vec& g)
    : metric_(metric), H_(H), U_(U), g_(g), zero_(Vec::Zero(metric.constraint_count())), projected_(project(g))
{}

double TrustRegionModel::metric_norm() const { return std::sqrt(std::abs(g_.dot(projected_))); }

TrustRegionStep TrustRegionModel::with_decrease(TrustRegionStep step) const
{
  step.predicted_decrease = -(g_.dot(step.d) + 0.5 * step.d.dot(product(step.d)));
  return step;
}

TrustRegionStep TrustRegionModel::step(double radius) const
{
  constexpr int most_products = 60;
  constexpr double tolerance = 0.1;
  TrustRegionStep step{.d = Vec::Zero(g_.size())};
  Vec r = g_, p = -projected_;
  double ry = r.dot(projected_), dd = 0, dp = 0, pp = ry;  // products in M, by the recurrences of r and p
  const double target = tolerance * tolerance * ry;
  for (int k = 0; k < most_products && ry > 0; ++k) {
    const Vec Hp = product(p);
    const double curvature = p.dot(Hp), length = ry / curvature;
    const double next = dd + length * (2 * dp + length * pp);
    if (!(curvature > 0) || next >= radius * radius) {
      step.d += (std::sqrt(dp * dp + pp * (radius * radius - dd)) - dp) / pp * p;
      step.norm = radius;
      step.is_on_boundary = true;
      return with_decrease(std::move(step));
    }
    step.d += length * p;
    step.norm = std::sqrt(next);
    r += length * Hp;
    const Vec y = project(r);
    const double next_ry = r.dot(y);
    if (next_ry <= target) break;
    const double conjugation = next_ry / ry;
    dd = next;
    dp = conjugation * (dp + length * pp);
    pp = next_ry + conjugation * conjugation * pp;
    p = conjugation * p - y;
    ry = next_ry;
  }
  return with_decrease(std::move(step));
}

}  // namespace softform
