#include "softform/characters/character_stage.hpp"

#include <algorithm>
#include <numeric>

namespace softform {

template <int dim>
double CharacterStage<dim>::mean_error() const
{
  double sum = 0;
  for (const PoseError& error : errors) sum += error.mean;
  return sum / double(errors.size());
}

template <int dim>
double CharacterStage<dim>::mean_max_error() const
{
  double sum = 0;
  for (const PoseError& error : errors) sum += error.max;
  return sum / double(errors.size());
}

template <int dim>
bool CharacterStage<dim>::is_sound() const
{
  return std::all_of(residuals.begin(), residuals.end(), [](double r) { return r < 1e-6; }) &&
         std::all_of(negative_eigenvalues.begin(), negative_eigenvalues.end(), [](int n) { return n == 0; });
}

template struct CharacterStage<2>;
template struct CharacterStage<3>;

}  // namespace softform
