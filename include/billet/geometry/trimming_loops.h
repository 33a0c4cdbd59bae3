// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_TRIMMING_LOOPS_H
#define BILLET_GEOMETRY_TRIMMING_LOOPS_H

#include <array>
#include <functional>
#include <vector>

namespace billet {

/// Closed curves in a plane that bound a region: a point is inside if a ray from it crosses them an
/// odd number of times.
class TrimmingLoops {
public:
  using Point = std::array<double, 2>;
  using Curve = std::function<Point(double)>;

  /// End points of curves that are nearer than `tolerance` to each other are merged.
  explicit TrimmingLoops(const double tolerance) : tolerance_(tolerance) {}

  /// Adds a part of a loop through the points at these ascending parameters, between which the
  /// curve's direction changes little. The parts may have any order and direction.
  void add(const Curve &curve, const std::vector<double> &parameters);

  bool contains(const Point &point) const;

private:
  /// Part of a curve along which the second coordinate is monotonic.
  struct Piece {
    double low, high;     ///< range of the second coordinate
    double left, right;   ///< bounds of the first coordinate
    double t_low, t_high; ///< parameters of its ends
    unsigned int curve;
  };
  double joined(const Point &end);
  void add_piece(double t_0, const Point &p_0, double t_1, const Point &p_1);
  double crossing(const Piece &piece, double height) const;

  double tolerance_;
  std::vector<Curve> curves_;
  std::vector<Piece> pieces_;
  std::vector<Point> ends_;
};

} // namespace billet

#endif
