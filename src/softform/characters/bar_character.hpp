#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "softform/characters/bent_bar.hpp"
#include "softform/characters/material_layout.hpp"
#include "softform/characters/reachability.hpp"

namespace softform {

/// A straight bar of two materials that is posed by hand at its end caps (figures 5.3 and 5.8 left).
struct BarOptions {
  Eigen::Vector3d size{0.08, 0.004, 0.006};  ///< [m]
  std::array<int, 3> cells{42, 6, 3};        ///< six tetrahedra each: 4536
  /// Cells along the bar that belong to a cap.
  int cap_cells = 2;
  double soft_shear_modulus = 2e5;  ///< of a printed rubber [Pa]
  double contrast = 1000;           ///< ratio of the shear moduli
  /// Of both materials; nearer to 0.5, linear tetrahedra would lock.
  double poisson_ratio = 0.4;
  /// Densities of the uniform bar that the optimisation starts from.
  double first_density = 0.5;
  MaterialLayoutOptions layout;
};

/// A body as the tetrahedra of a bar of a uniform mesh, and the pose wanted of it.
class BarCharacter {
 public:
  /// Throws InputError for sizes, cells, moduli and caps that cannot be used.
  BarCharacter(const BarOptions& options, std::vector<Bend> bends);

  const SimplexMesh<3>& mesh() const { return mesh_; }
  const Solid<3>& body() const { return body_; }
  const FixedDofs& caps() const { return caps_; }
  /// The bent bar (3n) at a fraction of its bends: the target at 1, and on the way the path of the caps.
  Vec pose(double fraction) const { return bent_bar(mesh_, bends_, fraction); }
  /// The angle between the directions of the two ends [rad].
  double turn() const;

  /// The equilibria from rest to the pose, at these densities.
  PoseTrace trace(const Vec& densities) const;
  /// Finds the layout from a uniform bar that was traced to the pose.
  MaterialLayout<3> optimize(const Vec& uniform_pose, const LayoutObserver& observer = {}) const;

  /// Writes the bar at positions x with its densities: `stem`.vtu, the tetrahedra, and `stem`.vtp, the outer faces. The
  /// field is "density [1]".
  void write(const std::filesystem::path& stem, const Vec& x, const Vec& densities) const;

 private:
  BarOptions options_;
  std::vector<Bend> bends_;
  SimplexMesh<3> mesh_;
  Solid<3> body_;
  FixedDofs caps_;
};

/// A question mark as a straight bar of 80 mm takes it: a hook and, but for the stem, a bend back.
struct QuestionMark {
  std::string name;
  std::vector<Bend> bends;
};

/// The four targets of figure 5.3: "round", "tall", "square" and "swan". Drawn before any optimisation; their ends turn
/// by 165 to 175 degrees against each other.
std::vector<QuestionMark> question_marks();

}  // namespace softform
