// Purpose: figure 4.7, left: measurements of latex and the Hart-Smith model fitted to them. The thesis' measurements
// are not public; Treloar's equibiaxial extension of a latex rubber (1944, figure 2, curve a) takes their place, drawn
// as he drew it, nominal stress against stretch. Claim: Hart-Smith follows latex through all three regimes, to an
// extension ratio beyond 5.

#include <cmath>

#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/fitting/trust.hpp"

namespace {

using namespace softform;

void fit_latex(Run& run)
{
  // 1. The measured curve.
  const std::vector<RubberTest> tests{load_rubber_test("treloar_1944_latex_equibiaxial")};
  auto& measured = run.series("measured", {{"stretch", "1"}, {"stress", "Pa"}});
  for (const StressObservation& observation : tests[0].observations)
    measured.add_row({observation.stretches[0], observation.stress});

  // 2. Each model fitted to it, with its curve.
  std::vector<Column> columns{{"stretch", "1"}};
  std::vector<std::shared_ptr<const Material>> materials;
  for (const MaterialModel& model : material_models()) {
    run.step(model.name);
    const MaterialFit fit = fit_material(model.name, tests, {});
    columns.push_back({model.name, "Pa"});
    materials.push_back(fit.material);
    const StressError error = stress_error(*fit.material, tests);
    run.metric("rms_" + model.name, error.rms, "Pa");
    run.metric("mean_relative_error_" + model.name, error.mean_relative, "1");
    if (model.name != "hart_smith") continue;
    for (const auto& [name, value, unit] : fit.material->parameters()) run.metric(name, value, unit);
    const StressFit problem(model, tests, Weights::Absolute, 1);
    const Uncertainty u = uncertainty(problem, fit.z);
    for (std::size_t j = 0; j < u.standard_errors.size(); ++j)
      run.metric("standard_error_" + problem.parameters()[j].name, u.standard_errors[j], problem.parameters()[j].unit);
  }
  auto& curves = run.series("fitted", columns);
  constexpr int samples = 200;
  const double last = tests[0].observations.back().stretches[0];
  for (int k = 0; k <= samples; ++k) {
    const double stretch = 1 + (last - 1) * k / samples;
    std::vector<double> row{stretch};
    for (const auto& material : materials)
      row.push_back(nominal_stress(*material, stretches_of(TestMode::Equibiaxial, stretch))[0]);
    curves.add_row(row);
  }
  run.metric("largest_stretch", last, "1");
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(argc, argv,
                                  {"fig_4_7",
                                   "4.6",
                                   "The Hart-Smith model follows latex to an extension ratio beyond 5 (left half).",
                                   {0.05, 0.05}},
                                  fit_latex);
}
