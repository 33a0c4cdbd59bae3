// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/tool_friction.h"

#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

constexpr std::size_t friction_row_width = FrictionHistory::width + 3; // of a node

} // namespace

ToolFriction::ToolFriction(const FrictionLaw &law, const bool stores, const std::size_t n_nodes,
                           const ToolStep &step, const PressureRecord &pressures)
    : law_(law), stores_(stores), step_(step), pressures_(pressures), n_(n_nodes), now_(n_nodes) {
  memory_.set(size());
}

template <bool is_exact>
void ToolFriction::press(const std::size_t i, const ContactPoint &node, const FrictionTangent &kind,
                         const EdgeFading *fading, ToolContactState &state, History &history) const {
  const History &history_n = n_[i];
  history.frame =
      history_n.is_active
          ? history_n.frame.transported(
                step_.placement.rotation * dealii::transpose(step_.placement_n.rotation), state.normal)
          : Frame::from_normal(state.normal);
  const Frame &Z = history.frame;
  const std::array<Tensor<1, 3>, 3> axes{Z.q, Z.r, Z.n};

  // Displacement over the step relative to the tool's material point that was at the node (eq.
  // (33), with the tool's motion).
  const Tensor<1, 3> displacement = state.position - step_.placement.to_space(history_n.tool_position);
  TangentialIncrement increment{{displacement * Z.q, displacement * Z.r}};
  increment.per_time = step_.duration > 0. ? 1. / step_.duration : 0.;
  increment.rate = history_n.slip_rate;

  // A node that enters within the step has slid along the tool only for the part φ = g/(g − g_n) of
  // it.
  ContactStiffness stiffness = node.stiffness;
  stiffness.normal = state.share * node.spring().secant(std::max(-state.gap, 0.));
  double fraction = 1., relative_slope = 0.; // (∂φ/∂g)/φ
  if (!history_n.is_active && node.gap_n > node.touching_gap && state.gap < 0.) {
    fraction = state.gap / (state.gap - node.gap_n);
    stiffness.tangential *= fraction;
    relative_slope = node.gap_n / (state.gap * (node.gap_n - state.gap));
  }
  // The frame rotates with the normal, δn = H δx:
  //   δΔg_q = q·δx − (Δ·n) q·Hδx + Δg_r spin·Hδx,  δΔg_r = r·δx − (Δ·n) r·Hδx − Δg_q spin·Hδx.
  const Tensor<1, 3> Hq = state.turning * Z.q, Hr = state.turning * Z.r, Hs = state.turning * Z.spin;
  if constexpr (is_exact) {
    const double along = displacement * Z.n;
    const std::array<Tensor<1, 3>, 2> gradient{
        Z.q - along * Hq + increment.value[1] * Hs + increment.value[0] * relative_slope * Z.n,
        Z.r - along * Hr - increment.value[0] * Hs + increment.value[1] * relative_slope * Z.n};
    for (unsigned int a = 0; a < 2; ++a)
      for (unsigned int j = 0; j < 3; ++j)
        increment.gradient[a][j] = gradient[a] * axes[j];
  }
  const FrameTraction t = compute_traction(law_, stiffness, kind, state.gap,
                                           base_.empty() ? history_n.tangential : base_[i], increment);

  state.status = t.status;
  state.pressure = t.pressure;
  state.traction = t.tangential[0] * Z.q + t.tangential[1] * Z.r + t.pressure * Z.n;
  for (unsigned int a = 0; a < 3; ++a)
    for (unsigned int j = 0; j < 3; ++j)
      state.tangent += t.tangent[a][j] * dealii::outer_product(axes[a], axes[j]);
  if constexpr (is_exact) // −(t_q δq + t_r δr + p δn)
    state.tangent += dealii::outer_product(Z.n, t.tangential[0] * Hq + t.tangential[1] * Hr) -
                     dealii::outer_product(t.tangential[0] * Z.r - t.tangential[1] * Z.q, Hs) -
                     t.pressure * state.turning;
  if (fading)
    state.tangent -=
        dealii::outer_product(t.pressure_slope[0] * Z.q + t.pressure_slope[1] * Z.r, fading->pressure_slope);

  history.is_active = true;
  history.tangential = t.tangential;
  state.slip_increment = fraction * std::hypot(t.slip[0], t.slip[1]);
  state.tangential_energy = 0.5 * (t.tangential[0] * t.tangential[0] + t.tangential[1] * t.tangential[1]) /
                            node.stiffness.tangential;
  double limit_n = 0.;
  if (pressures_.is_known() && state.slip_increment > 0. && t.pressure > 0.)
    limit_n = std::hypot(t.tangential[0], t.tangential[1]) * pressures_[i].pressure / t.pressure;
  state.friction = compute_friction_account(
      {history_n.tangential, t.tangential, increment.value, true, fraction, limit_n}, rule_of(node));
  history.slip = history_n.slip + state.slip_increment;
  history.slip_rate =
      increment.per_time > 0. ? state.slip_increment * increment.per_time : history_n.slip_rate;
}

template void ToolFriction::press<false>(std::size_t, const ContactPoint &, const FrictionTangent &,
                                         const EdgeFading *, ToolContactState &, History &) const;
template void ToolFriction::press<true>(std::size_t, const ContactPoint &, const FrictionTangent &,
                                        const EdgeFading *, ToolContactState &, History &) const;

void ToolFriction::release(const std::size_t i, const ContactPoint &node, const Tensor<1, 3> &normal,
                           ToolContactState &state, History &history) const {
  const History &history_n = n_[i];
  if (history_n.is_active) { // its spring is released
    state.normal = step_.placement.rotation * normal;
    const auto along = [&](const Tensor<1, 3> &axis) {
      return (step_.placement.rotation * (dealii::transpose(step_.placement_n.rotation) * axis)) *
             (state.position - step_.placement.to_space(history_n.tool_position));
    };
    const double part = !pressures_.is_known()
                            ? 1.
                            : part_before_leaving(pressures_[i].penetration, along(history_n.frame.n));
    state.friction = compute_friction_account(
        {history_n.tangential, {}, {along(history_n.frame.q), along(history_n.frame.r)}, false, part},
        rule_of(node));
  }
  history.is_active = false;
  history.tangential = {};
  history.slip = history_n.slip;
  history.slip_rate = 0.;
}

double ToolFriction::elastic_slip(const std::size_t i, const ContactPoint &node,
                                  const ToolContactState &state) const {
  if (!(state.pressure > 0.) || state.status != ContactStatus::stick || !n_[i].is_active || node.is_fixed)
    return 0.;
  const auto &from = base_.empty() ? n_[i].tangential : base_[i];
  return std::hypot(now_[i].tangential[0] - from[0], now_[i].tangential[1] - from[1]) /
         node.stiffness.tangential;
}

void ToolFriction::augment(const std::vector<ContactPoint> &nodes) {
  base_.clear();
  for (std::size_t i = 0; i < now_.size(); ++i)
    base_.push_back(n_[i].is_active && !nodes[i].is_fixed ? now_[i].tangential : n_[i].tangential);
}

void ToolFriction::clear() {
  for (auto &history : now_)
    history = History();
  n_ = now_;
}

void ToolFriction::start(const std::size_t i, const Tensor<1, 3> &on_tool) {
  now_[i] = History();
  now_[i].tool_position = on_tool;
}

void ToolFriction::save(StateWriter &writer, const SlaveSurface::Range &range) const {
  std::vector<double> rows;
  RowWriter row(rows);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    n_[i].save(row);
    row.vector(n_[i].tool_position);
  }
  range.write(writer, "friction", friction_row_width, rows);
}

void ToolFriction::load(const StateReader &reader, const SlaveSurface::Range &range) {
  if (!reader.has(range.prefix + "friction")) // a new friction law begins without traction
    return;
  range.read(reader, "friction", friction_row_width, [&](const std::size_t i, RowReader &row) {
    now_[i].load(row);
    row.vector(now_[i].tool_position);
  });
}

} // namespace billet
