// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_FRAME_H
#define BILLET_GEOMETRY_FRAME_H

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

namespace billet {

/// Returns P = I − n⊗n, which removes the component along the unit vector `n`.
inline dealii::Tensor<2, 3> projector_across(const dealii::Tensor<1, 3> &n) {
  return dealii::Tensor<2, 3>(dealii::unit_symmetric_tensor<3>()) - dealii::outer_product(n, n);
}

/// Contact reference system (CRS): right-handed, q × r = n.
///
/// Number: double, or Derivative.
template <class Number> struct FrameOf {
  using Vector = dealii::Tensor<1, 3, Number>;

  Vector q, r, n;
  /// Spin of the frame about n when n rotates by δn:
  ///   δq = −(q·δn) n + (spin·δn) r,  δr = −(r·δn) n − (spin·δn) q.
  Vector spin;

  /// Returns an arbitrary frame about the unit vector `n`, always the same for the same n.
  static FrameOf from_normal(const Vector &n) {
    using std::abs;
    unsigned int minimum = 0;
    for (unsigned int i = 1; i < 3; ++i)
      if (abs(n[i]) < abs(n[minimum]))
        minimum = i;
    Vector axis;
    axis[minimum] = 1.;
    FrameOf frame;
    frame.n = n;
    frame.q = dealii::cross_product_3d(n, axis);
    frame.q /= frame.q.norm();
    frame.r = dealii::cross_product_3d(n, frame.q);
    return frame;
  }

  /// Returns this frame, rotated with the tool and then onto the new normal `n_new`. These are eqs.
  /// (4), (5) of Bittencourt & Creus (1998), with the sign of (5) corrected and the spin of the
  /// tool added:
  ///   q* = R q,  r = n × q* / |n × q*|,  q = r × n.
  /// If the normal has rotated onto q*, the frame follows r instead. With δr across r in the plane
  /// of δn × q*,
  ///   spin = −(q*·n)/(q*·q) r,  or, following r* = R r,  (r*·n)/(r*·r) q.
  template <class Result>
  FrameOf<Result> transported(const dealii::Tensor<2, 3, Result> &rotation,
                              const dealii::Tensor<1, 3, Result> &n_new) const {
    FrameOf<Result> frame;
    frame.n = n_new;
    const dealii::Tensor<1, 3, Result> q_carried = rotation * q;
    frame.r = dealii::cross_product_3d(n_new, q_carried);
    const Result length = frame.r.norm();
    if (length > 0.5) {
      frame.r /= length;
      frame.q = dealii::cross_product_3d(frame.r, n_new);
      frame.spin = Result(-(q_carried * n_new) / (q_carried * frame.q)) * frame.r;
    } else { // |n × q*|² + |n × r*|² ≥ 1, so one of the two is always usable
      const dealii::Tensor<1, 3, Result> r_carried = rotation * r;
      frame.q = dealii::cross_product_3d(r_carried, n_new);
      frame.q /= frame.q.norm();
      frame.r = dealii::cross_product_3d(n_new, frame.q);
      frame.spin = Result((r_carried * n_new) / (r_carried * frame.r)) * frame.q;
    }
    return frame;
  }
};
using Frame = FrameOf<double>;

} // namespace billet

#endif
