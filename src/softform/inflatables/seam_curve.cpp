#include "softform/inflatables/seam_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {
namespace {

/// Points of the curves per edge of the mesh to be cut.
constexpr double points_per_edge = 6;

/// A node on a curve, by arc length.
struct Stop {
  double arc;
  int node;
};

struct Curve {
  bool is_closed = false;
  Positions points = {};
  Vec arcs = {};
  std::vector<Stop> stops = {};  ///< in the order in which they were found; the ends of an open curve first and last

  double length() const { return arcs[arcs.size() - 1]; }

  /// The arc length of the point of the curve that is closest to p.
  double closest_arc(const Vec3& p) const
  {
    double arc = 0, least = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i + 1 < points.rows(); ++i) {
      const Vec3 a = points.row(i), ab = points.row(i + 1) - points.row(i);
      const double t = std::clamp((p - a).dot(ab) / std::max(ab.squaredNorm(), 1e-300), 0.0, 1.0);
      const double distance = (a + t * ab - p).norm();
      if (distance < least) least = distance, arc = arcs[i] + t * ab.norm();
    }
    return arc;
  }
};

/// Control points with the nodes that they are, or -1.
struct ControlPoints {
  std::vector<Vec3> points;
  std::vector<int> nodes;
};

class SeamLayer {
 public:
  SeamLayer(const Geodesics& target, const SeamPlan& plan, double resolution)
      : target_(target), plan_(plan), resolution_(resolution)
  {}

  SeamNetwork lay()
  {
    for (std::size_t s = 0; s < plan_.seams.size(); ++s) curves_.push_back(lay_curve(s));
    for (std::size_t s = 0; s < curves_.size(); ++s)
      for (std::size_t r = 0; r <= s; ++r) require_no_crossing(r, s), require_no_touching(r, s);
    for (Curve& curve : curves_)
      if (curve.is_closed) start_at_node(curve);
    SeamNetwork network;
    network.nodes.resize(static_cast<Eigen::Index>(nodes_.size()), 3);
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      network.nodes.row(static_cast<Eigen::Index>(i)) = nodes_[i].transpose();
    for (std::size_t s = 0; s < curves_.size(); ++s) append_segments(s, network.segments);
    return network;
  }

 private:
  [[noreturn]] void refuse(std::size_t seam, const std::string& problem) const
  {
    throw InputError(fmt::format("{}: seam '{}': {}", plan_.source, plan_.seams[seam].name, problem));
  }

  const Vec3& node(const Stop& stop) const { return nodes_[static_cast<std::size_t>(stop.node)]; }

  int add_node(const Vec3& p)
  {
    nodes_.push_back(p);
    return static_cast<int>(nodes_.size()) - 1;
  }

  /// The node at an arc length of an earlier curve: one that is there already, or a new one.
  int node_on(Curve& curve, double arc)
  {
    for (const Stop& stop : curve.stops) {
      const double gap = std::abs(stop.arc - arc);
      if (std::min(gap, curve.is_closed ? curve.length() - gap : gap) < 0.5 * resolution_) return stop.node;
    }
    const int node = add_node(point_at(curve.points, curve.arcs, arc));
    curve.stops.insert(curve.stops.begin() + (curve.stops.empty() ? 0 : 1), {arc, node});
    return node;
  }

  ControlPoints control_points(std::size_t seam)
  {
    ControlPoints control;
    const DrawnSeam& drawn = plan_.seams[seam];
    for (std::size_t i = 0; i < drawn.points.size(); ++i) {
      const SeamPoint& point = drawn.points[i];
      int node = -1;
      if (!point.on.empty()) {
        Curve& curve = curves_[index_of_.at(point.on)];
        node = node_on(curve, point.fraction ? *point.fraction * curve.length() : curve.closest_arc(point.position));
        if (!point.fraction) require_near(seam, i, point.position, nodes_[static_cast<std::size_t>(node)], point.on);
        control.points.push_back(nodes_[static_cast<std::size_t>(node)]);
      } else {
        const ClosestPoint closest = target_.surface().closest(point.position);
        require_near(seam, i, point.position, closest.position, "the target");
        control.points.push_back(closest.position);
        const bool is_end = !drawn.is_closed && (i == 0 || i + 1 == drawn.points.size());
        if (is_end) node = end_node(closest.position);
      }
      control.nodes.push_back(node);
    }
    return control;
  }

  /// Seams that end in the same point meet there.
  int end_node(const Vec3& p)
  {
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if ((nodes_[i] - p).norm() < 1e-6 * resolution_) return static_cast<int>(i);
    return add_node(p);
  }

  void require_near(std::size_t seam, std::size_t point, const Vec3& drawn, const Vec3& reached,
                    const std::string& what) const
  {
    const double distance = (drawn - reached).norm();
    if (distance > resolution_)
      refuse(seam,
             fmt::format("point {} at {} is {:.3g} off {}, whose closest point is {}: move it there", point + 1,
                         place(drawn), distance, what == "the target" ? what : "seam '" + what + "'", place(reached)));
  }

  Curve lay_curve(std::size_t seam)
  {
    index_of_[plan_.seams[seam].name] = seam;
    ControlPoints control = control_points(seam);
    const bool is_closed = plan_.seams[seam].is_closed;
    if (is_closed) control.points.push_back(control.points.front()), control.nodes.push_back(control.nodes.front());
    std::vector<Positions> spans;
    for (std::size_t i = 0; i + 1 < control.points.size(); ++i) {
      if ((control.points[i + 1] - control.points[i]).norm() < 0.5 * resolution_)
        refuse(seam, fmt::format("points {} and {} at {} are as good as one: leave one out", i + 1, i + 2,
                                 place(control.points[i])));
      spans.push_back(target_.path(control.points[i], control.points[i + 1], resolution_ / points_per_edge));
    }
    bend(spans, is_closed);

    Curve curve{is_closed};
    std::vector<double> span_arcs{0};
    for (const Positions& span : spans) {
      const Eigen::Index old = std::max<Eigen::Index>(curve.points.rows() - 1, 0);
      curve.points.conservativeResize(old + span.rows(), 3);
      curve.points.bottomRows(span.rows()) = span;
      curve.arcs = arc_lengths(curve.points);
      span_arcs.push_back(curve.length());
    }
    for (std::size_t i = 0; i < control.nodes.size(); ++i)
      if (control.nodes[i] >= 0) curve.stops.push_back({span_arcs[i], control.nodes[i]});
    return curve;
  }

  /// Gives both sides of every inner control point one tangent: the difference between the Hermite spline with these
  /// tangents and the geodesics, t (1 - t)^2 d0 - t^2 (1 - t) d1, is added to the geodesics.
  void bend(std::vector<Positions>& spans, bool is_closed) const
  {
    const std::size_t n = spans.size();
    std::vector<double> lengths;
    std::vector<Vec3> first, last;
    for (const Positions& span : spans) {
      lengths.push_back(arc_lengths(span)[span.rows() - 1]);
      first.push_back((span.row(1) - span.row(0)).normalized());
      last.push_back((span.row(span.rows() - 1) - span.row(span.rows() - 2)).normalized());
    }
    std::vector<Vec3> d0(n, Vec3::Zero()), d1(n, Vec3::Zero());
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t next = (i + 1) % n;
      if (next == 0 && !is_closed) break;
      const Vec3 tangent = (lengths[next] * last[i] + lengths[i] * first[next]).normalized();
      d1[i] = lengths[i] * (tangent - last[i]);
      d0[next] = lengths[next] * (tangent - first[next]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const Vec arcs = arc_lengths(spans[i]);
      for (Eigen::Index k = 1; k + 1 < spans[i].rows(); ++k) {
        const double t = arcs[k] / lengths[i];
        const Vec3 bent = spans[i].row(k).transpose() + t * (1 - t) * (1 - t) * d0[i] - t * t * (1 - t) * d1[i];
        spans[i].row(k) = target_.surface().closest(bent).position.transpose();
      }
    }
  }

  [[noreturn]] void refuse_meeting(std::size_t first, std::size_t second, const Vec3& p) const
  {
    if (first == second)
      refuse(first, fmt::format("crosses itself near {}: make it two seams that meet there", place(p)));
    refuse(second, fmt::format("comes to seam '{0}' near {1} without meeting it: keep them apart, or let it pass "
                               "through {{\"on\": \"{0}\", \"near\": [{2:.4g}, {3:.4g}, {4:.4g}]}}",
                               plan_.seams[first].name, place(p), p.x(), p.y(), p.z()));
  }

  /// Whether p lies at a node of both curves, where they may meet.
  bool is_at_common_node(const Curve& a, const Curve& b, const Vec3& p) const
  {
    for (const Stop& stop : a.stops)
      for (const Stop& other : b.stops)
        if (stop.node == other.node && (node(stop) - p).norm() < 0.25 * resolution_) return true;
    return false;
  }

  /// Whether the pieces i of a and k of b cross, seen along the normal of the target.
  bool do_cross(const Curve& a, Eigen::Index i, const Curve& b, Eigen::Index k) const
  {
    const Vec3 p0 = a.points.row(i), p1 = a.points.row(i + 1), q0 = b.points.row(k), q1 = b.points.row(k + 1);
    if ((p0 - q0).norm() > 3 * resolution_ / points_per_edge) return false;
    const Vec3 normal = target_.surface().closest(p0).normal;
    const auto turn = [&](const Vec3& u, const Vec3& v, const Vec3& w) { return normal.dot((v - u).cross(w - u)) > 0; };
    return turn(p0, p1, q0) != turn(p0, p1, q1) && turn(q0, q1, p0) != turn(q0, q1, p1);
  }

  void require_no_crossing(std::size_t first, std::size_t second) const
  {
    const Curve &a = curves_[first], &b = curves_[second];
    for (Eigen::Index i = 0; i + 1 < a.points.rows(); ++i) {
      for (Eigen::Index k = first == second ? i + 2 : 0; k + 1 < b.points.rows(); ++k) {
        const bool is_around_start = first == second && a.is_closed && i + b.points.rows() - 1 - k < 3;
        if (!is_around_start && do_cross(a, i, b, k) && !is_at_common_node(a, b, a.points.row(i)))
          refuse_meeting(first, second, a.points.row(i));
      }
    }
  }

  /// No end of one may lie on the other, unless they meet there.
  void require_no_touching(std::size_t first, std::size_t second) const
  {
    for (const auto& [ends, other] : {std::pair{first, second}, std::pair{second, first}}) {
      if (curves_[ends].is_closed || first == second) continue;
      const Curve& curve = curves_[other];
      for (const Stop& stop : {curves_[ends].stops.front(), curves_[ends].stops.back()}) {
        const Vec3 closest = point_at(curve.points, curve.arcs, curve.closest_arc(node(stop)));
        const bool is_common = std::any_of(curve.stops.begin(), curve.stops.end(),
                                           [&](const Stop& on_other) { return on_other.node == stop.node; });
        if (!is_common && (closest - node(stop)).norm() < 0.5 * resolution_) refuse_meeting(first, second, closest);
      }
    }
  }

  void append_segments(std::size_t seam, std::vector<SeamSegment>& segments)
  {
    Curve& curve = curves_[seam];
    const std::string& name = plan_.seams[seam].name;
    std::sort(curve.stops.begin(), curve.stops.end(), [](const Stop& a, const Stop& b) { return a.arc < b.arc; });
    const std::size_t count = curve.stops.size() - 1;
    for (std::size_t i = 0; i < count; ++i) {
      const Stop &from = curve.stops[i], &to = curve.stops[i + 1];
      SeamSegment segment{
          count == 1 ? name : fmt::format("{} {}", name, i + 1), static_cast<int>(seam), from.node, to.node, {}};
      const int points =
          1 + std::max(1, static_cast<int>(std::ceil((to.arc - from.arc) * points_per_edge / resolution_)));
      segment.points.resize(points, 3);
      for (int k = 0; k < points; ++k)
        segment.points.row(k) =
            point_at(curve.points, curve.arcs, from.arc + (to.arc - from.arc) * k / (points - 1)).transpose();
      segment.points.row(0) = nodes_[static_cast<std::size_t>(from.node)].transpose();
      segment.points.row(points - 1) = nodes_[static_cast<std::size_t>(to.node)].transpose();
      segments.push_back(std::move(segment));
    }
  }

  /// Turns a closed curve so that it begins and ends at a node; it gets one when it has none.
  void start_at_node(Curve& curve)
  {
    std::vector<Stop>& stops = curve.stops;
    const double length = curve.length();
    if (stops.empty()) stops.push_back({0, add_node(curve.points.row(0))});
    const double first =
        std::min_element(stops.begin(), stops.end(), [](const Stop& a, const Stop& b) { return a.arc < b.arc; })->arc;
    if (first > 0) {
      const Vec old_arcs = curve.arcs;
      const Positions old_points = curve.points;
      for (Eigen::Index i = 0; i < old_points.rows(); ++i) {
        const double arc = first + length * static_cast<double>(i) / static_cast<double>(old_points.rows() - 1);
        curve.points.row(i) = point_at(old_points, old_arcs, arc > length ? arc - length : arc).transpose();
        curve.arcs[i] = arc - first;
      }
      for (Stop& stop : stops) stop.arc -= first;
    }
    std::erase_if(stops, [&](const Stop& stop) { return stop.arc > length - 1e-9 * length; });
    const auto begin = std::find_if(stops.begin(), stops.end(), [](const Stop& stop) { return stop.arc == 0; });
    stops.push_back({length, begin->node});
  }

  const Geodesics& target_;
  const SeamPlan& plan_;
  double resolution_;
  std::vector<Vec3> nodes_;
  std::vector<Curve> curves_;
  std::map<std::string, std::size_t> index_of_;
};

}  // namespace

std::string place(const Vec3& point)
{
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", point.x(), point.y(), point.z());
}

SeamNetwork lay_seams(const Geodesics& target, const SeamPlan& plan, double resolution)
{
  return SeamLayer(target, plan, resolution).lay();
}

}  // namespace softform
