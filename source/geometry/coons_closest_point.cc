// SPDX-License-Identifier: LGPL-2.1-or-later
// Closest point of a Coons patch: Newton's method from the nearest cell centre, then from every
// cell that may still contain a nearer point.
#include "billet/geometry/coons_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace billet {

using dealii::Tensor;
using CoonsPoint = CoonsPatch::Point;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double relative_round_off = std::numeric_limits<double>::epsilon();
// Tolerances for "nearer" and for "directly above", relative to the distance and to the patch's
// size.
constexpr double not_nearer = 1e-13, straight_above = 1e-10;

/// Quadratic function g·s + s·H s/2 of s = (s_u, s_v), in lengths.
struct Quadratic {
  double g_u, g_v, uu, uv, vv;

  double min_eigenvalue() const { return 0.5 * (uu + vv) - half_difference(); }
  double max_eigenvalue() const { return 0.5 * (uu + vv) + half_difference(); }
  double half_difference() const { return std::sqrt(0.25 * (uu - vv) * (uu - vv) + uv * uv); }
  /// Replaces the eigenvalues λ_1, λ_2 of H with their absolute values, by (H² + |λ_1 λ_2|
  /// I)/(|λ_1| + |λ_2|), and raises them to at least `lowest`.
  void make_convex(const double lowest) {
    const double first = std::abs(min_eigenvalue()), second = std::abs(max_eigenvalue());
    if (first + second > 0.) {
      const Quadratic h = *this;
      uu = (h.uu * h.uu + h.uv * h.uv + first * second) / (first + second);
      uv = h.uv * (h.uu + h.vv) / (first + second);
      vv = (h.vv * h.vv + h.uv * h.uv + first * second) / (first + second);
    }
    const double shift = std::max(0., lowest - std::min(first, second));
    uu += shift;
    vv += shift;
  }
  double value(const double u, const double v) const {
    return g_u * u + g_v * v + 0.5 * (uu * u * u + vv * v * v) + uv * u * v;
  }
};

/// Pair of coordinates, in lengths.
using Pair = std::array<double, 2>;

/// Returns the minimum of a convex quadratic between `low` and `high`: inside, or on one of the
/// four sides.
Pair minimum(const Quadratic &q, const Pair &low, const Pair &high) {
  const double determinant = q.uu * q.vv - q.uv * q.uv;
  const Pair inside{(q.uv * q.g_v - q.vv * q.g_u) / determinant, (q.uv * q.g_u - q.uu * q.g_v) / determinant};
  if (inside[0] >= low[0] && inside[0] <= high[0] && inside[1] >= low[1] && inside[1] <= high[1])
    return inside;
  Pair best{0., 0.};
  double lowest = infinity;
  const auto consider = [&](const double u, const double v) {
    const double value = q.value(u, v);
    if (value < lowest) {
      lowest = value;
      best = {u, v};
    }
  };
  for (const double u : {low[0], high[0]})
    consider(u, std::clamp(-(q.g_v + q.uv * u) / q.vv, low[1], high[1]));
  for (const double v : {low[1], high[1]})
    consider(std::clamp(-(q.g_u + q.uv * v) / q.uu, low[0], high[0]), v);
  return best;
}

/// Returns u + step, clipped exactly to the range.
double moved(const double u, const double step, const double low, const double high) {
  const double there = u + step;
  return there - low < 1e-14 ? low : high - there < 1e-14 ? high : there;
}

} // namespace

/// Rectangle of cells.
struct CoonsPatch::Block {
  unsigned int low_i, high_i, low_j, high_j;

  void add(const unsigned int i, const unsigned int j) {
    low_i = std::min(low_i, i);
    high_i = std::max(high_i, i);
    low_j = std::min(low_j, j);
    high_j = std::max(high_j, j);
  }
};

/// Whether the cell may contain a point nearer to x than `distance`. It uses the hull of the cell's
/// corners plus the slack, projected on `arm`. This is the vector from the cell's middle to x,
/// whose square is given.
bool CoonsPatch::may_be_nearer(const std::size_t cell, const CoonsPoint &arm, const double square,
                               const double distance) const {
  double towards = -infinity;
  for (const auto &corner : cells_[cell].arms)
    towards = std::max(towards, corner * arm);
  for (unsigned int c = 0; c < 3; ++c)
    towards += cells_[cell].slack[c] * std::abs(arm[c]);
  return square == 0. || square - towards < distance * std::sqrt(square);
}

/// Whether no point of the block is nearer to x than `foot`, a minimum in it. Let X = foot + X_α
/// δ^α + B. If d = x − foot makes no acute angle with X_α δ^α,
///   |X − x|² − d² >= (|X_α δ^α| − |B|)² − 2 d·B.
/// Here 2B = X_αβ δ^α δ^β somewhere in the block, bounded by `bend`. d·X_αβ is its value at the
/// foot plus a change bounded by third derivatives. All quantities use lengths a, b instead of u,
/// v.
bool CoonsPatch::is_nearest(const Foot &foot, const CoonsPoint &x, const Block &block) const {
  const Range &low = cells_[block.low_i * n_v_ + block.low_j].range,
              &high = cells_[block.high_i * n_v_ + block.high_j].range;
  const double a = length_u_ * std::max(foot.u - low.low_u, high.high_u - foot.u),
               b = length_v_ * std::max(foot.v - low.low_v, high.high_v - foot.v);
  double bend_u = 0., bend_v = 0., change_u = 0., change_v = 0.;
  for (unsigned int i = block.low_i; i <= block.high_i; ++i)
    for (unsigned int j = block.low_j; j <= block.high_j; ++j) {
      const Cell &cell = cells_[i * n_v_ + j];
      bend_u = std::max(bend_u, cell.bend_u);
      bend_v = std::max(bend_v, cell.bend_v);
      const double change_uv = a * cell.uuv + b * cell.uvv;
      change_u = std::max(change_u, a * cell.uuu + b * cell.uuv + change_uv);
      change_v = std::max(change_v, a * cell.uvv + b * cell.vvv + change_uv);
    }
  const double scale_u = 1. / length_u_, scale_v = 1. / length_v_;
  const CoonsPoint u = scale_u * foot.jet.u, v = scale_v * foot.jet.v;
  const double stretch = std::sqrt(std::max(0., Quadratic{0., 0., u * u, u * v, v * v}.min_eigenvalue()));
  const double left =
      std::max(0., stretch - 0.5 * std::sqrt(bend_u * bend_u * a * a + bend_v * bend_v * b * b));
  const CoonsPoint d = x - foot.jet.position;
  const double distance = std::sqrt(foot.square);
  const Quadratic towards{0., 0., scale_u * scale_u * (d * foot.jet.uu) + distance * change_u,
                          scale_u * scale_v * (d * foot.jet.uv),
                          scale_v * scale_v * (d * foot.jet.vv) + distance * change_v};
  return std::min(towards.max_eigenvalue(), distance * std::max(bend_u, bend_v)) <= left * left;
}

/// Returns a step of Newton's method on
///   (X − x)·X_u = 0,  (X − x)·X_v = 0
/// (Bittencourt & Creus 1998, eqs. (10), (11)). The step leads to the minimum, within the range, of
/// the second-order model of |X − x|²/2. The model is made convex if necessary, and has Marquardt's
/// damping.
CoonsPatch::Step CoonsPatch::newton_step(const CoonsPoint &x, const Foot &foot, const Range &range,
                                         const double damping) const {
  const Jet &jet = foot.jet;
  const CoonsPoint r = jet.position - x;
  Quadratic model{r * jet.u / length_u_, r * jet.v / length_v_,
                  (jet.u * jet.u + r * jet.uu) / (length_u_ * length_u_),
                  (jet.u * jet.v + r * jet.uv) / (length_u_ * length_v_),
                  (jet.v * jet.v + r * jet.vv) / (length_v_ * length_v_)};
  // On an edge that the descent direction crosses, only the other parameter is free.
  const bool is_held_u = model.g_u > 0. ? foot.u == range.low_u : model.g_u < 0. && foot.u == range.high_u,
             is_held_v = model.g_v > 0. ? foot.v == range.low_v : model.g_v < 0. && foot.v == range.high_v;
  if (is_held_u || is_held_v)
    model.uv = 0.;
  if (is_held_u) {
    model.g_u = 0.;
    model.uu = 1.;
  }
  if (is_held_v) {
    model.g_v = 0.;
    model.vv = 1.;
  }
  const double lowest = 1e-10 * (std::abs(model.uu) + std::abs(model.vv) + 1.);
  const bool is_convex = model.min_eigenvalue() > lowest;
  if (!is_convex)
    model.make_convex(lowest);
  model.uu *= 1. + damping;
  model.vv *= 1. + damping;
  const auto [u, v] = minimum(model, {(range.low_u - foot.u) * length_u_, (range.low_v - foot.v) * length_v_},
                              {(range.high_u - foot.u) * length_u_, (range.high_v - foot.v) * length_v_});
  return {u, v, is_convex && damping == 0.};
}

/// Descends by Newton's method from `foot` to a minimum of the distance in the range.
CoonsPatch::Foot CoonsPatch::newton(const CoonsPoint &x, Foot foot, const Range &range) const {
  double damping = 0., last_length = infinity;
  for (unsigned int iteration = 0; iteration < 100; ++iteration) {
    const Step step = newton_step(x, foot, range, damping);
    const double length = std::max(std::abs(step.u), std::abs(step.v));
    if (length <= relative_round_off * size_)
      return foot;

    Foot next{moved(foot.u, step.u / length_u_, range.low_u, range.high_u),
              moved(foot.v, step.v / length_v_, range.low_v, range.high_v),
              {},
              0.};
    next.jet = at(next.u, next.v);
    next.square = (next.jet.position - x).norm_square();
    const double distance = std::sqrt(foot.square);
    const double noise = 16. * relative_round_off * distance * (distance + foot.jet.position.norm() + size_);
    if (!(next.square <= foot.square + noise)) {
      damping = std::max(8. * damping, 0.1);
      continue;
    }
    foot = next;
    damping = damping > 0.1 ? damping / 8. : 0.;
    // The next Newton step would be below round-off, or the steps consist of round-off.
    if (step.is_newton && (length <= 1e-10 * size_ || (length <= 1e-6 * size_ && length > 0.5 * last_length)))
      return foot;
    last_length = length;
  }
  return foot;
}

/// Moves `foot` off a side that is a point, nearer to x, if possible. The parameter along such a
/// side does not move the point, but selects the direction in which the patch continues.
bool CoonsPatch::leave_pole(const CoonsPoint &x, const Range &range, Foot &foot) const {
  const bool at_low_v = foot.v == 0. && is_pole_[0], at_high_u = foot.u == 1. && is_pole_[1],
             at_high_v = foot.v == 1. && is_pole_[2], at_low_u = foot.u == 0. && is_pole_[3];
  if (!(at_low_v || at_high_u || at_high_v || at_low_u))
    return false;
  const bool along_v = at_low_u || at_high_u;
  const double inwards = at_low_u || at_low_v ? 1. : -1.;
  const double low = along_v ? range.low_v : range.low_u, high = along_v ? range.high_v : range.high_u;
  const CoonsPoint r = foot.jet.position - x;
  const auto at_pole = [&](const double t) { return along_v ? at(foot.u, t) : at(t, foot.v); };
  const auto slope = [&](const Jet &jet) { return inwards * (r * (along_v ? jet.u : jet.v)); };

  // Find the steepest descent: among samples, then by bisection for the zero of the slope's
  // derivative.
  constexpr unsigned int n = 16;
  unsigned int steepest = 0;
  double lowest = infinity;
  for (unsigned int i = 0; i <= n; ++i) {
    const double here = slope(at_pole(low + i * (high - low) / n));
    if (here < lowest) {
      lowest = here;
      steepest = i;
    }
  }
  double before = low + (std::max(1u, steepest) - 1) * (high - low) / n,
         after = low + std::min(n, steepest + 1) * (high - low) / n;
  while (after - before > 1e-9) {
    const double middle = 0.5 * (before + after);
    (inwards * (r * at_pole(middle).uv) > 0. ? after : before) = middle;
  }
  const double t = 0.5 * (before + after);
  const Jet jet = at_pole(t);
  const double down = -slope(jet);
  if (!(down > relative_round_off * (r.norm() + size_) * (along_v ? length_u_ : length_v_)))
    return false;

  const double bend = along_v ? jet.u * jet.u + r * jet.uu : jet.v * jet.v + r * jet.vv;
  const double room = along_v ? range.high_u - range.low_u : range.high_v - range.low_v;
  for (double depth = bend * room > down ? down / bend : room; depth > relative_round_off; depth *= 0.5) {
    Foot next = foot;
    (along_v ? next.v : next.u) = t;
    (along_v ? next.u : next.v) += inwards * depth;
    next.jet = at(next.u, next.v);
    next.square = (next.jet.position - x).norm_square();
    if (next.square < foot.square) {
      foot = next;
      return true;
    }
  }
  return false;
}

/// Descends from `foot` to a minimum of the distance in the range of a cell.
CoonsPatch::Foot CoonsPatch::descend(const CoonsPoint &x, Foot foot, const Range &range) const {
  foot = newton(x, foot, range);
  for (unsigned int i = 0; i < 10 && leave_pole(x, range, foot); ++i)
    foot = newton(x, foot, range);
  return foot;
}

CoonsPatch::Foot CoonsPatch::foot(const CoonsPoint &x) const {
  const Range whole{0., 1., 0., 1.};
  const auto start = [&](const std::size_t cell, const double square) {
    const Range &range = cells_[cell].range;
    return Foot{0.5 * (range.low_u + range.high_u), 0.5 * (range.low_v + range.high_v), cells_[cell].middle,
                square};
  };
  std::array<double, max_cells * max_cells> squares; // squared distances to the middles
  const std::size_t n = balls_.size();
  double min_square = infinity;
  for (std::size_t cell = 0; cell < n; ++cell) {
    squares[cell] = (x - balls_[cell].centre).norm_square();
    min_square = std::min(min_square, squares[cell]);
  }
  // If x is not a number, no cell is nearest.
  const std::size_t found = std::find(squares.begin(), squares.begin() + n, min_square) - squares.begin();
  const std::size_t nearest = found < n ? found : 0;
  Foot best = descend(x, start(nearest, min_square), whole);

  double distance = std::sqrt(best.square);
  const auto may_be_nearer = [&](const std::size_t cell) {
    const double than = distance - not_nearer * (distance + size_), reach = than + balls_[cell].radius;
    return squares[cell] < reach * reach &&
           this->may_be_nearer(cell, x - balls_[cell].centre, squares[cell], than);
  };
  const auto index = [](const double u, const unsigned int n) {
    return std::min(static_cast<unsigned int>(u * n), n - 1);
  };
  const unsigned int i = index(best.u, n_u_), j = index(best.v, n_v_);
  Block block{i, i, j, j};
  for (std::size_t cell = 0; cell < n; ++cell)
    if (may_be_nearer(cell))
      block.add(static_cast<unsigned int>(cell) / n_v_, static_cast<unsigned int>(cell) % n_v_);
  if (is_nearest(best, x, block))
    return best;

  for (std::size_t cell = 0; cell < n; ++cell)
    if (may_be_nearer(cell)) {
      const Foot candidate = descend(x, start(cell, squares[cell]), cells_[cell].range);
      const double lowest = distance - not_nearer * (distance + size_);
      if (lowest > 0. && candidate.square < lowest * lowest) {
        best = descend(x, candidate, whole);
        distance = std::sqrt(best.square);
      }
    }
  return best;
}

/// Returns W (I + gap W)⁻¹ with the shape operator W = ∂n/∂X on the tangent plane. From the second
/// fundamental form b_αβ = n·X_αβ and X_α = e_k J_kα with orthonormal e_k, W = −J⁻ᵀ b J⁻¹.
Tensor<2, 3> CoonsPatch::turning(const Foot &foot, const CoonsPoint &normal, const double gap) const {
  Jet jet = foot.jet;
  // Where the parameters degenerate, W is taken at a point slightly inside.
  if (dealii::cross_product_3d(jet.u, jet.v).norm() < 1e-4 * length_u_ * length_v_)
    jet = at(foot.u + 2e-4 * (0.5 - foot.u), foot.v + 2e-4 * (0.5 - foot.v));
  CoonsPoint e = jet.u - (jet.u * normal) * normal;
  e /= e.norm();
  const CoonsPoint f = dealii::cross_product_3d(normal, e);
  const double ue = jet.u * e, ve = jet.v * e, vf = jet.v * f;
  // J⁻¹ = (1/ue, −ve/(ue vf); 0, 1/vf)
  const double a = 1. / ue, b = -ve / (ue * vf), c = 1. / vf;
  const double b_uu = normal * jet.uu, b_uv = normal * jet.uv, b_vv = normal * jet.vv;
  const double w_ee = -a * a * b_uu, w_ef = -a * (b * b_uu + c * b_uv),
               w_ff = -(b * b * b_uu + 2. * b * c * b_uv + c * c * b_vv);
  // W = mean I + D with D² = half² I and principal curvatures mean ± half, so W (I + gap W)⁻¹ has
  // the same form. Its mean is that of the curvatures after turned(); D is scaled by the ratio of
  // their differences.
  const double mean = 0.5 * (w_ee + w_ff), half = std::hypot(0.5 * (w_ee - w_ff), w_ef);
  const double high = turned(mean + half, gap), low = turned(mean - half, gap);
  const double part_high = 1. + gap * (mean + half), part_low = 1. + gap * (mean - half);
  // Their difference is 2 half/((1 + κ_high gap)(1 + κ_low gap)), except in a centre of curvature.
  const bool is_centre = high == 0. || low == 0.;
  const double ratio = !is_centre ? 1. / (part_high * part_low) : half > 0. ? 0.5 * (high - low) / half : 0.;
  const double sum = 0.5 * (high + low), across = ratio * 0.5 * (w_ee - w_ff);
  return (sum + across) * dealii::outer_product(e, e) + (sum - across) * dealii::outer_product(f, f) +
         ratio * w_ef * (dealii::outer_product(e, f) + dealii::outer_product(f, e));
}

ClosestPoint CoonsPatch::closest_point(const CoonsPoint &x) const {
  const Foot nearest = foot(x);
  ClosestPoint result;
  result.position = nearest.jet.position;
  result.normal = normal(nearest.jet, nearest.u, nearest.v);
  const CoonsPoint arm = x - result.position;
  result.gap = arm * result.normal;
  result.turning = turning(nearest, result.normal, result.gap);
  const bool is_on_edge = nearest.u == 0. || nearest.u == 1. || nearest.v == 0. || nearest.v == 1.;
  result.is_beyond_edge = is_on_edge && (arm - result.gap * result.normal).norm() >
                                            straight_above * size_ + 10. * relative_round_off * arm.norm();
  return result;
}

} // namespace billet
