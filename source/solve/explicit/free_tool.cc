// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/free_tool.h"

#include "billet/solve/restart.h"

namespace billet {

FreeTool::FreeTool(const Tool &tool, const parameters::Motion &motion)
    : tool_(tool), inertia_(motion.inertia), rate_(motion.initial_rate), rate_before_(rate_),
      before_(tool.placement(0.)), now_(before_) {}

double FreeTool::resistance(const ContactLoad &load) const {
  switch (tool_.control()) {
  case Tool::Control::moment:
    return load.moment * tool_.rotation_axis();
  case Tool::Control::force:
  case Tool::Control::stop:
    return load.force * tool_.force_direction();
  case Tool::Control::motion:
    break;
  }
  return 0.; // nothing resists a prescribed motion
}

void FreeTool::kick(const double t, const ContactLoad &load, const double step_before, const double step,
                    const bool is_first) {
  if (tool_.control() == Tool::Control::stop)
    has_stopped_ = has_stopped_ || resistance(load) >= tool_.load(t);
  if (!tool_.is_driven() || is_removed_)
    return;
  load_ = tool_.load(t);
  const double acceleration = (load_ - resistance(load)) / inertia_;
  rate_before_ = is_first ? rate_ - 0.5 * step * acceleration : rate_;
  rate_ = rate_before_ + 0.5 * (is_first ? 2. * step : step_before + step) * acceleration;
}

void FreeTool::move(const double t, const double dt) {
  before_ = now_;
  offset_before_ = offset_;
  if (has_stopped_ || is_removed_)
    return;
  if (tool_.is_driven())
    offset_ += dt * rate_;
  now_ = tool_.placement(t + dt, offset_);
}

void FreeTool::remove() {
  is_removed_ = true;
  rate_ = rate_before_ = load_ = 0.;
}

dealii::Tensor<1, 3> FreeTool::momentum() const {
  switch (tool_.control()) {
  case Tool::Control::force:
    return 0.5 * inertia_ * (rate_before_ + rate_) * tool_.force_direction();
  case Tool::Control::moment:
  case Tool::Control::stop:
  case Tool::Control::motion:
    break;
  }
  return {}; // it has no inertia, or turns about its axis
}

dealii::Tensor<1, 3> FreeTool::angular_momentum() const {
  if (tool_.control() == Tool::Control::moment)
    return 0.5 * inertia_ * (rate_before_ + rate_) * tool_.rotation_axis();
  return dealii::cross_product_3d(now_.moved_centre(), momentum());
}

double FreeTool::motion_work(const ContactLoad &local) const {
  // The offset's share is work between tool and bodies, which the tool's kinetic energy contains.
  const double turn = now_.rotation_angle - before_.rotation_angle;
  double work =
      local.force * (now_.translation - before_.translation) + local.moment * tool_.rotation_axis() * turn;
  if (tool_.is_driven())
    work -= resistance(local) * (offset_ - offset_before_);
  return 0.5 * work;
}

void FreeTool::save(StateWriter &writer) const {
  writer.write("offset", {offset_before_, offset_ - offset_before_});
  writer.write("flags", {has_stopped_ ? 1. : 0., is_removed_ ? 1. : 0.});
  writer.write("placement", to_numbers(before_));
  writer.write("placement now", to_numbers(now_));
  writer.write("free", {offset_, offset_before_, rate_, rate_before_, load_});
  if (inertia_ > 0.)
    writer.write("rate", {0.5 * (rate_ + rate_before_)}); // at the placement
}

void FreeTool::load(const StateReader &reader, const bool is_exact) {
  const std::vector<double> flags = reader.read("flags", 2);
  has_stopped_ = flags.at(0) != 0.;
  is_removed_ = flags.at(1) != 0.;
  offset_ = offset_before_ = reader.read("offset", 2).at(0);
  before_ = now_ = to_placement(reader.read("placement"));
  if (is_removed_)
    rate_ = rate_before_ = 0.;
  else if (inertia_ > 0. && reader.has("rate"))
    rate_ = rate_before_ = reader.number("rate");
  if (!is_exact)
    return;
  now_ = to_placement(reader.read("placement now"));
  const std::vector<double> free = reader.read("free", 5);
  offset_ = free.at(0);
  offset_before_ = free.at(1);
  rate_ = free.at(2);
  rate_before_ = free.at(3);
  load_ = free.at(4);
}

} // namespace billet
