#pragma once

#include <vector>

#include "softform/core/types.hpp"
#include "softform/fem/block_pattern.hpp"

namespace softform {

/// The volume V(x) enclosed by a closed surface [m^3] and its derivatives. A uniform inner pressure p has the potential
/// -p V: its nodal forces p dV/dx are those of (4.5), a third of the area vectors around each vertex. An open surface
/// whose rim lies in a plane through the origin encloses its volume with that plane; derivatives are then right for the
/// vertices inside, and the rim has to be held.
class EnclosedVolume {
 public:
  EnclosedVolume(const Triangles& triangles, int vertex_count);
  /// The volume inside the triangles where `is_skin` (m): the others, walls inside it, only have their place in the
  /// pattern.
  EnclosedVolume(Triangles triangles, int vertex_count, std::vector<char> is_skin);

  double value(ConstVec x) const;
  /// dV/dx (3n) [m^2].
  void gradient(ConstVec x, Vec& g) const;
  /// Adds scale d2V/dx2 (3n, 3n) [m], indefinite, to H, which has the pattern of the membrane with these triangles. It
  /// is linear in x: at lambda in place of x it is the third derivative contracted with lambda.
  void add_hessian(ConstVec x, double scale, SparseMatrix& H) const;
  const SparseMatrix& pattern() const { return pattern_.zero(); }

 private:
  Triangles triangles_;
  int vertex_count_;
  std::vector<char> is_skin_;
  BlockPattern pattern_;
};

}  // namespace softform
