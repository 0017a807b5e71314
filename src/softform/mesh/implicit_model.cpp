#include "softform/mesh/implicit_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/mesh/level_surface.hpp"
#include "softform/mesh/remesh.hpp"

namespace softform {
namespace {

/// Visitors of std::variant from lambdas.
template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

ImplicitValue operator-(const ImplicitValue& a) { return {-a.value, -a.gradient}; }

/// v / |v|; on the axis or centre of a shape, where no direction is the nearest, any.
Vec3 direction(const Vec3& v)
{
  const double norm = v.norm();
  return norm > 0 ? Vec3(v / norm) : Vec3::UnitX();
}

ImplicitValue from_ball(const Ball& ball, const Vec3& p)
{
  const Vec3 offset = p - ball.center;
  return {offset.norm() - ball.radius, direction(offset)};
}

/// In the half-plane of the axis, with y along it and x away from it, the cone's side has the normal (c, s).
ImplicitValue from_round_cone(const Ball& a, const Ball& b, const Vec3& p)
{
  const double length = (b.center - a.center).norm();
  const double s = (a.radius - b.radius) / length;
  if (std::abs(s) >= 1) return from_ball(a.radius > b.radius ? a : b, p);  // one ball holds the other
  const double c = std::sqrt(1 - s * s);
  const Vec3 axis = (b.center - a.center) / length;
  const double y = (p - a.center).dot(axis);
  const Vec3 away = p - a.center - y * axis;
  const double x = away.norm();
  const double along_side = c * y - s * x;
  if (along_side < 0) return from_ball(a, p);
  if (along_side > c * length) return from_ball(b, p);
  return {c * x + s * y - a.radius, c * direction(away) + s * axis};
}

ImplicitValue from_tube(const RoundTube& tube, const Vec3& p)
{
  ImplicitValue nearest = from_ball(tube.balls.front(), p);
  for (std::size_t k = 1; k < tube.balls.size(); ++k) {
    const ImplicitValue piece = from_round_cone(tube.balls[k - 1], tube.balls[k], p);
    if (piece.value < nearest.value) nearest = piece;
  }
  return nearest;
}

/// k0 (k0 - 1) / k1 with k0 = |q / r|, k1 = |q / r^2|: zero on the surface, where its gradient has length 1.
ImplicitValue from_ellipsoid(const Ellipsoid& ellipsoid, const Vec3& p)
{
  const Vec3 q = ellipsoid.axes.transpose() * (p - ellipsoid.center);
  const Vec3 q_r = q.cwiseQuotient(ellipsoid.radii);
  const Vec3 q_rr = q_r.cwiseQuotient(ellipsoid.radii);
  const double k0 = q_r.norm(), k1 = q_rr.norm();
  if (!(k1 > 0)) return {-ellipsoid.radii.minCoeff(), ellipsoid.axes.col(0)};
  const Vec3 k0_q = q_rr / k0;
  const Vec3 k1_q = q_rr.cwiseQuotient(ellipsoid.radii.cwiseAbs2()) / k1;
  const Vec3 gradient = (2 * k0 - 1) / k1 * k0_q - k0 * (k0 - 1) / (k1 * k1) * k1_q;
  return {k0 * (k0 - 1) / k1, ellipsoid.axes * gradient};
}

ImplicitValue from_box(const RoundedBox& box, const Vec3& p)
{
  const Vec3 local = box.axes.transpose() * (p - box.center);
  const Vec3 sign = local.unaryExpr([](double v) { return v < 0 ? -1.0 : 1.0; });
  const Vec3 q = local.cwiseAbs() - (box.half_sizes.array() - box.rounding).matrix();
  const Vec3 outside = q.cwiseMax(0);
  Vec3::Index side = 0;
  const double depth = q.maxCoeff(&side);
  const Vec3 gradient = depth > 0 ? Vec3(outside.normalized()) : Vec3(Vec3::Unit(side));
  return {outside.norm() + std::min(depth, 0.0) - box.rounding, box.axes * gradient.cwiseProduct(sign)};
}

ImplicitValue from_torus(const Torus& torus, const Vec3& p)
{
  const Vec3 offset = p - torus.center;
  const Vec3 in_plane = offset - offset.dot(torus.axis) * torus.axis;
  return from_ball({torus.center + torus.ring_radius * direction(in_plane), torus.tube_radius}, p);
}

/// Balls that hold the primitive and, where it has one, have their centres inside it.
std::vector<Ball> balls_around(const Primitive& primitive)
{
  return std::visit(Overloaded{[](const RoundTube& tube) { return tube.balls; },
                               [](const Ellipsoid& e) {
                                 return std::vector<Ball>{{e.center, e.radii.maxCoeff()}};
                               },
                               [](const RoundedBox& b) {
                                 return std::vector<Ball>{{b.center, b.half_sizes.norm()}};
                               },
                               [](const Torus& t) {
                                 const Vec3 across = t.axis.unitOrthogonal() * t.ring_radius;
                                 return std::vector<Ball>{{t.center + across, 2 * t.ring_radius + t.tube_radius}};
                               }},
                    primitive);
}

/// The values at u in [0, 1] between b and c of the Catmull-Rom curve through a, b, c, d.
template <class Value>
Value catmull_rom(const Value& a, const Value& b, const Value& c, const Value& d, double u)
{
  return b + 0.5 * u * (c - a + u * (2 * a - 5 * b + 4 * c - d + u * (3 * (b - c) + d - a)));
}

Vec3 reflected(const Vec3& p) { return {-p.x(), p.y(), p.z()}; }

}  // namespace

RoundTube::RoundTube(const std::vector<Ball>& given) : balls(given)
{
  if (given.size() < 3) return;  // straight
  constexpr int pieces = 8;
  balls.clear();
  for (std::size_t k = 0; k + 1 < given.size(); ++k) {
    const Ball &b = given[k], &c = given[k + 1];
    const Ball& a = given[k == 0 ? 0 : k - 1];
    const Ball& d = given[std::min(k + 2, given.size() - 1)];
    for (int i = 0; i < pieces; ++i) {
      const double u = double(i) / pieces;
      // Cubic curves overshoot; a radius stays between its neighbours'.
      const double radius = std::clamp(catmull_rom(a.radius, b.radius, c.radius, d.radius, u),
                                       std::min(b.radius, c.radius), std::max(b.radius, c.radius));
      balls.push_back({catmull_rom<Vec3>(a.center, b.center, c.center, d.center, u), radius});
    }
  }
  balls.push_back(given.back());
}

ImplicitValue evaluate(const Primitive& primitive, const Vec3& point)
{
  return std::visit(Overloaded{[&](const RoundTube& tube) { return from_tube(tube, point); },
                               [&](const Ellipsoid& ellipsoid) { return from_ellipsoid(ellipsoid, point); },
                               [&](const RoundedBox& box) { return from_box(box, point); },
                               [&](const Torus& torus) { return from_torus(torus, point); }},
                    primitive);
}

ImplicitValue smooth_union(const ImplicitValue& a, const ImplicitValue& b, double blend)
{
  if (b.value < a.value) return smooth_union(b, a, blend);
  const double overlap = blend - (b.value - a.value);
  if (!(overlap > 0)) return a;
  const double weight = 0.5 * overlap / blend;
  return {a.value - 0.5 * weight * overlap, (1 - weight) * a.gradient + weight * b.gradient};
}

ImplicitValue ImplicitModel::evaluate(const Vec3& point) const
{
  ImplicitValue solid{std::numeric_limits<double>::max(), Vec3::UnitX()};
  for (const Part& part : parts) {
    ImplicitValue value = softform::evaluate(part.primitive, point);
    if (part.is_mirrored) {
      ImplicitValue mirrored = softform::evaluate(part.primitive, reflected(point));
      mirrored.gradient = reflected(mirrored.gradient);
      value = smooth_union(value, mirrored, part.blend);
    }
    solid = part.is_removed ? -smooth_union(-solid, value, part.blend) : smooth_union(solid, value, part.blend);
  }
  return solid;
}

Ball ImplicitModel::bounding_ball() const
{
  std::vector<Ball> balls;
  for (const Part& part : parts) {
    if (part.is_removed) continue;
    for (Ball ball : balls_around(part.primitive)) {
      ball.radius += part.blend / 4;
      balls.push_back(ball);
      if (part.is_mirrored) balls.push_back({reflected(ball.center), ball.radius});
    }
  }
  double deepest = 0;
  Ball bound{Vec3::Zero(), 0};
  for (const Ball& ball : balls) {
    const double value = evaluate(ball.center).value;
    if (!(value < deepest)) continue;
    deepest = value;
    bound.center = ball.center;
  }
  if (!(deepest < 0)) throw InputError("the model is empty: no part has its centre inside the solid; remove less");
  for (const Ball& ball : balls)
    bound.radius = std::max(bound.radius, (ball.center - bound.center).norm() + ball.radius);
  return bound;
}

Vec3 projected(const ImplicitModel& model, Vec3 point)
{
  for (int k = 0; k < 20; ++k) {
    const ImplicitValue f = model.evaluate(point);
    const Vec3 step = f.value / f.gradient.squaredNorm() * f.gradient;
    if (!step.allFinite()) break;  // a stationary point, as between two blended parts: nowhere near the surface
    point -= step;
    if (step.norm() < 1e-15 * (1 + point.norm())) break;
  }
  return point;
}

TriangleMesh mesh_model(const ImplicitModel& model, int vertex_count)
{
  const Ball bound = model.bounding_ball();
  // Fine enough to see a limb of a twentieth of the model's size.
  const TriangleMesh surface =
      level_surface([&](const Vec3& p) { return model.evaluate(p).value; }, bound.center, bound.radius / 50);
  const auto edge_count = static_cast<int>(edges_of(surface.triangles, surface.vertex_count()).size());
  if (const int genus = 1 - (surface.vertex_count() - edge_count + surface.triangle_count()) / 2; genus != 0)
    throw InputError(
        fmt::format("the solid has genus {}, a balloon 0: fill the gap between the parts that form a ring, or move "
                    "them apart",
                    genus));
  RemeshOptions options;
  options.projection = [&model](const Vec3& p) { return projected(model, p); };
  return remesh_to_vertex_count(surface, vertex_count, options);
}

}  // namespace softform
