// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/trimming_loops.h"

#include <algorithm>
#include <cmath>

namespace billet {

/// Returns the second coordinate of an end, the same for all curves that meet there.
double TrimmingLoops::joined(const Point &end) {
  for (const Point &other : ends_)
    if (std::hypot(end[0] - other[0], end[1] - other[1]) <= tolerance_)
      return other[1];
  ends_.push_back(end);
  return end[1];
}

void TrimmingLoops::add(const Curve &curve, const std::vector<double> &parameters) {
  curves_.push_back(curve);
  std::vector<std::pair<double, Point>> points;
  points.reserve(parameters.size());
  for (const double t : parameters)
    points.emplace_back(t, curve(t));
  points.front().second[1] = joined(points.front().second);
  points.back().second[1] = joined(points.back().second);

  // Where the curve reverses, find its turning point by golden section.
  std::vector<std::pair<double, Point>> ordered{points.front()};
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const double before = points[i].second[1] - points[i - 1].second[1],
                 after = points[i + 1].second[1] - points[i].second[1];
    if (before * after < 0.) {
      constexpr double golden = 0.6180339887498949;
      const double sign = before > 0. ? 1. : -1.;
      double low = points[i - 1].first, high = points[i + 1].first;
      for (unsigned int n = 0; n < 60; ++n) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        if (sign * curve(a)[1] < sign * curve(b)[1])
          low = a;
        else
          high = b;
      }
      const double turn = 0.5 * (low + high);
      Point top = curve(turn);
      top[1] = sign * std::max(sign * top[1], sign * points[i].second[1]);
      if (turn < points[i].first)
        ordered.emplace_back(turn, top);
      ordered.push_back(points[i]);
      if (turn > points[i].first)
        ordered.emplace_back(turn, top);
    } else
      ordered.push_back(points[i]);
  }
  if (points.size() > 1)
    ordered.push_back(points.back());
  for (std::size_t i = 0; i + 1 < ordered.size(); ++i)
    add_piece(ordered[i].first, ordered[i].second, ordered[i + 1].first, ordered[i + 1].second);
}

void TrimmingLoops::add_piece(const double t_0, const Point &p_0, const double t_1, const Point &p_1) {
  if (p_0[1] == p_1[1]) // no ray crosses it
    return;
  const Point middle = curves_.back()(0.5 * (t_0 + t_1));
  const double bulge = 2. * std::abs(middle[0] - 0.5 * (p_0[0] + p_1[0])) + tolerance_;
  Piece piece{p_0[1],
              p_1[1],
              std::min(p_0[0], p_1[0]) - bulge,
              std::max(p_0[0], p_1[0]) + bulge,
              t_0,
              t_1,
              static_cast<unsigned int>(curves_.size() - 1)};
  if (piece.low > piece.high) {
    std::swap(piece.low, piece.high);
    std::swap(piece.t_low, piece.t_high);
  }
  pieces_.push_back(piece);
}

/// Returns the first coordinate of the piece's point at this height, by the Illinois method.
double TrimmingLoops::crossing(const Piece &piece, const double height) const {
  const Curve &curve = curves_[piece.curve];
  double a = piece.t_low, b = piece.t_high;
  double below = piece.low - height, above = piece.high - height;
  Point point{};
  int last_side = 0;
  for (unsigned int n = 0; n < 60; ++n) {
    const double t = above > below ? (a * above - b * below) / (above - below) : 0.5 * (a + b);
    point = curve(t);
    const double off = point[1] - height;
    if (std::abs(off) <= 1e-15 * (std::abs(height) + std::abs(piece.high - piece.low)) || a == b)
      break;
    if (off < 0.) {
      a = t;
      below = off;
      above *= last_side < 0 ? 0.5 : 1.;
      last_side = -1;
    } else {
      b = t;
      above = off;
      below *= last_side > 0 ? 0.5 : 1.;
      last_side = 1;
    }
  }
  return point[0];
}

bool TrimmingLoops::contains(const Point &point) const {
  bool is_inside = false;
  for (const Piece &piece : pieces_) {
    if (point[1] < piece.low || point[1] >= piece.high || point[0] > piece.right)
      continue;
    if (point[0] < piece.left || point[0] < crossing(piece, point[1]))
      is_inside = !is_inside;
  }
  return is_inside;
}

} // namespace billet
