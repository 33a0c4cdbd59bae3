// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_CURVE_H
#define BILLET_GEOMETRY_CURVE_H

#include <deal.II/base/tensor.h>

#include <string>
#include <vector>

namespace billet {

/// Curve in space as the user defines it.
struct CurveSketch {
  enum class Kind { point, line, arc, spline };

  Kind kind;
  /// Points that define the curve [length]: point 1; line 2 (start, end); arc 3 (start, on the arc,
  /// end); spline at least 3.
  std::vector<dealii::Tensor<1, 3>> points;

  CurveSketch reversed() const;
};

/// Reads one of these forms:
/// - 'point: x, y, z';
/// - 'line: x, y, z to x, y, z';
/// - 'arc: x, y, z via x, y, z to x, y, z';
/// - 'spline: x, y, z via x, y, z via ... to x, y, z'.
///
/// Throws std::invalid_argument with the allowed forms.
CurveSketch read_curve(const std::string &text);

/// Returns "(x, y, z)", for messages.
std::string print(const dealii::Tensor<1, 3> &point);

/// Curve over t in [0, 1]. Lines and arcs have constant speed. A spline is cubic, with two
/// continuous derivatives, natural ends (zero second derivative) and knots spaced as its points. A
/// point is constant over t.
class Curve {
public:
  using Point = dealii::Tensor<1, 3>;

  /// Throws std::invalid_argument, with the reason, if two neighbouring points coincide or the
  /// points of an arc are collinear.
  explicit Curve(const CurveSketch &sketch);

  struct Jet {
    Point position, first, second; ///< position, and its derivatives with respect to t
  };
  Jet at(double t) const;

  /// Returns upper bounds of the absolute components of the second derivative between t = `from`
  /// and `to`.
  Point max_second(double from, double to) const;
  /// Returns an upper bound of the norm of the third derivative between t = `from` and `to`.
  double max_third(double from, double to) const;

private:
  /// Polynomial c_0 + c_1 s + c_2 s² + c_3 s³ with s = t − start.
  struct Span {
    double start;
    Point c0, c1, c2, c3;
  };
  double end_of(std::size_t span) const { return span + 1 < spans_.size() ? spans_[span + 1].start : 1.; }
  void make_arc(const std::vector<Point> &points);
  void make_spline(const std::vector<Point> &points);

  std::vector<Span> spans_; ///< empty for an arc
  /// Data of the arc: x(t) = start + sin φ across − (1 − cos φ) arm with φ = sweep t.
  Point start_, arm_, across_;
  double sweep_ = 0.;
};

} // namespace billet

#endif
