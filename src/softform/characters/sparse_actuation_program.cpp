#include "softform/characters/sparse_actuation_program.hpp"

#include <algorithm>
#include <cmath>

namespace softform {
namespace {

constexpr double mm = 1e-3;  // [m]

// Appends the columns of `block`, whose first row becomes row `first_row`. Every column is written once, so that the
// matrix is assembled by concatenation; its pattern is fixed where those of the blocks are.
class ColumnWriter {
 public:
  ColumnWriter(SparseMatrix& matrix, Eigen::Index rows, Eigen::Index columns) : matrix_(matrix)
  {
    matrix_.resize(rows, columns);
  }
  void add(const SparseMatrix& block, double scale, Eigen::Index first_row)
  {
    for (Eigen::Index c = 0; c < block.outerSize(); ++c) {
      matrix_.startVec(next_);
      for (SparseMatrix::InnerIterator entry(block, c); entry; ++entry)
        matrix_.insertBack(first_row + entry.row(), next_) = scale * entry.value();
      ++next_;
    }
  }
  void add(double value, Eigen::Index row)
  {
    matrix_.startVec(next_);
    matrix_.insertBack(row, next_++) = value;
  }
  ~ColumnWriter() { matrix_.finalize(); }

 private:
  SparseMatrix& matrix_;
  Eigen::Index next_ = 0;
};

}  // namespace

SparseActuationProgram::SparseActuationProgram(const PlanarSolid& body, std::vector<Vec> targets,
                                               std::vector<int> candidates, SparseRegularizer regularizer,
                                               FixedDofs held)
    : body_(body),
      targets_(std::move(targets)),
      candidates_(std::move(candidates)),
      regularizer_(regularizer),
      held_(std::move(held)),
      densities_(Vec::Zero(body.element_count()))
{
  body_.hessian(body_.rest_positions(), densities_, Projection::None, K_);
  hold_stiffness_ = K_.diagonal().mean();
}

Vec SparseActuationProgram::positions(ConstVec z, int pose) const
{
  return mm * z.segment(Eigen::Index(pose) * state_size(), state_size());
}

Vec SparseActuationProgram::forces(ConstVec z, int pose) const { return z.segment(force_start(pose), force_size()); }

Vec SparseActuationProgram::force_norms(ConstVec z) const
{
  Vec squares = Vec::Zero(static_cast<Eigen::Index>(candidates_.size()));
  for (int pose = 0; pose < pose_count(); ++pose)
    for (Eigen::Index j = 0; j < squares.size(); ++j)
      squares[j] += z.segment<2>(force_start(pose) + 2 * j).squaredNorm();
  return squares.cwiseSqrt();
}

Vec SparseActuationProgram::initial_point() const { return start_.size() > 0 ? start_ : point_from(targets_); }

Vec SparseActuationProgram::point_from(const std::vector<Vec>& positions) const
{
  Vec z(variable_count()), g;
  for (int pose = 0; pose < pose_count(); ++pose) {
    const Vec& x = positions[static_cast<std::size_t>(pose)];
    z.segment(Eigen::Index(pose) * state_size(), state_size()) = x / mm;
    body_.gradient(x, densities_, g);
    for (std::size_t j = 0; j < candidates_.size(); ++j)
      z.segment<2>(force_start(pose) + 2 * static_cast<Eigen::Index>(j)) = g.segment<2>(2 * candidates_[j]);
  }
  return z;
}

double SparseActuationProgram::squared_error(ConstVec z) const
{
  double sum = 0;
  for (int pose = 0; pose < pose_count(); ++pose)
    sum += (positions(z, pose) - targets_[static_cast<std::size_t>(pose)]).squaredNorm() / (2 * mm * mm);
  return sum;
}

double SparseActuationProgram::objective(ConstVec z) const
{
  const auto& [weight, alpha, smoothing] = regularizer_;
  return squared_error(z) + weight * (force_norms(z).array().square() + smoothing * smoothing).pow(1 / alpha).sum();
}

// 2 k/alpha (|q_j|^2 + eps^2)^(1/alpha - 1): R' = w q, and w/2 |q|^2 touches R from above, up to a constant.
Vec SparseActuationProgram::majorizer_weights(ConstVec z) const
{
  const auto& [weight, alpha, smoothing] = regularizer_;
  if (weight == 0) return Vec::Zero(static_cast<Eigen::Index>(candidates_.size()));
  return 2 * weight / alpha * (force_norms(z).array().square() + smoothing * smoothing).pow(1 / alpha - 1);
}

void SparseActuationProgram::objective_gradient(ConstVec z, Vec& g) const
{
  g.resize(variable_count());
  const Vec weights = majorizer_weights(z);
  for (int pose = 0; pose < pose_count(); ++pose) {
    g.segment(Eigen::Index(pose) * state_size(), state_size()) =
        (positions(z, pose) - targets_[static_cast<std::size_t>(pose)]) / mm;
    for (Eigen::Index j = 0; j < weights.size(); ++j)
      g.segment<2>(force_start(pose) + 2 * j) = weights[j] * z.segment<2>(force_start(pose) + 2 * j);
  }
}

void SparseActuationProgram::gauss_newton_hessian(ConstVec z, SparseMatrix& H) const
{
  const Vec weights = majorizer_weights(z);
  ColumnWriter writer(H, variable_count(), variable_count());
  for (Eigen::Index i = 0; i < constraint_count(); ++i) writer.add(1, i);
  for (int pose = 0; pose < pose_count(); ++pose)
    for (int k = 0; k < force_size(); ++k) writer.add(weights[k / 2], force_start(pose) + k);
}

void SparseActuationProgram::constraints(ConstVec z, Vec& c) const
{
  c.resize(constraint_count());
  Vec g;
  for (int pose = 0; pose < pose_count(); ++pose) {
    const Vec x = positions(z, pose);
    body_.gradient(x, densities_, g);
    for (std::size_t j = 0; j < candidates_.size(); ++j)
      g.segment<2>(2 * candidates_[j]) -= z.segment<2>(force_start(pose) + 2 * static_cast<Eigen::Index>(j));
    for (Eigen::Index k = 0; k < g.size(); ++k)
      if (is_held(k)) g[k] = hold_stiffness_ * (x[k] - body_.rest_positions()[k]);
    c.segment(Eigen::Index(pose) * state_size(), state_size()) = g;
  }
}

void SparseActuationProgram::constraint_jacobian(ConstVec z, SparseMatrix& J) const
{
  ColumnWriter writer(J, constraint_count(), variable_count());
  for (int pose = 0; pose < pose_count(); ++pose) {
    body_.hessian(positions(z, pose), densities_, Projection::None, K_);
    if (held_.free.size() > 0)
      for (int column = 0; column < K_.outerSize(); ++column)
        for (SparseMatrix::InnerIterator entry(K_, column); entry; ++entry)
          if (is_held(entry.row())) entry.valueRef() = entry.row() == column ? hold_stiffness_ : 0;
    writer.add(K_, mm, Eigen::Index(pose) * state_size());
  }
  for (int pose = 0; pose < pose_count(); ++pose)
    for (const int candidate : candidates_)
      for (int k = 0; k < 2; ++k) writer.add(-1, Eigen::Index(pose) * state_size() + 2 * candidate + k);
}

bool SparseActuationProgram::lagrangian_hessian(ConstVec z, ConstVec lambda, SparseMatrix& H) const
{
  const Vec weights = majorizer_weights(z);
  ColumnWriter writer(H, variable_count(), variable_count());
  for (int pose = 0; pose < pose_count(); ++pose) {
    const Eigen::Index start = Eigen::Index(pose) * state_size();
    Vec rho_rho, forces = lambda.segment(start, state_size());
    held_.project(forces);
    body_.force_hessian(positions(z, pose), densities_, forces, K_, mixed_, rho_rho);
    K_ *= mm * mm;
    K_.diagonal().array() += 1;
    writer.add(K_, 1, start);
  }
  for (int pose = 0; pose < pose_count(); ++pose)
    for (int k = 0; k < force_size(); ++k) writer.add(weights[k / 2], force_start(pose) + k);
  return true;
}

}  // namespace softform
