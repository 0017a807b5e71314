#include "softform/objectives/weighted_sum.hpp"

namespace softform {

double weighted_value(const std::vector<WeightedObjective>& terms, ConstVec x)
{
  double sum = 0;
  for (const auto& [weight, objective] : terms) sum += weight * objective->value(x);
  return sum;
}

Vec weighted_gradient(const std::vector<WeightedObjective>& terms, ConstVec x)
{
  Vec sum = Vec::Zero(x.size()), g;
  for (const auto& [weight, objective] : terms) {
    objective->gradient(x, g);
    sum += weight * g;
  }
  return sum;
}

void TermHessians::add_gauss_newton(SparseSum& sum, ConstVec x, int offset)
{
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    terms_[k].objective->gauss_newton_hessian(x, hessians_[k]);
    sum.add(hessians_[k], terms_[k].weight, offset, offset);
  }
}

bool TermHessians::add_exact(SparseSum& sum, ConstVec x, int offset)
{
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    if (!terms_[k].objective->hessian(x, hessians_[k])) return false;
    sum.add(hessians_[k], terms_[k].weight, offset, offset);
  }
  return true;
}

}  // namespace softform
