// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_CURVE_H
#define BILLET_GEOMETRY_CURVE_H

#include <deal.II/base/tensor.h>

#include <string>
#include <vector>

namespace billet {

/// A curve in space as a user draws it.
struct CurveSketch {
  enum class Kind { point, line, arc, spline };

  Kind kind;
  /// Of a point one, of a line two (start, end), of an arc three (start, on the way, end), of a spline at
  /// least three. [length]
  std::vector<dealii::Tensor<1, 3>> points;

  CurveSketch reversed() const;
};

/// Reads 'point: x, y, z', 'line: x, y, z to x, y, z', 'arc: x, y, z via x, y, z to x, y, z' or 'spline: x,
/// y, z via x, y, z via ... to x, y, z'. Throws std::invalid_argument with what is allowed.
CurveSketch read_curve(const std::string &text);

/// "(x, y, z)", for messages.
std::string print(const dealii::Tensor<1, 3> &point);

/// A curve over t in [0, 1]: a line or an arc at constant speed; a spline, the cubic one with two continuous
/// derivatives and natural ends (no second derivative there), whose knots are apart as its points are; or a
/// point, over all t.
class Curve {
public:
  using Point = dealii::Tensor<1, 3>;

  /// Throws std::invalid_argument, with the reason, where two neighbouring points coincide or those of an arc
  /// are in line.
  explicit Curve(const CurveSketch &sketch);

  struct Jet {
    Point position, first, second; ///< derivatives with respect to t
  };
  Jet at(double t) const;

  /// Not less than any component of the second derivative, by size, between t = `from` and `to`.
  Point largest_second(double from, double to) const;
  /// Not less than the third derivative, by size, between t = `from` and `to`.
  double largest_third(double from, double to) const;

private:
  /// c_0 + c_1 s + c_2 s² + c_3 s³ with s = t − start.
  struct Span {
    double start;
    Point c0, c1, c2, c3;
  };
  double end_of(std::size_t span) const { return span + 1 < spans_.size() ? spans_[span + 1].start : 1.; }
  void make_arc(const std::vector<Point> &points);
  void make_spline(const std::vector<Point> &points);

  std::vector<Span> spans_; ///< none: an arc
  /// Of the arc: x(t) = start + sin φ across − (1 − cos φ) arm with φ = sweep t.
  Point start_, arm_, across_;
  double sweep_ = 0.;
};

} // namespace billet

#endif
