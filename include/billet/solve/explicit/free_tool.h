// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_FREE_TOOL_H
#define BILLET_SOLVE_EXPLICIT_FREE_TOOL_H

#include "billet/contact/contact_load.h"
#include "billet/scene/scene.h"
#include "billet/state.h"

namespace billet {

/// A tool in an explicit scene. One with a force or moment has a mass, or moment of inertia, m, and moves on
/// from where its prescribed motion takes it by an offset s along its direction, or about its axis,
///   m s̈ = load − what the bodies resist with,
/// by the same central differences as the nodes.
class FreeTool {
public:
  FreeTool(const Tool &tool, const parameters::Motion &motion);

  const Placement &before() const { return before_; } ///< at the start of the step that ends now
  const Placement &now() const { return now_; }
  bool is_gone(const double t) const { return t >= tool_.removal_time(); }
  /// Whether kick() has to know the contact forces of all ranks.
  bool wants_load() const { return tool_.control() != Tool::Control::motion; }
  /// Whether it starts with a speed, or goes somewhere within this time from the start on.
  bool moves(const double within) const {
    const Placement start = tool_.placement(0.), then = tool_.placement(within);
    return rate_ != 0. || start.translation != then.translation ||
           start.rotation_angle != then.rotation_angle;
  }
  /// 1/m; 0 of a tool that moves as told, or is gone.
  double inverse_inertia() const { return tool_.is_driven() && !is_removed_ ? 1. / inertia_ : 0.; }

  /// The offset's rate after the kick at time t, which lasts from half a step before to half a step after it.
  /// In the first kick of a run, from rest to half a step. `load` is what the tool does to the bodies. A tool
  /// that presses with its stop force stops for good.
  void kick(double t, const ContactLoad &load, double step_before, double step, bool is_first);
  /// Moves on to t + dt.
  void move(double t, double dt);

  /// Taken away, with its mass: from now on it neither moves nor counts.
  void remove();

  double kinetic_energy() const { return 0.5 * inertia_ * rate_before_ * rate_; }
  /// Of a tool that turns none: its axis is held.
  dealii::Tensor<1, 3> momentum() const;
  /// About the origin, as if the mass were at the centre of rotation. 0 of a tool that only moves as told.
  dealii::Tensor<1, 3> angular_momentum() const;
  /// Works on the scene in one half of the step from before() to now(), with the loads at one of its ends: by
  /// the prescribed motion, against `local`, ...
  double motion_work(const ContactLoad &local) const;
  /// ... and by the load of the last kick, on all ranks the same.
  double load_work() const { return 0.5 * load_ * (offset_ - offset_before_); }

  /// Into the group of a tool at hand.
  void save(StateWriter &writer) const;
  /// `is_exact`: of the same method; else what a tool at rest has.
  void load(const StateReader &reader, bool is_exact);
  /// Of a tool that is new at time t.
  void begin(const double t) { before_ = now_ = tool_.placement(t); }

private:
  /// Of the bodies against the offset.
  double resistance(const ContactLoad &load) const;

  const Tool &tool_;
  double inertia_, rate_, rate_before_;
  double offset_ = 0., offset_before_ = 0.;
  double load_ = 0.; ///< at the last kick
  bool has_stopped_ = false, is_removed_ = false;
  Placement before_, now_;
};

} // namespace billet

#endif
