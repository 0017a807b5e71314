#include "softform/characters/posed_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/equilibrium/loaded_solid.hpp"
#include "softform/linalg/sparse_factorization.hpp"

namespace softform {
namespace {

template <int dim>
using Matrix = Eigen::Matrix<double, dim, dim>;

// A turn as an angle in the plane and as axis times angle in space.
template <int dim>
using Turn = Eigen::Matrix<double, dim == 2 ? 1 : 3, 1>;

Turn<2> turn_of(const Matrix<2>& R) { return Turn<2>(std::atan2(R(1, 0), R(0, 0))); }
Turn<3> turn_of(const Matrix<3>& R)
{
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

Matrix<2> rotation(const Turn<2>& turn) { return Eigen::Rotation2Dd(turn[0]).toRotationMatrix(); }
Matrix<3> rotation(const Turn<3>& turn)
{
  const double angle = turn.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Matrix<3>(Matrix<3>::Identity());
}

// The same rotation, by the turn that is closest to another one: full circles added.
template <int dim>
Turn<dim> nearest_turn(const Turn<dim>& turn, const Turn<dim>& other)
{
  const double angle = turn.norm();
  if (!(angle > 0) && other.norm() < std::numbers::pi) return turn;
  const Turn<dim> axis = angle > 0 ? Turn<dim>(turn / angle) : Turn<dim>(other.normalized());
  const double circles = std::round((axis.dot(other) - angle) / (2 * std::numbers::pi));
  return turn + 2 * std::numbers::pi * circles * axis;
}

template <int dim>
struct Element {
  Eigen::Matrix<double, dim + 1, dim> gradients;  // of the corners' shape functions, by rows [1/m]
  double volume = 0;
  Turn<dim> turn;
  Matrix<dim> stretch;
};

template <int dim>
std::vector<Element<dim>> decomposed(const SimplexMesh<dim>& rest, const Vec& target)
{
  std::vector<Element<dim>> elements;
  for (const auto& corners : rest.elements.rowwise()) {
    const auto edges = [&](const Vec& x) {
      Matrix<dim> D;
      for (int k = 0; k < dim; ++k)
        D.col(k) = x.template segment<dim>(dim * corners[k + 1]) - x.template segment<dim>(dim * corners[0]);
      return D;
    };
    Element<dim> element;
    const Matrix<dim> D = edges(rest.positions), inverse = D.inverse();
    element.volume = D.determinant();
    element.gradients.template bottomRows<dim>() = inverse;
    element.gradients.row(0) = -inverse.colwise().sum();
    const Eigen::JacobiSVD<Matrix<dim>> svd(edges(target) * inverse, Eigen::ComputeFullU | Eigen::ComputeFullV);
    element.turn = turn_of(Matrix<dim>(svd.matrixU() * svd.matrixV().transpose()));
    element.stretch = svd.matrixV() * svd.singularValues().asDiagonal() * svd.matrixV().transpose();
    elements.push_back(element);
  }
  return elements;
}

// From the element that turns least outwards, neighbours after each other.
template <int dim>
void unwind(const SimplexMesh<dim>& rest, std::vector<Element<dim>>& elements)
{
  const auto neighbours = element_neighbours<dim>(rest.elements);
  std::vector<bool> is_known(elements.size(), false);
  const auto by_turn = [](const auto& a, const auto& b) { return a.turn.norm() < b.turn.norm(); };
  std::vector<std::size_t> queue;
  const auto visit = [&](std::size_t e) {
    is_known[e] = true;
    queue.push_back(e);
  };
  visit(static_cast<std::size_t>(std::min_element(elements.begin(), elements.end(), by_turn) - elements.begin()));
  for (std::size_t next = 0; queue.size() < elements.size(); ++next) {
    if (next == queue.size()) visit(std::size_t(std::find(is_known.begin(), is_known.end(), false) - is_known.begin()));
    for (const int other : neighbours[queue[next]]) {
      const auto e = static_cast<std::size_t>(other);
      if (is_known[e]) continue;
      elements[e].turn = nearest_turn<dim>(elements[e].turn, elements[queue[next]].turn);
      visit(e);
    }
  }
}

// The Laplacian of linear elements.
template <int dim>
SparseMatrix laplacian(const SimplexMesh<dim>& rest, const std::vector<Element<dim>>& elements)
{
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const auto block = (elements[e].volume * elements[e].gradients * elements[e].gradients.transpose()).eval();
    for (int i = 0; i <= dim; ++i)
      for (int j = 0; j <= dim; ++j)
        entries.emplace_back(rest.elements(Eigen::Index(e), i), rest.elements(Eigen::Index(e), j), block(i, j));
  }
  SparseMatrix L(rest.vertex_count(), rest.vertex_count());
  L.setFromTriplets(entries.begin(), entries.end());
  return L;
}

template <int dim>
class RigidWay {
 public:
  RigidWay(const SimplexMesh<dim>& rest, const Vec& target) : rest_(rest), elements_(decomposed<dim>(rest, target))
  {
    unwind<dim>(rest_, elements_);
    SparseMatrix L = laplacian<dim>(rest_, elements_);
    FixedDofs first{Vec::Ones(rest_.vertex_count())};  // held where it is, against the null space
    first.free[0] = 0;
    first.project(L, 1);
    laplacian_.cholesky(L);
    first_mean_ = mean(rest.positions);
    last_mean_ = mean(target);
  }

  Vec operator()(double t)
  {
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(rest_.vertex_count(), dim);
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      const Element<dim>& element = elements_[e];
      const Matrix<dim> F =
          rotation(Turn<dim>(t * element.turn)) * ((1 - t) * Matrix<dim>::Identity() + t * element.stretch);
      for (int k = 0; k <= dim; ++k)
        b.row(rest_.elements(Eigen::Index(e), k)) += element.volume * element.gradients.row(k) * F.transpose();
    }
    b.row(0).setZero();
    Vec x(rest_.positions.size());
    for (int a = 0; a < dim; ++a) {
      const Vec column = laplacian_.solve(b.col(a));
      for (Eigen::Index i = 0; i < column.size(); ++i) x[dim * i + a] = column[i];
    }
    const Eigen::Matrix<double, dim, 1> shift = (1 - t) * first_mean_ + t * last_mean_ - mean(x);
    return x + shift.replicate(rest_.vertex_count(), 1);
  }

 private:
  static Eigen::Matrix<double, dim, 1> mean(const Vec& x)
  {
    return Eigen::Map<const Eigen::Matrix<double, dim, Eigen::Dynamic>>(x.data(), dim, x.size() / dim).rowwise().mean();
  }

  SimplexMesh<dim> rest_;
  std::vector<Element<dim>> elements_;
  SparseFactorization laplacian_;
  Eigen::Matrix<double, dim, 1> first_mean_, last_mean_;
};

}  // namespace

template <int dim>
PoseWay rigid_way(const SimplexMesh<dim>& rest, const std::vector<Vec>& targets)
{
  std::vector<std::shared_ptr<RigidWay<dim>>> ways;
  for (const Vec& target : targets) ways.push_back(std::make_shared<RigidWay<dim>>(rest, target));
  return [ways](std::size_t pose, double fraction) { return (*ways[pose])(fraction); };
}

Vec filled_target(const SimplexMesh<3>& rest, const Vec& surface)
{
  FixedDofs held{Vec::Ones(rest.positions.size())};
  for (const int i : boundary_vertices<3>(rest.elements)) held.free.segment<3>(3 * i).setZero();
  // On the boundary as given; inside first where the harmonic displacement of the boundary puts it.
  const SparseMatrix L = laplacian<3>(rest, decomposed<3>(rest, rest.positions));
  SparseFactorization factorization;
  Vec x = held.free.cwiseProduct(rest.positions) + (1 - held.free.array()).matrix().cwiseProduct(surface);
  SparseMatrix inner = L;
  FixedDofs scalar{Vec(rest.vertex_count())};
  for (Eigen::Index i = 0; i < scalar.free.size(); ++i) scalar.free[i] = held.free[3 * i];
  scalar.project(inner, 1);
  factorization.cholesky(inner);
  for (int a = 0; a < 3; ++a) {
    Vec moved(rest.vertex_count());
    for (Eigen::Index i = 0; i < moved.size(); ++i) moved[i] = x[3 * i + a] - rest.positions[3 * i + a];
    Vec b = -(L * moved);
    scalar.project(b);
    const Vec change = factorization.solve(b);
    for (Eigen::Index i = 0; i < moved.size(); ++i) x[3 * i + a] += change[i];
  }
  const Solid<3> rubber(rest.elements, rest.positions, Mixture(neo_hookean_solid(1, bulk_modulus(1, 0.3))));
  const LoadedSolid<3> potential(rubber, Vec::Zero(rest.element_count()));
  return solve_equilibrium(potential, x, factorization, {}, held).x;
}

template <int dim>
void require_upright(const PosedMesh<dim>& body, const std::string& name)
{
  for (std::size_t i = 0; i < body.targets.size(); ++i) {
    const Vec& x = body.targets[i];
    if (x.size() != body.rest.positions.size())
      throw InputError(fmt::format("{}: pose '{}' has {} vertices, the body {}: a pose is the body's own mesh, moved",
                                   name, body.names[i], x.size() / dim, body.rest.vertex_count()));
    for (int e = 0; e < body.rest.element_count(); ++e) {
      Matrix<dim> D;
      for (int k = 0; k < dim; ++k)
        D.col(k) = x.template segment<dim>(dim * body.rest.elements(e, k + 1)) -
                   x.template segment<dim>(dim * body.rest.elements(e, 0));
      if (!(D.determinant() > 0))
        throw InputError(fmt::format("{}: pose '{}' turns {} {} over: bend less there, or over a greater length", name,
                                     body.names[i], dim == 2 ? "triangle" : "tetrahedron", e));
    }
  }
}

template PoseWay rigid_way<2>(const SimplexMesh<2>&, const std::vector<Vec>&);
template PoseWay rigid_way<3>(const SimplexMesh<3>&, const std::vector<Vec>&);
template void require_upright<2>(const PosedMesh<2>&, const std::string&);
template void require_upright<3>(const PosedMesh<3>&, const std::string&);

}  // namespace softform
