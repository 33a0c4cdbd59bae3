// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/curve.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace billet {

using dealii::Tensor;
using CurveKind = CurveSketch::Kind;
using SpacePoint = Curve::Point;

namespace {

constexpr double in_line = 1e-9; // maximum sine of the angle between collinear directions

/// Reads exactly three numbers; returns false otherwise.
bool read_space_point(const std::string &text, SpacePoint &point) {
  std::istringstream stream(text);
  char first_comma = 0, second_comma = 0;
  std::string rest;
  return (stream >> point[0] >> first_comma >> point[1] >> second_comma >> point[2]) && first_comma == ',' &&
         second_comma == ',' && !(stream >> rest) && std::isfinite(point.norm_square());
}

/// Reads points with 'via' and 'to' between them; returns false for anything else.
bool read_points(const std::string &text, std::vector<SpacePoint> &points, std::vector<std::string> &links) {
  std::istringstream words(text + " to");
  std::string word, part;
  while (words >> word) {
    if (word != "via" && word != "to") {
      part += word + ' ';
      continue;
    }
    points.emplace_back();
    links.push_back(word);
    if (!read_space_point(part, points.back()))
      return false;
    part.clear();
  }
  links.pop_back(); // the terminator added after the last point
  return true;
}

} // namespace

CurveSketch CurveSketch::reversed() const { return {kind, {points.rbegin(), points.rend()}}; }

std::string print(const SpacePoint &point) {
  std::ostringstream stream;
  stream << "(" << point[0] << ", " << point[1] << ", " << point[2] << ")";
  return stream.str();
}

CurveSketch read_curve(const std::string &text) {
  const std::invalid_argument error(
      "a curve is 'point: x, y, z', 'line: x, y, z to x, y, z', 'arc: x, y, z via x, y, z to x, y, z' or "
      "'spline: x, y, z via x, y, z via ... to x, y, z', not '" +
      text + "'");
  const auto colon = text.find(':');
  if (colon == std::string::npos)
    throw error;
  std::string name;
  std::istringstream(text.substr(0, colon)) >> name;
  CurveSketch sketch;
  std::vector<std::string> links;
  if (!read_points(text.substr(colon + 1), sketch.points, links))
    throw error;
  for (std::size_t i = 0; i < links.size(); ++i)
    if (links[i] != (i + 1 == links.size() ? "to" : "via"))
      throw error;
  const std::size_t n = sketch.points.size();
  if (name == "point" && n == 1)
    sketch.kind = CurveKind::point;
  else if (name == "line" && n == 2)
    sketch.kind = CurveKind::line;
  else if (name == "arc" && n == 3)
    sketch.kind = CurveKind::arc;
  else if (name == "spline" && n >= 3)
    sketch.kind = CurveKind::spline;
  else
    throw error;
  return sketch;
}

Curve::Curve(const CurveSketch &sketch) {
  const std::vector<SpacePoint> &points = sketch.points;
  double size = 0.;
  for (const auto &point : points)
    size = std::max(size, (point - points.front()).norm());
  for (std::size_t i = 1; i < points.size(); ++i)
    if ((points[i] - points[i - 1]).norm() <= 1e-9 * size || size == 0.)
      throw std::invalid_argument("two points coincide at " + print(points[i]) +
                                  " (a side that shrinks to a point is 'point: x, y, z')");
  switch (sketch.kind) {
  case CurveKind::point:
    spans_.push_back({0., points[0], {}, {}, {}});
    break;
  case CurveKind::line:
    spans_.push_back({0., points[0], points[1] - points[0], {}, {}});
    break;
  case CurveKind::arc:
    make_arc(points);
    break;
  case CurveKind::spline:
    make_spline(points);
    break;
  }
}

void Curve::make_arc(const std::vector<SpacePoint> &points) {
  const SpacePoint a = points[1] - points[0], b = points[2] - points[0];
  SpacePoint axis = dealii::cross_product_3d(a, b);
  const double area = axis.norm(); // twice the area of the triangle
  const double radicand = a.norm_square() * b.norm_square();
  if (area <= in_line * std::sqrt(radicand))
    throw std::invalid_argument("the points of an arc are in line, or its ends coincide, at " +
                                print(points[1]));
  // Circumcentre: c·a = a²/2, c·b = b²/2 in the plane of a and b.
  const SpacePoint to_centre =
      dealii::cross_product_3d(a.norm_square() * b - b.norm_square() * a, axis) / (2. * area * area);
  axis /= area;
  start_ = points[0];
  arm_ = -to_centre;
  across_ = dealii::cross_product_3d(axis, arm_);
  const SpacePoint end_arm = b - to_centre;
  sweep_ = std::atan2(end_arm * across_, end_arm * arm_);
  if (sweep_ <= 0.)
    sweep_ += 2. * M_PI;
}

// Boost.Math has such splines only for equidistant knots.
void Curve::make_spline(const std::vector<SpacePoint> &points) {
  const std::size_t n = points.size() - 1;
  std::vector<double> knots(n + 1, 0.);
  for (std::size_t i = 1; i <= n; ++i)
    knots[i] = knots[i - 1] + (points[i] - points[i - 1]).norm();
  for (double &knot : knots)
    knot /= knots.back();

  // Second derivatives m at the knots, with h_i = t_{i+1} − t_i and slopes s_i:
  //   h_{i−1} m_{i−1} + 2 (h_{i−1} + h_i) m_i + h_i m_{i+1} = 6 (s_i − s_{i−1}),  m_0 = m_n = 0,
  // by elimination: m_i = right_i − factor_i m_{i+1}.
  const auto h = [&](const std::size_t i) { return knots[i + 1] - knots[i]; };
  const auto slope = [&](const std::size_t i) { return (points[i + 1] - points[i]) / h(i); };
  std::vector<double> factor(n + 1, 0.);
  std::vector<SpacePoint> bend(n + 1);
  for (std::size_t i = 1; i < n; ++i) {
    const double pivot = 2. * (h(i - 1) + h(i)) - h(i - 1) * factor[i - 1];
    factor[i] = h(i) / pivot;
    bend[i] = (6. * (slope(i) - slope(i - 1)) - h(i - 1) * bend[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i > 0; --i)
    bend[i] -= factor[i] * bend[i + 1];
  for (std::size_t i = 0; i < n; ++i)
    spans_.push_back({knots[i], points[i], slope(i) - h(i) / 6. * (2. * bend[i] + bend[i + 1]), 0.5 * bend[i],
                      (bend[i + 1] - bend[i]) / (6. * h(i))});
}

Curve::Jet Curve::at(const double t) const {
  if (spans_.empty()) {
    // 1 − cos φ = 2 sin²(φ/2): no cancellation in flat arcs.
    const double half = 0.5 * sweep_ * t, sine = std::sin(half), cosine = std::cos(half);
    const double sin = 2. * sine * cosine, fall = 2. * sine * sine, cos = 1. - fall;
    return {start_ + sin * across_ - fall * arm_, sweep_ * (cos * across_ - sin * arm_),
            -sweep_ * sweep_ * (sin * across_ + cos * arm_)};
  }
  const auto next = std::upper_bound(spans_.begin() + 1, spans_.end(), t,
                                     [](const double value, const Span &span) { return value < span.start; });
  const Span &span = *(next - 1);
  const double s = t - span.start;
  return {span.c0 + s * (span.c1 + s * (span.c2 + s * span.c3)),
          span.c1 + s * (2. * span.c2 + (3. * s) * span.c3), 2. * span.c2 + (6. * s) * span.c3};
}

SpacePoint Curve::max_second(const double from, const double to) const {
  SpacePoint maximum;
  if (spans_.empty())
    for (unsigned int c = 0; c < 3; ++c)
      maximum[c] = sweep_ * sweep_ * std::hypot(arm_[c], across_[c]);
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    const Span &span = spans_[i];
    if (span.start > to || end_of(i) < from)
      continue;
    // The second derivative is linear in between.
    for (const double t : {std::max(from, span.start), std::min(to, end_of(i))})
      for (unsigned int c = 0; c < 3; ++c)
        maximum[c] = std::max(maximum[c], std::abs(2. * span.c2[c] + 6. * (t - span.start) * span.c3[c]));
  }
  return maximum;
}

double Curve::max_third(const double from, const double to) const {
  if (spans_.empty())
    return sweep_ * sweep_ * sweep_ * arm_.norm();
  double maximum = 0.;
  for (std::size_t i = 0; i < spans_.size(); ++i)
    if (spans_[i].start <= to && end_of(i) >= from)
      maximum = std::max(maximum, 6. * spans_[i].c3.norm());
  return maximum;
}

} // namespace billet
