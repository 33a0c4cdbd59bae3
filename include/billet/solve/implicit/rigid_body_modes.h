// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_RIGID_BODY_MODES_H
#define BILLET_SOLVE_IMPLICIT_RIGID_BODY_MODES_H

#include "billet/solve/implicit/implicit_problem.h"

#include <optional>
#include <string>
#include <vector>

namespace billet {

/// Rigid-body modes of the bodies of a static scene: whether supports and contact resist them at
/// the end of a step. Bodies that lose contact without a force are stabilised; any other loss of
/// support fails the step.
class RigidBodyModes {
public:
  /// Prepares the problem's stabilisation as well. Collective.
  explicit RigidBodyModes(ImplicitProblem &problem);

  /// Returns a failure if a body loses its support, or bodies move too far. Throws SolutionFailure,
  /// on all ranks, if the time of the loss is known accurately enough. Collective.
  std::optional<StepFailure> judge(double t, DiagnosticList &messages);
  /// Accepts the step: records the work of the stabilisation. Collective.
  void commit();
  /// Finds the support after a restart with other contacts. Collective.
  void begin();
  /// Follows supports and springs that begin or end at t, the end of the last step. Collective.
  void follow_supports(double t);

  /// Returns a text about the body that slid on all its contacts at the end of the last step, for a
  /// failed step.
  Explanation describe_sliding() const;
  /// Returns the same if that body would slide at the failed trial state, too. Collective.
  Explanation explain_sliding() const;
  /// Returns a text about the loss of a body for which a longer step failed; empty if there was
  /// none, or `failure` is this loss.
  Explanation describe_loss(const std::string &failure) const;
  /// Returns messages about stabilised bodies at the end of the run. Collective.
  DiagnosticList finish(double max_energy) const;

  void save(StateWriter &writer) const;
  void load(StateReader &reader, bool is_exact);

private:
  struct Limits {
    /// Part of the largest step below which the time of a loss is known accurately enough.
    static constexpr double short_step = 1e-3;
    /// Parts of the largest forces so far below which contact has lost a body, and below which it
    /// touches a body without a force.
    static constexpr double little = 0.01, unloaded = 1e-5;
  };
  void find_bodies(double t);
  struct Loss {
    double time = -1.;
    Explanation why;
  };
  /// Returns the failure of a step that loses this mode. Throws SolutionFailure as judge() does.
  StepFailure lose(const RigidBodySupport::Mode &mode, double t);
  /// Returns the supports of the bodies except contact, at the trial state.
  RigidBodySupport hold_bodies() const;
  /// Finds the modes with contact. Collective.
  RigidBodySupport::Result find_support(const std::vector<bool> &unloaded_bodies = {}) const;
  template <class AddContact> void add_supporting_points(const AddContact &add) const;
  void add_supports(RigidBodySupport &support) const;
  /// Finds the modes that supports and contact resist at the trial state. Contact of stabilised
  /// bodies resists in one direction only.
  RigidBodySupport::Result find_support_by_contact() const;
  /// Finds a mode that only points resist which slip, or nearly do. Collective.
  std::optional<RigidBodySupport::Mode> find_sliding_soon() const;
  /// Returns a text about the friction of the contacts of a body: "contact pair 'a' bears ...". Of
  /// pairs without friction or pressure it says nothing.
  std::string describe_friction(std::size_t body, const std::vector<FrictionUse> &uses) const;
  /// Σ |f| of the nodes of contacts, by body [force]. Collective.
  std::vector<double> contact_forces_on_bodies() const;
  /// Stabilises the free body of this mode from now on, if contact bore next to no force at the end
  /// of the last step. Returns whether the body is stabilised.
  bool hold_if_let_go(const RigidBodySupport::Mode &mode);
  /// Does the same for bodies that others touch without a force, at the end of this step.
  /// Collective.
  void hold_unloaded_bodies();
  void report_let_go(double t, DiagnosticList &messages);

  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();
  bool may_change_; ///< whether supports or springs begin or end
  RigidBodies bodies_;
  /// Forces on bodies at the end of the last step; maxima so far.
  std::vector<double> forces_n_, max_forces_;
  std::vector<FrictionUse> friction_n_; ///< of the contacts at the end of the last step
  Loss loss_; ///< earliest loss for which a step failed; it explains failures of earlier steps
  /// Modes of bodies that this step has begun to stabilise.
  std::vector<RigidBodySupport::Mode> let_go_;
  RigidBodySupport::Result support_;            ///< at the end of the last accepted step
  RigidBodySupport::Result support_by_contact_; ///< the same, while bodies are stabilised
};

} // namespace billet

#endif
