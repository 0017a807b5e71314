#pragma once

#include <functional>

namespace softform {

/// Calls body(begin, end) on consecutive ranges that make up [0, count), on every core; serial where count is small.
/// Built on oneTBB rather than OpenMP, whose threads spin while they wait and cost four times the work as soon as
/// another program wants a core.
void parallel_ranges(int count, const std::function<void(int begin, int end)>& body);

/// Calls body(i) for i in [0, count), on every core.
template <class Body>
void parallel_for(int count, const Body& body)
{
  parallel_ranges(count, [&body](int begin, int end) {
    for (int i = begin; i < end; ++i) body(i);
  });
}

/// How many threads parallel loops use from now on. Results do not depend on it.
void set_thread_count(int count);
int thread_count();

}  // namespace softform
