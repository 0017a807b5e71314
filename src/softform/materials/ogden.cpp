#include "softform/materials/ogden.hpp"

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {

void check_parameters(const Ogden<double>& model)
{
  for (std::size_t j = 0; j < model.alpha.size(); ++j) {
    if (model.alpha[j] == 0)
      throw InputError(
          fmt::format("ogden: alpha_{} is zero, so its term is 0/0: take "
                      "another exponent or drop the term",
                      j + 1));
  }
  if (model.shear_modulus() <= 0)
    throw InputError(
        fmt::format("ogden: the mu_j sum to {:g} Pa; the sum is "
                    "the shear modulus and must be positive",
                    model.shear_modulus()));
}

MaterialModel ogden_model()
{
  // A fit keeps to mu_j > 0, which makes every term convex in the logarithmic stretches: stable at any stretch.
  constexpr bool is_sum = true;
  return material_model_of<Ogden>("ogden", {{"mu", "Pa"}, {"alpha", "1", Range::Real}}, is_sum);
}

}  // namespace softform
