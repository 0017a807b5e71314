#include "softform/io/svg_path.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {
namespace {

using Point = Eigen::Vector2d;

class PathReader {
 public:
  PathReader(const std::string& text, double tolerance) : text_(text), tolerance_(tolerance) {}

  std::vector<SvgSubpath> read()
  {
    char command = 0;
    while (skip_separators(), place_ < text_.size()) {
      if (std::isalpha(static_cast<unsigned char>(text_[place_])) != 0) {
        command = text_[place_++];
      } else if (command == 0 || command == 'Z' || command == 'z') {
        refuse("a number without a command");
      } else if (command == 'M' || command == 'm') {
        command = command == 'M' ? 'L' : 'l';  // further pairs after a move are lines
      }
      execute(command);
    }
    close_where_ends_meet();
    return std::move(subpaths_);
  }

 private:
  void execute(char command)
  {
    const bool is_relative = std::islower(static_cast<unsigned char>(command)) != 0;
    const Point origin = is_relative ? current_ : Point(0, 0);
    const char kind = static_cast<char>(std::toupper(static_cast<unsigned char>(command)));
    if (kind != 'M' && subpaths_.empty()) refuse("it does not begin with M");
    if (kind != 'M' && kind != 'Z' && subpaths_.back().is_closed) begin(current_);  // goes on where Z led
    const Point before = last_control_;
    last_control_ = current_;
    switch (kind) {
      case 'M': begin(origin + point()); break;
      case 'L': line_to(origin + point()); break;
      case 'H': line_to({origin.x() + number(), current_.y()}); break;
      case 'V': line_to({current_.x(), origin.y() + number()}); break;
      case 'C':
      case 'S': {
        const bool is_smooth_after = last_kind_ == 'C' || last_kind_ == 'S';
        const Point mirrored = is_smooth_after ? Point(2 * current_ - before) : current_;
        const Point first = kind == 'C' ? Point(origin + point()) : mirrored;
        const Point second = origin + point(), end = origin + point();
        cubic_to(first, second, end);
        last_control_ = second;
        break;
      }
      case 'Q':
      case 'T': {
        const bool is_smooth_after = last_kind_ == 'Q' || last_kind_ == 'T';
        const Point mirrored = is_smooth_after ? Point(2 * current_ - before) : current_;
        const Point control = kind == 'Q' ? Point(origin + point()) : mirrored;
        const Point end = origin + point();
        cubic_to(current_ + 2.0 / 3 * (control - current_), end + 2.0 / 3 * (control - end), end);
        last_control_ = control;
        break;
      }
      case 'A': arc(origin); break;
      case 'Z': close(); break;
      default: refuse(fmt::format("the command '{}' is unknown", command));
    }
    last_kind_ = kind;
  }

  void begin(const Point& start)
  {
    close_where_ends_meet();
    subpaths_.push_back({{start}, false});
    current_ = last_control_ = start;
  }

  void close_where_ends_meet()
  {
    if (subpaths_.empty() || subpaths_.back().is_closed || subpaths_.back().points.size() < 3) return;
    auto& path = subpaths_.back();
    if ((path.points.back() - path.points.front()).norm() > tolerance_) return;
    path.points.pop_back();
    path.is_closed = true;
  }

  void close()
  {
    auto& points = subpaths_.back().points;
    if (points.size() > 1 && (points.back() - points.front()).norm() <= tolerance_) points.pop_back();
    subpaths_.back().is_closed = true;
    current_ = points.front();
  }

  void line_to(const Point& end)
  {
    if ((end - current_).norm() > 0) subpaths_.back().points.push_back(end);
    current_ = end;
  }

  // A cubic is off n equal chords by at most 3/4 of its largest second difference over n^2.
  void cubic_to(const Point& a, const Point& b, const Point& end)
  {
    const Point start = current_;
    const double bend = std::max((start - 2 * a + b).norm(), (a - 2 * b + end).norm());
    const int count = std::clamp(int(std::ceil(std::sqrt(0.75 * bend / tolerance_))), 1, 10'000);
    for (int k = 1; k <= count; ++k) {
      const double t = double(k) / count, s = 1 - t;
      line_to(s * s * s * start + 3 * s * s * t * a + 3 * s * t * t * b + t * t * t * end);
    }
  }

  // SVG 1.1, F.6.5: from end points to centre and angles.
  void arc(const Point& origin)
  {
    double rx = std::abs(number()), ry = std::abs(number());
    const double turn = number() * std::numbers::pi / 180;
    const bool is_large = flag(), is_positive = flag();
    const Point end = origin + point(), start = current_;
    if (rx == 0 || ry == 0 || start == end) return line_to(end);
    const double c = std::cos(turn), s = std::sin(turn);
    const Point half = (start - end) / 2, p(c * half.x() + s * half.y(), -s * half.x() + c * half.y());
    const double scale = std::sqrt(std::max(1.0, std::pow(p.x() / rx, 2) + std::pow(p.y() / ry, 2)));
    rx *= scale;
    ry *= scale;
    const double q = std::pow(rx * p.y(), 2) + std::pow(ry * p.x(), 2);
    const double root = std::sqrt(std::max(0.0, rx * rx * ry * ry / q - 1)) * (is_large == is_positive ? -1 : 1);
    const Point centre(root * rx * p.y() / ry, -root * ry * p.x() / rx);
    const auto angle = [&](const Point& v) { return std::atan2(v.y() / ry, v.x() / rx); };
    const double from = angle(p - centre);
    double sweep = angle(-p - centre) - from;
    if (is_positive && sweep < 0) sweep += 2 * std::numbers::pi;
    if (!is_positive && sweep > 0) sweep -= 2 * std::numbers::pi;
    const double chord_angle = std::sqrt(8 * std::min(1.0, tolerance_ / std::max(rx, ry)));
    const int count = std::max(1, int(std::ceil(std::abs(sweep) / chord_angle)));
    for (int k = 1; k <= count; ++k) {
      const Point local =
          centre + Point(rx * std::cos(from + sweep * k / count), ry * std::sin(from + sweep * k / count));
      line_to(k == count ? end
                         : (start + end) / 2 + Point(c * local.x() - s * local.y(), s * local.x() + c * local.y()));
    }
  }

  void skip_separators()
  {
    while (place_ < text_.size() &&
           (std::isspace(static_cast<unsigned char>(text_[place_])) != 0 || text_[place_] == ','))
      ++place_;
  }

  double number()
  {
    skip_separators();
    const char* begin = text_.c_str() + place_;
    char* end = nullptr;
    const double value = std::strtod(begin, &end);
    if (end == begin || !std::isfinite(value)) refuse("a number is missing");
    place_ += std::size_t(end - begin);
    return value;
  }

  // Flags of arcs may stand without a separator.
  bool flag()
  {
    skip_separators();
    if (place_ >= text_.size() || (text_[place_] != '0' && text_[place_] != '1')) refuse("an arc's flag is missing");
    return text_[place_++] == '1';
  }

  Point point()
  {
    const double x = number();
    return {x, number()};
  }

  [[noreturn]] void refuse(const std::string& reason) const
  {
    throw InputError(fmt::format("character {} of the path: {}: export the drawing again", place_ + 1, reason));
  }

  const std::string& text_;
  double tolerance_;
  std::size_t place_ = 0;
  std::vector<SvgSubpath> subpaths_;
  Point current_{0, 0}, last_control_{0, 0};
  char last_kind_ = 0;
};

}  // namespace

std::vector<SvgSubpath> flatten_svg_path(const std::string& d, double tolerance)
{
  return PathReader(d, tolerance).read();
}

}  // namespace softform
