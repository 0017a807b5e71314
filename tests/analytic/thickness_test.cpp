// Uneven thickness: noise of known correlation, and rubber that collects in troughs.

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "softform/balloons/thickness_levelling.hpp"
#include "softform/balloons/thickness_noise.hpp"
#include "softform/mesh/laplacian.hpp"
#include "softform/mesh/shapes.hpp"
#include "support/expect_input_error.hpp"

namespace softform {
namespace {

// On the unit sphere the field's covariance is a series of Legendre polynomials in the cosine of the angle,
//     C = sum_l (2 l + 1)/(4 pi) P_l(cos) / (kappa^2 + l (l + 1))^2.
double sphere_covariance(double kappa, double cosine)
{
  double sum = 0, previous = 0, P = 1;
  for (int l = 0; l < 400; ++l) {
    sum += (2 * l + 1) / (4 * M_PI) * P / std::pow(kappa * kappa + l * (l + 1), 2);
    const double next = ((2 * l + 1) * cosine * P - l * previous) / (l + 1);
    previous = P;
    P = next;
  }
  return sum;
}

TEST(SurfaceNoise, CorrelationOnASphereIsTheSeries)
{
  const TriangleMesh mesh = sphere(1, 1200);
  const double correlation_length = 0.9;
  const SurfaceNoise noise(mesh, correlation_length);
  const auto n = mesh.vertices.rows();
  constexpr int samples = 800, bins = 8;
  Eigen::MatrixXd fields(n, samples);
  for (int s = 0; s < samples; ++s) fields.col(s) = noise.on_vertices(static_cast<unsigned>(s));
  const Eigen::MatrixXd correlation = fields * fields.transpose() / samples;

  // Averaged over all pairs at a distance; the standard error of each bin is about 0.01.
  const double kappa = std::sqrt(8.0) / correlation_length, variance = sphere_covariance(kappa, 1);
  constexpr int entries = 1000;
  std::vector<double> series;
  for (int k = 0; k <= entries; ++k)
    series.push_back(sphere_covariance(kappa, std::cos(2 * correlation_length * k / entries)) / variance);
  std::array<double, bins> measured{}, expected{}, count{};
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const double angle = std::acos(mesh.vertices.row(i).dot(mesh.vertices.row(j)));
      const double place = angle / (2 * correlation_length);
      if (place >= 1) continue;
      const auto bin = static_cast<std::size_t>(bins * place);
      measured[bin] += correlation(i, j);
      expected[bin] += series[static_cast<std::size_t>(entries * place)];
      count[bin] += 1;
    }
  }
  for (std::size_t bin = 0; bin < bins; ++bin)
    EXPECT_NEAR(measured[bin] / count[bin], expected[bin] / count[bin], 0.03) << "bin " << bin;
  // What the name promises, on a surface that is nearly flat over that length.
  const double short_kappa = std::sqrt(8.0) / 0.3;
  EXPECT_NEAR(sphere_covariance(short_kappa, std::cos(0.3)) / sphere_covariance(short_kappa, 1), 0.14, 0.005);
}

TEST(SurfaceNoise, VarianceIsOneEverywhere)
{
  const TriangleMesh mesh = bumpsphere(1, 1000);
  const SurfaceNoise noise(mesh, 0.3);
  constexpr int samples = 400;
  Vec on_vertices = Vec::Zero(mesh.vertex_count()), on_triangles = Vec::Zero(mesh.triangle_count());
  for (unsigned s = 0; s < samples; ++s) {
    on_vertices += noise.on_vertices(s).cwiseAbs2() / samples;
    on_triangles += noise.on_triangles(s).cwiseAbs2() / samples;
  }
  // Five standard errors of the variance of 400 normal numbers; a fifth of one of their mean.
  const double standard_error = std::sqrt(2.0 / samples);
  for (const Vec& variances : {on_vertices, on_triangles}) {
    EXPECT_LT((variances.array() - 1).abs().maxCoeff(), 5 * standard_error);
    EXPECT_NEAR(variances.mean(), 1, 0.25 * standard_error);
  }
}

TEST(SurfaceNoise, SeedDecides)
{
  const TriangleMesh mesh = sphere(1, 100);
  const SurfaceNoise noise(mesh, 0.5);
  EXPECT_EQ(noise.on_vertices(3), noise.on_vertices(3));
  EXPECT_GT((noise.on_vertices(3) - noise.on_vertices(4)).cwiseAbs().maxCoeff(), 0.1);
  for (const double bad : {0.0, -1.0, std::nan("")})
    test::expect_input_error([&] { SurfaceNoise(mesh, bad); }, {"correlation length"});
}

TEST(VariedThickness, HasMeanAndVariation)
{
  const Vec h = varied_thickness(independent_noise(200'000, 5), 3e-4, 0.2);
  EXPECT_GT(h.minCoeff(), 0);
  EXPECT_NEAR(h.mean(), 3e-4, 3e-4 * 0.002);
  EXPECT_NEAR(std::sqrt((h.array() - h.mean()).square().mean()) / h.mean(), 0.2, 0.002);
  EXPECT_EQ(varied_thickness(Vec::Ones(2), 3e-4, 0), Vec::Constant(2, 3e-4));
  test::expect_input_error([] { varied_thickness(Vec::Ones(2), 0, 0.1); }, {"thickness"});
  test::expect_input_error([] { varied_thickness(Vec::Ones(2), 3e-4, -0.1); }, {"variation"});
}

// A sphere with a ripple, r = 1 + e P_l(z): 2 H = 2 + e ((l (l + 1) - 2) P_l to first order in e, and the coat changes
// by -k2 l^4 (k2 - 2) e P_l / (1 + k2^2 l^4), k2 = l (l + 1).
double levelling_error(int vertices)
{
  constexpr double e = 1e-3, length = 0.3;
  const auto legendre = [](double z) { return 0.5 * (5 * z * z * z - 3 * z); };
  TriangleMesh mesh = sphere(1, vertices);
  Vec expected(mesh.vertices.rows());
  for (Eigen::Index i = 0; i < mesh.vertices.rows(); ++i) {
    constexpr double k2 = 3 * 4;
    const double P = legendre(mesh.vertices(i, 2)), l4 = std::pow(length, 4);
    expected[i] = -l4 * k2 * (k2 - 2) * e * P / (1 + l4 * k2 * k2);
    mesh.vertices.row(i) *= 1 + e * P;
  }
  const Vec film = levelled_film(mesh, length) - levelled_film(sphere(1, vertices), length);
  return (film - expected).norm() / expected.norm();
}

TEST(LevelledFilm, RippledSphere)
{
  const double coarse = levelling_error(1000), fine = levelling_error(4000);
  EXPECT_LT(fine, 0.02);
  EXPECT_LT(fine, 0.5 * coarse);
}

TEST(LevelledFilm, CollectsInTroughsAndKeepsTheRubber)
{
  const TriangleMesh mould = bumpsphere(1, 2000);
  const Vec film = levelled_film(mould, 0.1);
  const Vec areas = vertex_areas(flatten(mould.vertices), mould.triangles);
  EXPECT_LT(std::abs(areas.dot(film)), 1e-10 * areas.dot(film.cwiseAbs()));
  Eigen::Index top = 0, thickest = 0;
  const Vec radii = mould.vertices.rowwise().norm();
  radii.maxCoeff(&top);
  film.maxCoeff(&thickest);
  EXPECT_LT(film[top], 0);                                                               // thin on the bumps
  EXPECT_LT(radii[thickest], radii.minCoeff() + 0.5 * (radii[top] - radii.minCoeff()));  // thick between them

  const Vec z = standardized_on_triangles(mould, film);
  Vec weights(mould.triangle_count());
  for (int t = 0; t < mould.triangle_count(); ++t)
    weights[t] = surface_area(flatten(mould.vertices), mould.triangles.row(t));
  EXPECT_NEAR(weights.dot(z) / weights.sum(), 0, 1e-12);
  EXPECT_NEAR(weights.dot(z.cwiseAbs2()) / weights.sum(), 1, 1e-12);
  test::expect_input_error([&] { levelled_film(mould, 0); }, {"levelling length"});
  test::expect_input_error([&] { standardized_on_triangles(mould, Vec::Ones(mould.vertex_count())); }, {"constant"});
}

// u . L u is the integral of |grad u|^2: 8 pi / 3 of a coordinate on the unit sphere.
TEST(CotangentLaplacian, EnergyOfACoordinate)
{
  const auto error = [](int vertices) {
    const TriangleMesh mesh = sphere(1, vertices);
    const Vec z = mesh.vertices.col(2);
    return std::abs(z.dot(cotangent_laplacian(mesh) * z) - 8 * M_PI / 3);
  };
  EXPECT_LT(error(2000), 0.02);
  EXPECT_NEAR(error(500) / error(2000), 4, 0.5);
}

}  // namespace
}  // namespace softform
