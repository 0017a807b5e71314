// Where the time goes on a mesh of the bunny's size (4975 vertices): a Newton step of the equilibrium, and a step of
// the rest-shape optimiser. Counters named share_* are fractions of the whole step.

#include <chrono>

#include <benchmark/benchmark.h>

#include "softform/inverse/rest_shape_design.hpp"
#include "softform/mesh/shapes.hpp"
#include "softform/objectives/collision_penalty.hpp"
#include "softform/objectives/edge_dihedral.hpp"
#include "softform/optimizers/normal_matrix.hpp"
#include "support/deformations.hpp"
#include "support/test_balloon.hpp"

namespace {

using namespace softform;
using namespace softform::testing;
using Clock = std::chrono::steady_clock;

constexpr int vertex_count = 4975;
constexpr double size = 0.146;  // [m]

template <class Work>
double seconds(const Work& work)
{
  const auto begin = Clock::now();
  work();
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// A bumpsphere inflated from half its size, and a state near its equilibrium.
struct Scene {
  TriangleMesh target = scale_to_diameter(bumpsphere(1, vertex_count), size);
  TestBalloon rest{{0.5 * target.vertices, target.triangles}, silicone()};
  Equilibrium inflated = inflate_to_volume(rest.balloon, enclosed_volume(target), rest.factorization);
  PressurePotential potential{rest.balloon, inflated.pressure, inflated.x};
  Vec x = inflated.x + 1e-5 * size * wiggle(3 * vertex_count, 3);
  Vec g;
  SparseMatrix K;

  Scene()
  {
    potential.gradient(x, g);
    potential.hessian(x, K);
    shift_diagonal(K, 1e-9 * K.diagonal().mean());
    rest.factorization.cholesky(K);
  }
};

Scene& scene()
{
  static Scene scene;
  return scene;
}

void tangent_assembly(benchmark::State& state)
{
  Scene& s = scene();
  SparseMatrix K;
  for (auto _ : state) s.potential.hessian(s.x, K);
}

void tangent_factorization(benchmark::State& state)
{
  Scene& s = scene();
  for (auto _ : state) benchmark::DoNotOptimize(s.rest.factorization.cholesky(s.K));
  state.counters["factor_nonzeros"] = s.rest.factorization.factor_nonzeros();
}

void tangent_solve(benchmark::State& state)
{
  Scene& s = scene();
  s.rest.factorization.cholesky(s.K);
  for (auto _ : state) benchmark::DoNotOptimize(s.rest.factorization.solve(s.g));
}

// A whole equilibrium solve from a state nearby, and its share of factorising and solving.
void newton_solve(benchmark::State& state)
{
  Scene& s = scene();
  double linear_algebra = 0, total = 0, steps = 0;
  for (auto _ : state) {
    Equilibrium found;
    total += seconds([&] { found = solve_equilibrium(s.potential, s.x, s.rest.factorization); });
    if (!found.report.converged()) state.SkipWithError("no equilibrium");
    state.PauseTiming();
    const double one_step = seconds([&] {
      s.rest.factorization.cholesky(s.K);
      benchmark::DoNotOptimize(s.rest.factorization.solve(s.g));
    });
    linear_algebra += one_step * found.report.evaluations.linear_solve;
    steps += found.iterations;
    state.ResumeTiming();
  }
  state.counters["ms_per_step"] = 1e3 * total / steps;
  state.counters["share_factorization_and_solve"] = linear_algebra / total;
}

// One linearisation, factorisation and solve of ReducedGaussNewton, without the equilibria that follow it.
void shape_step(benchmark::State& state)
{
  Scene& s = scene();
  const Triangles& triangles = s.target.triangles;
  const Vec goal = flatten(s.target.vertices);
  const double edge = mean_edge_length(s.rest.mesh);
  RestShapeDesign design;
  design.membrane = std::shared_ptr<const Membrane>(std::shared_ptr<void>(), &s.rest.membrane);
  design.pressure = s.inflated.pressure;
  design.force_scale = s.potential.force_scale();
  design.x0 = s.inflated.x;
  design.rest_positions0 = s.rest.balloon.rest_positions();
  design.state_terms = {{1, std::make_shared<EdgeDihedralDistance>(triangles, goal)}};
  design.design_terms = {
      {1e-2, std::make_shared<EdgeDihedralDistance>(triangles, design.rest_positions0, EdgeDihedralWeights{0, 1})},
      {1, std::make_shared<CollisionPenalty>(triangles, design.rest_positions0, 0.8 * edge, 3 * edge)}};
  const auto program = full_space_program(design);
  const Vec z = program->initial_point();

  Vec g;
  SparseMatrix H, J, D;
  NormalMatrix normal;
  SparseFactorization factorization;
  double derivatives = 0, assembly = 0, factorize = 0, solve = 0;
  const auto step = [&] {
    derivatives += seconds([&] {
      program->objective_gradient(z, g);
      program->constraint_jacobian(z, J);
      program->gauss_newton_hessian(z, H);
      program->step_metric(z, D);
    });
    const SparseMatrix* A = nullptr;
    assembly += seconds([&] { A = &normal.assemble(H, J, 1e3, D, 0.1); });
    factorize += seconds([&] { factorization.cholesky(*A); });
    solve += seconds([&] { benchmark::DoNotOptimize(factorization.solve(g)); });
  };
  step();  // patterns and symbolic analysis
  derivatives = assembly = factorize = solve = 0;
  for (auto _ : state) step();
  const double total = derivatives + assembly + factorize + solve;
  state.counters["share_derivatives"] = derivatives / total;
  state.counters["share_normal_matrix"] = assembly / total;
  state.counters["share_factorization"] = factorize / total;
  state.counters["share_solve"] = solve / total;
}

BENCHMARK(tangent_assembly)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(tangent_factorization)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(tangent_solve)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(newton_solve)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(shape_step)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
