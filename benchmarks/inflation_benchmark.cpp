// The static solve of nearly inextensible panels, which is the inner loop of pattern optimisation: a sphere of three
// lunes, kappa h / (p R) = 1000, inflated from its target, and solved again after its flat panels changed smoothly, by
// some per mille of their size: from the old nodes, and from the nodes that the tangent predicts. The counter
// `iterations` is what counts; shares are of the whole:
//   build/release/bin/inflation_benchmark --benchmark_filter=again

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

#include "softform/inflatables/inflatable.hpp"
#include "softform/materials/tension_field.hpp"

namespace {

using namespace softform;

constexpr double kappa = 1e7, thickness = 1e-4, residual = 1e-5;

struct Scene {
  explicit Scene(int rows) : layout(three_lune_sphere(1, rows)) {}

  PanelLayout layout;
  Inflatable inflatable{layout, std::make_shared<TensionField>(kappa, 0, residual), thickness, 1};
  Vec flat = flat_vector(layout);
  SparseFactorization factorization;

  Equilibrium inflated() { return inflate(inflatable, flat, flatten(layout.nodes), factorization); }

  // Every panel stretched smoothly, differently along its axes, by up to `amount`.
  Vec changed_flat(double amount) const
  {
    Vec X = flat;
    for (std::size_t k = 0; k < layout.panels.size(); ++k) {
      const Panel& panel = layout.panels[k];
      for (int v = panel.first_vertex; v < panel.first_vertex + panel.vertex_count; ++v) {
        const double a = flat[2 * v], b = flat[2 * v + 1];
        X[2 * v] *= 1 + amount * std::sin(2.1 * b + double(k));
        X[2 * v + 1] *= 1 + amount * std::cos(1.3 * a + 2 * double(k));
      }
    }
    return X;
  }

  // x + dx/dX (X - flat).
  Vec predicted(const Vec& x, const Vec& X)
  {
    SparseMatrix K, B;
    inflatable.hessian(x, flat, K);
    shift_diagonal(K, 1e-9 * K.diagonal().cwiseAbs().mean());
    inflatable.mixed_hessian(x, flat, B);
    factorization.cholesky(K);
    return x - factorization.solve(Vec(B * (X - flat)));
  }
};

void report(benchmark::State& state, const Equilibrium& e)
{
  if (!e.report.converged()) state.SkipWithError("no equilibrium");
  const PhaseTimes& times = e.report.times;
  const double total = times.assembly + times.factorization + times.solve;
  state.counters["iterations"] = e.iterations;
  state.counters["factorizations"] = e.report.evaluations.linear_solve;
  state.counters["share_assembly"] = times.assembly / total;
  state.counters["share_factorization"] = times.factorization / total;
}

void inflate_from_target(benchmark::State& state)
{
  Scene scene(static_cast<int>(state.range(0)));
  Equilibrium e;
  for (auto _ : state) e = scene.inflated();
  report(state, e);
}

// Arguments: rows of the sphere, change in per mille, 1 to start from the predicted nodes.
void solve_again(benchmark::State& state)
{
  Scene scene(static_cast<int>(state.range(0)));
  const Vec x = scene.inflated().x, X = scene.changed_flat(1e-3 * static_cast<double>(state.range(1)));
  const Vec x0 = state.range(2) == 1 ? scene.predicted(x, X) : x;
  Equilibrium e;
  for (auto _ : state) e = inflate(scene.inflatable, X, x0, scene.factorization);
  report(state, e);
}

BENCHMARK(inflate_from_target)->Unit(benchmark::kMillisecond)->Arg(11)->Arg(22)->MeasureProcessCPUTime();
BENCHMARK(solve_again)
    ->Unit(benchmark::kMillisecond)
    ->ArgsProduct({{11, 16, 22}, {1, 5, 20, 50}, {0, 1}})
    ->ArgNames({"rows", "permille", "predicted"})
    ->MeasureProcessCPUTime();

}  // namespace
