#include "softform/inflatables/seam_lengths.hpp"

namespace softform {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec8 = Eigen::Matrix<double, 8, 1>;
using Mat8 = Eigen::Matrix<double, 8, 8>;

Vec2 edge_vector(ConstVec flat, int start, int end)
{
  return flat.segment<2>(2 * Eigen::Index(end)) - flat.segment<2>(2 * Eigen::Index(start));
}

// r = l_0 - l_k in the eight coordinates of the edges' ends, with what its Hessian adds.
struct LengthDifference {
  double value;
  Vec8 gradient;
  Mat8 hessian;
};

LengthDifference length_difference(const Vec2& first, const Vec2& second)
{
  LengthDifference difference;
  const double l0 = first.norm(), lk = second.norm();
  const Vec2 t0 = first / l0, tk = second / lk;
  difference.value = l0 - lk;
  difference.gradient << -t0, t0, tk, -tk;
  const Eigen::Matrix2d across0 = (Eigen::Matrix2d::Identity() - t0 * t0.transpose()) / l0,
                        acrossk = (Eigen::Matrix2d::Identity() - tk * tk.transpose()) / lk;
  Mat8& H = difference.hessian;
  H.setZero();
  H.block<4, 4>(0, 0) << across0, -across0, -across0, across0;
  H.block<4, 4>(4, 4) << -acrossk, acrossk, acrossk, -acrossk;
  return difference;
}

}  // namespace

SeamLengths::SeamLengths(const PanelLayout& layout, double unit_length) : scale_(1 / (unit_length * unit_length))
{
  for (const Seam& seam : layout.seams)
    for (std::size_t k = 1; k < seam.sides.size(); ++k)
      for (std::size_t i = 0; i + 1 < seam.sides[0].vertices.size(); ++i)
        pairs_.push_back({seam.sides[0].vertices[i], seam.sides[0].vertices[i + 1], seam.sides[k].vertices[i],
                          seam.sides[k].vertices[i + 1]});
}

double SeamLengths::value(ConstVec flat) const
{
  double sum = 0;
  for (const Pair& p : pairs_) {
    const double r = edge_vector(flat, p[0], p[1]).norm() - edge_vector(flat, p[2], p[3]).norm();
    sum += scale_ * r * r;
  }
  return sum;
}

void SeamLengths::gradient(ConstVec flat, Vec& g) const
{
  g.setZero(flat.size());
  for (const Pair& p : pairs_) {
    const LengthDifference r = length_difference(edge_vector(flat, p[0], p[1]), edge_vector(flat, p[2], p[3]));
    for (int k = 0; k < 4; ++k)
      g.segment<2>(2 * Eigen::Index(p[std::size_t(k)])) += 2 * scale_ * r.value * r.gradient.segment<2>(2 * k);
  }
}

void SeamLengths::assemble(ConstVec flat, bool is_exact, SparseMatrix& H) const
{
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(64 * pairs_.size());
  for (const Pair& p : pairs_) {
    const LengthDifference r = length_difference(edge_vector(flat, p[0], p[1]), edge_vector(flat, p[2], p[3]));
    Mat8 block = r.gradient * r.gradient.transpose();
    if (is_exact) block += r.value * r.hessian;
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 8; ++j)
        entries.emplace_back(2 * p[std::size_t(i / 2)] + i % 2, 2 * p[std::size_t(j / 2)] + j % 2,
                             2 * scale_ * block(i, j));
  }
  H.resize(flat.size(), flat.size());
  H.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace softform
