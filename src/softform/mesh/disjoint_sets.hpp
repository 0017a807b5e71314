#pragma once

#include <numeric>
#include <vector>

namespace softform {

/// Sets of the numbers 0 ... n - 1 that are united one by one, each known by one of its members.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parents_(n) { std::iota(parents_.begin(), parents_.end(), 0); }

  int root(int i)
  {
    while (parent(i) != i) i = parent(i) = parent(parent(i));
    return i;
  }
  void unite(int i, int j) { parent(root(i)) = root(j); }

 private:
  int& parent(int i) { return parents_[static_cast<std::size_t>(i)]; }

  std::vector<int> parents_;
};

}  // namespace softform
