#include "softform/inflatables/symmetric_dirichlet.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace softform {
namespace {

using Eigen::Matrix2d;
using Vec2 = Eigen::Vector2d;
using Vec4 = Eigen::Vector4d;
using Mat4 = Eigen::Matrix4d;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// d det F / d F.
Matrix2d cofactor(const Matrix2d& F)
{
  Matrix2d c;
  c << F(1, 1), -F(1, 0), -F(0, 1), F(0, 0);
  return c;
}

Vec4 vectorized(const Matrix2d& F) { return Eigen::Map<const Vec4>(F.data()); }

/// psi = |F|^2 + |F^-1|^2 = I (1 + 1/J^2) in two dimensions, I = |F|^2, J = det F.
double density(const Matrix2d& F)
{
  const double I = F.squaredNorm(), J = F.determinant();
  return J > 0 ? I * (1 + 1 / (J * J)) : std::numeric_limits<double>::infinity();
}

/// dpsi/dF = 2 (1 + J^-2) F - 2 I J^-3 cof F.
Matrix2d density_gradient(const Matrix2d& F)
{
  const double I = F.squaredNorm(), J = F.determinant();
  return 2 * (1 + 1 / (J * J)) * F - 2 * I / (J * J * J) * cofactor(F);
}

/// d2psi/dF2 (4, 4) for F by columns.
Mat4 density_hessian(const Matrix2d& F)
{
  const double I = F.squaredNorm(), J = F.determinant(), J3 = J * J * J;
  const Vec4 f = vectorized(F), c = vectorized(cofactor(F));
  Mat4 cofactor_gradient = Mat4::Zero();
  cofactor_gradient(0, 3) = cofactor_gradient(3, 0) = 1;
  cofactor_gradient(1, 2) = cofactor_gradient(2, 1) = -1;
  return 2 * (1 + 1 / (J * J)) * Mat4::Identity() - 4 / J3 * (f * c.transpose() + c * f.transpose()) +
         6 * I / (J3 * J) * c * c.transpose() - 2 * I / J3 * cofactor_gradient;
}

Mat4 semi_definite(const Mat4& H)
{
  const Eigen::SelfAdjointEigenSolver<Mat4> eigen(H);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
}

Vec2 point(ConstVec z, int i) { return z.segment<2>(2 * Eigen::Index(i)); }

void add_block(const Matrix2d& block, int i, int j, SparseMatrix& H)
{
  for (int c = 0; c < 2; ++c)
    for (int r = 0; r < 2; ++r) H.coeffRef(2 * i + r, 2 * j + c) += block(r, c);
}

}  // namespace

SymmetricDirichlet::SymmetricDirichlet(const TriangleMesh& mesh, const std::vector<int>& loop, double length_weight,
                                       FlatPositions start)
    : start_(std::move(start)), pattern_(start_.size(), start_.size())
{
  const double area = surface_area(flatten(mesh.vertices), mesh.triangles);
  std::vector<Eigen::Triplet<double>> entries;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    Element element{{mesh.triangles(t, 0), mesh.triangles(t, 1), mesh.triangles(t, 2)}, {}, 0};
    const Vec3 u = mesh.vertices.row(element.vertices[1]) - mesh.vertices.row(element.vertices[0]);
    const Vec3 v = mesh.vertices.row(element.vertices[2]) - mesh.vertices.row(element.vertices[0]);
    // In the triangle's plane: u along the first axis.
    Matrix2d edges;
    edges << u.norm(), u.dot(v) / u.norm(), 0, u.cross(v).norm() / u.norm();
    const Matrix2d inverse = edges.inverse();
    element.gradients << -inverse.colwise().sum(), inverse;
    element.weight = 0.5 * edges.determinant() / area;
    elements_.push_back(element);
    for (const int i : element.vertices)
      for (const int j : element.vertices)
        for (int k = 0; k < 4; ++k) entries.emplace_back(2 * i + k % 2, 2 * j + k / 2, 0);
  }
  pattern_.setFromTriplets(entries.begin(), entries.end());
  for (std::size_t j = 0; j < loop.size(); ++j) {
    const int from = loop[j], to = loop[(j + 1) % loop.size()];
    const double length = (mesh.vertices.row(to) - mesh.vertices.row(from)).norm();
    boundary_.push_back({from, to, length, length_weight / std::sqrt(area) / length});
  }
}

Vec SymmetricDirichlet::initial_point() const { return Eigen::Map<const Vec>(start_.data(), start_.size()); }

Matrix2d SymmetricDirichlet::deformation(const Element& element, ConstVec z) const
{
  Eigen::Matrix<double, 2, 3> q;
  for (int k = 0; k < 3; ++k) q.col(k) = point(z, element.vertices[static_cast<std::size_t>(k)]);
  return q * element.gradients;
}

double SymmetricDirichlet::objective(ConstVec z) const
{
  double f = 0;
  for (const Element& element : elements_) f += element.weight * density(deformation(element, z));
  for (const BoundaryEdge& edge : boundary_) {
    const double change = (point(z, edge.end) - point(z, edge.start)).norm() - edge.length;
    f += edge.weight * change * change;
  }
  return f;
}

void SymmetricDirichlet::objective_gradient(ConstVec z, Vec& g) const
{
  g = Vec::Zero(z.size());
  for (const Element& element : elements_) {
    const Matrix2d P = element.weight * density_gradient(deformation(element, z));
    for (int k = 0; k < 3; ++k)
      g.segment<2>(2 * element.vertices[static_cast<std::size_t>(k)]) += P * element.gradients.row(k).transpose();
  }
  for (const BoundaryEdge& edge : boundary_) {
    const Vec2 d = point(z, edge.end) - point(z, edge.start);
    const Vec2 force = 2 * edge.weight * (d.norm() - edge.length) * d.normalized();
    g.segment<2>(2 * edge.end) += force;
    g.segment<2>(2 * edge.start) -= force;
  }
}

void SymmetricDirichlet::assemble(ConstVec z, Projection projection, SparseMatrix& H) const
{
  H = pattern_;
  for (const Element& element : elements_) {
    Mat4 D = density_hessian(deformation(element, z));
    if (projection == Projection::SemiDefinite) D = semi_definite(D);
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        Matrix2d block = Matrix2d::Zero();
        for (int p = 0; p < 2; ++p)
          for (int q = 0; q < 2; ++q)
            block += element.weight * element.gradients(a, p) * element.gradients(b, q) * D.block<2, 2>(2 * p, 2 * q);
        add_block(block, element.vertices[static_cast<std::size_t>(a)], element.vertices[static_cast<std::size_t>(b)],
                  H);
      }
    }
  }
  for (const BoundaryEdge& edge : boundary_) {
    const Vec2 d = point(z, edge.end) - point(z, edge.start), u = d.normalized();
    double across = 1 - edge.length / d.norm();  // negative where the edge is too short
    if (projection == Projection::SemiDefinite) across = std::max(across, 0.0);
    const Matrix2d block = 2 * edge.weight * (u * u.transpose() + across * (Matrix2d::Identity() - u * u.transpose()));
    add_block(block, edge.start, edge.start, H);
    add_block(block, edge.end, edge.end, H);
    add_block(-block, edge.start, edge.end, H);
    add_block(-block, edge.end, edge.start, H);
  }
}

void SymmetricDirichlet::gauss_newton_hessian(ConstVec z, SparseMatrix& H) const
{
  assemble(z, Projection::SemiDefinite, H);
}

bool SymmetricDirichlet::lagrangian_hessian(ConstVec z, ConstVec, SparseMatrix& H) const
{
  assemble(z, Projection::None, H);
  return true;
}

}  // namespace softform
