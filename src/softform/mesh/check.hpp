#pragma once

#include <optional>
#include <string>
#include <vector>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// What can make a surface unusable as the skin of a balloon.
enum class MeshProblemKind {
  TooFewTriangles,
  NotFinite,
  UnusedVertex,
  DegenerateTriangle,
  DuplicateTriangle,
  NonManifoldEdge,
  InconsistentOrientation,
  OpenEdge,
  NonManifoldVertex,
  SeveralComponents,
  InvertedOrientation,
  SelfIntersection,
};

struct MeshProblem {
  MeshProblemKind kind;
  int count;            ///< how many elements have it
  std::string message;  ///< names the first of them (counted from 0) and the cure
};

/// What a mesh is, and what is wrong with it. Lengths in the mesh's unit.
struct MeshReport {
  int vertices = 0, edges = 0, triangles = 0, components = 0;
  std::optional<int> genus;  ///< of a closed manifold, summed over its components
  Vec3 lower_corner = Vec3::Zero(), upper_corner = Vec3::Zero();
  double volume = 0;                      ///< signed
  double smallest_angle = 0;              ///< [degrees]
  std::optional<int> self_intersections;  ///< pairs; nothing where edges or vertices are no manifold
  std::vector<MeshProblem> problems;      ///< one a kind, in the order of MeshProblemKind
  std::vector<std::string> notes;         ///< unusual, but no obstacle

  bool usable() const { return problems.empty(); }
};

/// Examines a surface. Precondition: indices are within range, as read_mesh() ensures.
MeshReport check_mesh(const TriangleMesh& mesh);

/// Throws InputError with the problems of the mesh, each with its cure, if there are any. `name` is what the user
/// knows the mesh by: its file.
void require_closed_surface(const TriangleMesh& mesh, const std::string& name);

}  // namespace softform
