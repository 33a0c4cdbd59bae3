// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/slave_friction.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

constexpr std::size_t friction_width = FrictionHistory::width + 1; // of a slave

} // namespace

SlaveFriction::SlaveFriction(const FrictionLaw &law, const TouchingSlaves &slaves,
                             const SlavePenalties &penalties, const GapOffsets &offsets,
                             const SlaveStart &start)
    : law_(law), slaves_(slaves), penalties_(penalties), offsets_(offsets), start_(start),
      history_n_(slaves.size()), history_(slaves.size()), base_(slaves.size()), works_(slaves.size()) {
  memory_.set(history_.size() * (3 * sizeof(SlaveHistory) + sizeof(FrictionWorks)));
}

void SlaveFriction::release(const std::size_t s) {
  history_[s] = SlaveHistory();
  history_[s].slip = history_n_[s].slip;
  if (history_n_[s].is_active)
    account_for(s, SlaveTraction(), slaves_.motion_after_contact(s));
  else
    works_[s] = FrictionWorks();
}

void SlaveFriction::account_for(const std::size_t s, const SlaveTraction &traction,
                                const SlaveMotion &motion) {
  const FrictionRule rule{penalties_[s].tangential, start_weight_, accounting_,
                          offsets_.augmentation.was_empty(), offsets_.augmentation.is_empty()};
  const SlaveStart::Pressure &pressed_n = start_.pressed(s);
  double part = 1.; // part of the step in contact
  if (history_[s].is_active && !history_n_[s].is_active)
    part =
        part_in_contact(slaves_[s].contact.gap + motion.multiplier_offset, slaves_[s].contact.normal, motion);
  else if (!history_[s].is_active)
    part = part_before_leaving(pressed_n.penetration,
                               motion.displacement * (motion.rotation * pressed_n.normal));
  double limit_n = 0.;
  if (history_[s].is_active && traction.slip > 0. && traction.pressure > 0.)
    limit_n = std::hypot(history_[s].tangential[0], history_[s].tangential[1]) * pressed_n.pressure /
              traction.pressure;
  const FrictionAccount account =
      compute_friction_account(history_n_[s], history_[s], motion, rule, part, limit_n);
  const double own = slaves_.own_part(s);
  FrictionWorks &works = works_[s];
  works.dissipation = own * account.dissipated(history_n_[s].area, history_[s].area);
  works.dissipation_handed_over =
      own * account.handed_over().dissipated(history_n_[s].area, history_[s].area);
  works.damping = own * history_[s].area * account.damping;
  works.taken_beyond = own * account.taken_beyond(history_n_[s].area, history_[s].area);
  works.missed = own * account.missed(history_n_[s].area);
}

bool SlaveFriction::was_touching(const std::size_t s) const {
  if (history_n_[s].is_active)
    return true;
  const SlaveState &state = slaves_[s];
  const SlaveMotion motion = slaves_.motion_of(s);
  return state.contact.gap + motion.multiplier_offset - motion.displacement * state.contact.normal <=
         motion.flush;
}

double SlaveFriction::elastic_slip(const std::size_t s) const {
  const SlaveState &state = slaves_[s];
  if (!state.has_pressure() || !was_touching(s) || state.traction.status != ContactStatus::stick)
    return 0.;
  return std::hypot(history_[s].tangential[0] - base_[s].tangential[0],
                    history_[s].tangential[1] - base_[s].tangential[1]) /
         penalties_[s].tangential;
}

void SlaveFriction::augment() {
  for (std::size_t s = 0; s < base_.size(); ++s)
    if (slaves_[s].presses() && was_touching(s))
      augment_one(s);
}

void SlaveFriction::augment_one(const std::size_t s) {
  SlaveHistory &base = base_[s];
  const SlaveHistory &now = history_[s];
  if (base.is_active) {
    base.tangential = now.tangential;
    return;
  }
  // The frame must not depend on the unknown normal, since from_normal() jumps.
  const Tensor<2, 3> rotation = slaves_.motion_of(s).rotation;
  base.is_active = true;
  base.frame = Frame::from_normal(dealii::transpose(rotation) * now.frame.n);
  const Frame frame = base.frame.transported(rotation, now.frame.n);
  const Tensor<1, 3> traction = now.tangential[0] * now.frame.q + now.tangential[1] * now.frame.r;
  base.tangential = {traction * frame.q, traction * frame.r};
}

void SlaveFriction::save(StateWriter &writer, const std::vector<std::uint64_t> &keys) const {
  std::vector<double> rows;
  RowWriter row(rows);
  for (const SlaveHistory &history : history_n_) {
    history.save(row);
    row.number(history.area);
  }
  writer.write_rows("friction", friction_width, keys, rows);
}

void SlaveFriction::load(const StateReader &reader, const std::vector<std::uint64_t> &keys) {
  if (!reader.has("friction")) // a new friction law begins without traction
    return;
  std::vector<bool> is_known; // slaves may be new if the pair had one pass before
  const std::vector<double> rows = reader.read_rows("friction", friction_width, keys, &is_known);
  for (std::size_t s = 0; s < history_n_.size(); ++s) {
    RowReader row(&rows[friction_width * s], friction_width);
    history_n_[s].load(row);
    history_n_[s].area = row.number();
  }
  base_ = history_ = history_n_;
}

} // namespace billet
