// A whole balloon design, from the target to the checked rest shape, and where its time goes. Counters named share_*
// are fractions of the whole; CPU time is that of all threads, which does not depend on what else the machine does:
//   build/release/bin/balloon_design_benchmark --benchmark_filter=bunny
// The scanned models are those that `softform-datasets prepare` keeps in the cache.

#include <benchmark/benchmark.h>

#include "softform/balloons/balloon_design.hpp"
#include "softform/io/datasets.hpp"
#include "softform/materials/material_file.hpp"
#include "softform/mesh/triangle_mesh.hpp"

namespace {

using namespace softform;

void balloon_design(benchmark::State& state, const char* dataset)
{
  const TriangleMesh target = scale_to_diameter(load_dataset(dataset, static_cast<int>(state.range(0))), 0.146);
  BalloonDesign design;
  for (auto _ : state) design = design_balloon(target, load_material("silicone"));
  const BalloonTimes& times = design.times;
  state.counters["share_inflation"] = times.inflation / times.total;
  state.counters["share_assembly"] = times.assembly / times.total;
  state.counters["share_factorization"] = times.factorization / times.total;
  state.counters["share_solve"] = times.solve / times.total;
  state.counters["share_equilibrium"] = times.equilibrium / times.total;
  state.counters["share_collision"] = times.collision / times.total;
  state.counters["share_rest"] = times.rest() / times.total;
  state.counters["shape_steps"] = design.counts.shape_steps;
  state.counters["equilibrium_steps"] = design.counts.equilibrium_steps;
  state.counters["mean_distance_mm"] = 1e3 * shape_distance(design.inflated, target).mean;
  state.counters["max_distance_mm"] = 1e3 * shape_distance(design.inflated, target).max;
}

void once(benchmark::internal::Benchmark* benchmark)
{
  benchmark->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime()->MeasureProcessCPUTime();
}

BENCHMARK_CAPTURE(balloon_design, bumpsphere, "bumpsphere")->Arg(1000)->Arg(3265)->Apply(once);
BENCHMARK_CAPTURE(balloon_design, cube, "cube")->Arg(1200)->Arg(5153)->Apply(once);
BENCHMARK_CAPTURE(balloon_design, bunny, "bunny")->Arg(1200)->Arg(4975)->Apply(once);
BENCHMARK_CAPTURE(balloon_design, armadillo, "armadillo")->Arg(1500)->Arg(6027)->Apply(once);
BENCHMARK_CAPTURE(balloon_design, elephant, "elephant")->Arg(1500)->Arg(3818)->Apply(once);
BENCHMARK_CAPTURE(balloon_design, hand, "hand")->Arg(800)->Arg(2253)->Apply(once);
BENCHMARK_CAPTURE(balloon_design, teddy, "teddy")->Arg(1000)->Arg(3527)->Apply(once);

}  // namespace
