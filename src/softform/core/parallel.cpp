#include "softform/core/parallel.hpp"

#include <memory>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

namespace softform {
namespace {

constexpr int smallest_range = 256;

std::unique_ptr<tbb::global_control> thread_limit;

}  // namespace

void parallel_ranges(int count, const std::function<void(int begin, int end)>& body)
{
  tbb::parallel_for(
      tbb::blocked_range<int>(0, count, smallest_range),
      [&body](const tbb::blocked_range<int>& range) { body(range.begin(), range.end()); }, tbb::simple_partitioner());
}

void set_thread_count(int count)
{
  thread_limit.reset();
  thread_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, count);
}

int thread_count()
{
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace softform
