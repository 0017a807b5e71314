// Purpose: what an uneven coat of rubber does to a balloon (thesis section 4.6). The bunny's optimised rest shape is
// given thicknesses that vary by 10 and 20 % from triangle to triangle, independently, smoothly over a correlation
// length, or as a brushed coat that has run from the mould's ridges into its troughs (the thesis' own explanation of
// what went wrong with the armadillo and the hand), and inflated again at the design's pressure.
// Claim: the inflated shape moves by 0.22 cm in the mean at 10 %, by 0.52 cm at 20 %.

#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "softform/balloons/balloon_design.hpp"
#include "softform/balloons/thickness_levelling.hpp"
#include "softform/balloons/thickness_noise.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/io/datasets.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/materials/material_file.hpp"

namespace {

using namespace softform;

constexpr double levelling_length =
    2e-3;  // [m]: silicone of 0.3 mm, 10 Pa s, 20 mN/m levels so far in some ten minutes
constexpr int samples = 20;

// Standard normal numbers for every triangle, one field a seed.
using Field = std::function<Vec(unsigned seed)>;

// The optimised bunny, to be inflated with other thicknesses.
class Bunny {
 public:
  explicit Bunny(Run& run)
      : target_(scale_to_diameter(load_dataset("bunny", run.by_size(1200, 4975)), 0.146)),
        silicone_(load_material("silicone"))
  {
    run.step("designing the bunny");
    const auto observer = run.observer();
    design_ = design_balloon(target_, silicone_, {}, [&](const BalloonProgress& progress) {
      return progress.iterate == nullptr || observer(*progress.iterate);
    });
  }

  const BalloonDesign& design() const { return design_; }
  const TriangleMesh& target() const { return target_; }

  // A stable equilibrium at the design's pressure, from the design's own; nothing where none is found.
  std::optional<TriangleMesh> inflated(const Vec& thickness)
  {
    const Membrane membrane(target_.triangles, target_.vertex_count(), silicone_, thickness);
    const PressurizedMembrane balloon(membrane, flatten(design_.rest.vertices));
    const Equilibrium found =
        solve_at_pressure(balloon, design_.pressure, flatten(design_.inflated.vertices), factorization_);
    if (!found.report.converged()) return std::nullopt;
    return aligned_to(design_.inflated, found.x);
  }

 private:
  TriangleMesh target_;
  std::shared_ptr<const Material> silicone_;
  BalloonDesign design_;
  SparseFactorization factorization_;
};

struct Sample {
  double deviation, max_deviation, distance;  // [m]: from the design, mean and largest; from the target, mean
};

struct Mean {
  double value, half_width;  // of the 95 % confidence interval
};

// Student's t for 19 degrees of freedom; samples that have no equilibrium make it NaN.
Mean mean_of(const std::vector<double>& values)
{
  if (values.size() != samples) return {std::nan(""), std::nan("")};
  const Eigen::Map<const Vec> x(values.data(), samples);
  const double variance = (x.array() - x.mean()).square().sum() / (samples - 1);
  return {x.mean(), 2.093 * std::sqrt(variance / samples)};
}

std::optional<Sample> inflate(Bunny& bunny, const Vec& z, double variation, const std::string& file)
{
  const Vec thickness = varied_thickness(z, BalloonOptions{}.thickness, variation);
  const auto shape = bunny.inflated(thickness);
  if (!shape) return std::nullopt;
  Vec deviations;
  const ShapeDistance moved = shape_distance(*shape, bunny.design().inflated, &deviations);
  if (!file.empty()) write_vtp(file, *shape, {{{"deviation [m]", deviations}}, {{"thickness [m]", thickness}}});
  return Sample{moved.mean, moved.max, shape_distance(*shape, bunny.target()).mean};
}

// In per cent.
std::vector<int> variations(const Run& run) { return run.by_size<std::vector<int>>({20}, {10, 20}); }

// The `samples` inflated balloons of a kind of coat, at both variations.
void study(Run& run, Bunny& bunny, const std::string& name, double correlation_length, const Field& field)
{
  auto& table = run.series("deviations", {{"correlation_length", "m"},
                                          {"variation", "1"},
                                          {"deviation", "m"},
                                          {"half_width", "m"},
                                          {"max_deviation", "m"},
                                          {"distance", "m"}});
  for (const int percent : variations(run)) {
    run.step(fmt::format("{} {} %", name, percent));
    std::vector<double> deviations, largest, distances;
    for (unsigned k = 0; k < samples; ++k) {
      const std::string file = k == 0 ? run.path(fmt::format("{}_{}.vtp", name, percent)).string() : "";
      run.progress(fmt::format("sample {}", k + 1));
      const auto sample = inflate(bunny, field(1000 * run.seed() + k), percent / 100.0, file);
      if (!sample) continue;
      deviations.push_back(sample->deviation);
      largest.push_back(sample->max_deviation);
      distances.push_back(sample->distance);
    }
    const Mean deviation = mean_of(deviations);
    run.metric(fmt::format("deviation_{}_{}", name, percent), deviation.value, "m");
    run.metric(fmt::format("deviation_{}_{}_half_width", name, percent), deviation.half_width, "m");
    run.metric(fmt::format("without_equilibrium_{}_{}", name, percent), samples - double(deviations.size()), "1");
    table.add_row({correlation_length, percent / 100.0, deviation.value, deviation.half_width, mean_of(largest).value,
                   mean_of(distances).value});
  }
}

void vary_thickness(Run& run)
{
  // 1. The balloon, evenly coated, and its own inflation again: the zero of all deviations.
  Bunny bunny(run);
  const TriangleMesh& mould = bunny.design().rest;
  run.metric("negative_eigenvalues", bunny.design().negative_eigenvalues, "1");
  run.metric("design_distance", shape_distance(bunny.design().inflated, bunny.target()).mean, "m");
  const auto even = inflate(bunny, Vec::Zero(mould.triangle_count()), 0, run.path("even.vtp"));
  run.metric("deviation_even", even ? even->deviation : std::nan(""), "m");

  // 2. Noise: independent, correlated, and one factor for the whole balloon, which is the limit of a long correlation.
  const double nan = std::nan("");
  const int count = mould.triangle_count();
  study(run, bunny, "independent", 0, [&](unsigned seed) { return independent_noise(count, seed); });
  study(run, bunny, "uniform", HUGE_VAL,
        [&](unsigned seed) -> Vec { return Vec::Constant(count, independent_noise(1, seed)[0]); });
  for (const int millimetres : {5, 20, 40}) {
    if (!run.is_paper() && millimetres != 40) continue;
    run.step(fmt::format("noise of {} mm", millimetres));
    const SurfaceNoise noise(mould, 1e-3 * millimetres);
    study(run, bunny, fmt::format("correlated_{}mm", millimetres), 1e-3 * millimetres,
          [&](unsigned seed) { return noise.on_triangles(seed); });
  }

  // 3. A brushed coat: strokes of 1 cm, alone and with as much variance again from rubber that ran into the troughs.
  run.step("noise of 10 mm");
  const SurfaceNoise strokes(mould, 0.01);
  if (run.is_paper())
    study(run, bunny, "correlated_10mm", 0.01, [&](unsigned seed) { return strokes.on_triangles(seed); });
  const Vec troughs = standardized_on_triangles(mould, levelled_film(mould, levelling_length));
  study(run, bunny, "brushed", nan,
        [&](unsigned seed) -> Vec { return (troughs + strokes.on_triangles(seed)) / std::sqrt(2.0); });
  for (const int percent : variations(run)) {
    const auto sample = inflate(bunny, troughs, percent / 100.0, run.path(fmt::format("troughs_{}.vtp", percent)));
    run.metric(fmt::format("deviation_troughs_{}", percent), sample ? sample->deviation : nan, "m");
  }
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv,
      {"sec_4_6_thickness",
       "4.6",
       "Thickness that varies by 10 and 20 % moves the inflated bunny by some 0.2 and 0.5 cm.",
       {0.3, 6}},
      vary_thickness);
}
