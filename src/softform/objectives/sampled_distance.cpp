#include "softform/objectives/sampled_distance.hpp"

#include <map>
#include <utility>

#include "softform/core/parallel.hpp"

namespace softform {
namespace {

// Points of a surface as means of nodes, and what each weighs.
class Samples {
 public:
  void add(std::vector<int> nodes, double weight)
  {
    const auto [place, is_new] = numbers_.try_emplace(std::move(nodes), static_cast<int>(weights_.size()));
    if (is_new) weights_.push_back(0);
    weights_[std::size_t(place->second)] += weight;
  }
  Vec weights() const { return Eigen::Map<const Vec>(weights_.data(), Eigen::Index(weights_.size())); }
  SparseMatrix interpolation(int node_count) const;

 private:
  std::map<std::vector<int>, int> numbers_;
  std::vector<double> weights_;
};

SparseMatrix Samples::interpolation(int node_count) const
{
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [nodes, number] : numbers_)
    for (const int node : nodes)
      for (int k = 0; k < 3; ++k) entries.emplace_back(3 * number + k, 3 * node + k, 1.0 / double(nodes.size()));
  SparseMatrix P(3 * Eigen::Index(weights_.size()), 3 * node_count);
  P.setFromTriplets(entries.begin(), entries.end());
  return P;
}

// Exact for polynomials of the third degree (Zienkiewicz, The Finite Element Method): corners, middles, centroid.
constexpr double corner_weight = 1.0 / 20, middle_weight = 2.0 / 15, centroid_weight = 9.0 / 20;

}  // namespace

SampledDistance::SampledDistance(const Triangles& triangles, int node_count, ConstVec areas,
                                 std::shared_ptr<const ImlsField> target, double unit_length)
    : target_(std::move(target))
{
  Samples samples;
  for (int t = 0; t < triangles.rows(); ++t) {
    const int a = triangles(t, 0), b = triangles(t, 1), c = triangles(t, 2);
    for (const int corner : {a, b, c}) samples.add({corner}, corner_weight * areas[t]);
    for (const auto& [i, j] : {std::minmax(a, b), std::minmax(b, c), std::minmax(c, a)})
      samples.add({i, j}, middle_weight * areas[t]);
    samples.add({a, b, c}, centroid_weight * areas[t]);
  }
  interpolation_ = samples.interpolation(node_count);
  weights_ = samples.weights() * (node_count / areas.sum() / (unit_length * unit_length));
}

std::vector<ImlsField::Value> SampledDistance::evaluate(ConstVec x, ImlsField::Derivatives derivatives) const
{
  const Vec points = interpolation_ * x;
  std::vector<ImlsField::Value> values(static_cast<std::size_t>(sample_count()));
  parallel_for(sample_count(),
               [&](int s) { values[std::size_t(s)] = target_->evaluate(points.segment<3>(3 * s), derivatives); });
  return values;
}

double SampledDistance::value(ConstVec x) const
{
  const auto samples = evaluate(x, ImlsField::Derivatives::First);
  double sum = 0;
  for (int s = 0; s < sample_count(); ++s)
    sum += weights_[s] * samples[std::size_t(s)].distance * samples[std::size_t(s)].distance;
  return sum;
}

void SampledDistance::gradient(ConstVec x, Vec& g) const
{
  const auto samples = evaluate(x, ImlsField::Derivatives::First);
  Vec by_sample(3 * Eigen::Index(sample_count()));
  for (int s = 0; s < sample_count(); ++s) {
    const ImlsField::Value& sample = samples[std::size_t(s)];
    by_sample.segment<3>(3 * s) = 2 * weights_[s] * sample.distance * sample.gradient;
  }
  g = interpolation_.transpose() * by_sample;
}

// P^t M P with blocks M_s = 2 w (g g^t + d d'') on the diagonal, the second part for the exact Hessian.
void SampledDistance::assemble(const std::vector<ImlsField::Value>& samples, bool is_exact, SparseMatrix& H) const
{
  SparseMatrix M(interpolation_.rows(), interpolation_.rows());
  M.reserve(Eigen::VectorXi::Constant(M.cols(), 3));
  for (int s = 0; s < sample_count(); ++s) {
    const ImlsField::Value& sample = samples[std::size_t(s)];
    Eigen::Matrix3d block = sample.gradient * sample.gradient.transpose();
    if (is_exact) block += sample.distance * sample.hessian;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) M.insert(3 * s + i, 3 * s + j) = 2 * weights_[s] * block(i, j);
  }
  M.makeCompressed();
  H = interpolation_.transpose() * M * interpolation_;
}

void SampledDistance::gauss_newton_hessian(ConstVec x, SparseMatrix& H) const
{
  assemble(evaluate(x, ImlsField::Derivatives::First), false, H);
}

bool SampledDistance::hessian(ConstVec x, SparseMatrix& H) const
{
  assemble(evaluate(x, ImlsField::Derivatives::Second), true, H);
  return true;
}

}  // namespace softform
