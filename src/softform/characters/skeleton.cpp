#include "softform/characters/skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {
namespace {

using Vec2 = Eigen::Vector2d;
using Motion = Eigen::Transform<double, 2, Eigen::Isometry>;

double distance_to_link(const Vec2& x, const Vec2& a, const Vec2& b)
{
  const Vec2 u = b - a;
  const double t = std::clamp((x - a).dot(u) / u.squaredNorm(), 0.0, 1.0);
  return (x - a - t * u).norm();
}

// The stiffness matrix of -Lap and the lumped areas of linear triangles.
SparseMatrix cotangent_laplacian(const PlanarMesh& mesh, Vec& areas)
{
  std::vector<Eigen::Triplet<double>> entries;
  areas = Vec::Zero(mesh.vertex_count());
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const double doubled = doubled_area(mesh.vertices, mesh.triangles, t);
    for (int k = 0; k < 3; ++k) {
      const int i = mesh.triangles(t, k), j = mesh.triangles(t, (k + 1) % 3), o = mesh.triangles(t, (k + 2) % 3);
      areas[i] += doubled / 6;
      const auto at_o = mesh.vertices.row(o);
      const double w = (mesh.vertices.row(i) - at_o).dot(mesh.vertices.row(j) - at_o) / (2 * doubled);
      entries.insert(entries.end(), {{i, i, w}, {j, j, w}, {i, j, -w}, {j, i, -w}});
    }
  }
  SparseMatrix L(mesh.vertex_count(), mesh.vertex_count());
  L.setFromTriplets(entries.begin(), entries.end());
  return L;
}

// The bend of the first part s in [0, 1] of a bone.
double bent_until(const Bends& bends, double s)
{
  const auto parts = static_cast<double>(bends.size());
  double sum = 0;
  for (std::size_t i = 0; i < bends.size(); ++i)
    sum += bends[i] * std::clamp(s * parts - static_cast<double>(i), 0.0, 1.0);
  return sum;
}

// Motions of all links, bone by bone: each turns against the one before it by its share of the bend.
std::vector<Motion> link_motions(const Skeleton& skeleton, const SkeletonPose& pose)
{
  std::vector<std::vector<Motion>> motions;
  for (const Bone& bone : skeleton.bones) {
    const auto bends = pose.find(bone.name);
    const int links = static_cast<int>(bone.joints.rows()) - 1;
    Motion motion = Motion::Identity();
    if (bone.parent >= 0)
      motion = motions[static_cast<std::size_t>(bone.parent)][static_cast<std::size_t>(bone.parent_link)];
    std::vector<Motion> own;
    for (int k = 0; k < links; ++k) {
      if (bends != pose.end()) {
        // A link points where the bone does in its middle.
        const double turn = bent_until(bends->second, (k + 0.5) / links) - bent_until(bends->second, (k - 0.5) / links);
        const Vec2 joint = bone.joints.row(k).transpose();
        motion = motion * Eigen::Translation2d(joint) * Eigen::Rotation2Dd(turn) * Eigen::Translation2d(-joint);
      }
      own.push_back(motion);
    }
    motions.push_back(std::move(own));
  }
  std::vector<Motion> all;
  for (const auto& own : motions) all.insert(all.end(), own.begin(), own.end());
  return all;
}

void require_known_bones(const Skeleton& skeleton, const SkeletonPose& pose)
{
  for (const auto& [name, bends] : pose) {
    const auto has_name = [&n = name](const Bone& bone) { return bone.name == n; };
    if (std::none_of(skeleton.bones.begin(), skeleton.bones.end(), has_name))
      throw InputError(fmt::format("the pose bends a bone '{}' that is not there: check its name", name));
  }
}

}  // namespace

Eigen::MatrixXd link_weights(const Skeleton& skeleton, const PlanarMesh& mesh)
{
  const int n = mesh.vertex_count();
  Vec nearest = Vec::Constant(n, std::numeric_limits<double>::infinity());
  Eigen::VectorXi link_of = Eigen::VectorXi::Zero(n);
  int link = 0;
  for (const Bone& bone : skeleton.bones)
    for (Eigen::Index k = 0; k + 1 < bone.joints.rows(); ++k, ++link)
      for (int i = 0; i < n; ++i) {
        const double d = distance_to_link(mesh.vertices.row(i).transpose(), bone.joints.row(k).transpose(),
                                          bone.joints.row(k + 1).transpose());
        if (d >= nearest[i]) continue;
        nearest[i] = d;
        link_of[i] = link;
      }

  Vec areas;
  SparseMatrix A = cotangent_laplacian(mesh, areas);
  const double closest = std::sqrt(areas.minCoeff());  // a vertex on a bone is held, but not infinitely hard
  const Vec heat = areas.array() / nearest.array().max(closest).square();
  for (int i = 0; i < n; ++i) A.coeffRef(i, i) += heat[i];
  Eigen::MatrixXd source = Eigen::MatrixXd::Zero(n, link);
  for (int i = 0; i < n; ++i) source(i, link_of[i]) = heat[i];
  const Eigen::SimplicialLDLT<SparseMatrix> factorization(A);
  Eigen::MatrixXd weights = factorization.solve(source).cwiseMax(0);
  const Vec sums = weights.rowwise().sum();
  return sums.cwiseInverse().asDiagonal() * weights;
}

PlanarPositions posed(const Skeleton& skeleton, const PlanarMesh& mesh, const Eigen::MatrixXd& weights,
                      const SkeletonPose& pose)
{
  require_known_bones(skeleton, pose);
  const std::vector<Motion> motions = link_motions(skeleton, pose);
  PlanarPositions result = PlanarPositions::Zero(mesh.vertex_count(), 2);
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    const Vec2 rest = mesh.vertices.row(i).transpose();
    for (std::size_t k = 0; k < motions.size(); ++k)
      result.row(i) += weights(i, static_cast<Eigen::Index>(k)) * (motions[k] * rest).transpose();
  }
  return result;
}

}  // namespace softform
