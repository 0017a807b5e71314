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

template <int dim>
void measure_stage(CharacterStage<dim>& stage, const std::vector<Vec>& targets, const FixedDofs& fixed,
                   const PosePotential<dim>& potential)
{
  const auto grey = (stage.densities.array() > 1e-3 && stage.densities.array() < 1 - 1e-3).count();
  stage.grey_elements = static_cast<int>(grey);
  stage.errors.clear();
  stage.residuals.clear();
  stage.negative_eigenvalues.clear();
  SparseFactorization factorization;
  for (std::size_t i = 0; i < stage.positions.size(); ++i) {
    const LoadedSolid<dim> loaded = potential(i);
    const Vec& x = stage.positions[i];
    stage.errors.push_back(pose_error<dim>(x, targets[i]));
    Vec g;
    SparseMatrix K;
    loaded.gradient(x, g);
    fixed.project(g);
    loaded.hessian(x, K);
    fixed.project(K, K.diagonal().cwiseAbs().mean());
    stage.residuals.push_back(largest_nodal_norm(g, dim) / loaded.force_scale());
    stage.negative_eigenvalues.push_back(count_negative_eigenvalues(std::move(K), factorization));
  }
}

template struct CharacterStage<2>;
template struct CharacterStage<3>;

template void measure_stage<2>(CharacterStage<2>&, const std::vector<Vec>&, const FixedDofs&, const PosePotential<2>&);
template void measure_stage<3>(CharacterStage<3>&, const std::vector<Vec>&, const FixedDofs&, const PosePotential<3>&);

}  // namespace softform
