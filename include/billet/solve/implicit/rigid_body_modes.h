// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_RIGID_BODY_MODES_H
#define BILLET_SOLVE_IMPLICIT_RIGID_BODY_MODES_H

#include "billet/solve/implicit/implicit_problem.h"

#include <optional>
#include <string>
#include <vector>

namespace billet {

/// Rigid-body modes of the bodies of a static scene: whether supports and contact resist them at the end of a
/// step. Bodies that contact lets go are stabilised; a step that loses a body otherwise fails.
class RigidBodyModes {
public:
  /// Prepares the problem's stabilisation, too. Collective.
  explicit RigidBodyModes(ImplicitProblem &problem);

  /// Whether a body loses its support, or bodies move too far. Throws SolutionFailure, on all ranks, where
  /// the time at which a body is lost is known well enough. Collective.
  bool rejects(double t, NewtonReport &report);
  /// Accepts the step: books the work of the stabilisation. Collective.
  void commit();
  /// After a resumption with other contacts: finds what resists now. Collective.
  void begin();

  /// Of a failed step: bodies that slid on all that they touched at the end of the last one.
  std::string describe_sliding() const;
  /// Of a step that failed for this reason: the loss of a body for which one that went further failed, if it
  /// did; else an empty text.
  std::string describe_loss(const std::string &failure) const;
  /// Messages about stabilised bodies at the end of the run. Collective.
  DiagnosticList finish(double largest_energy) const;

  void save(StateWriter &writer) const;
  void load(StateReader &reader, bool is_exact);

private:
  struct Limits {
    /// Part of the largest step below which the time of a loss is known well enough.
    static constexpr double short_step = 1e-3;
    /// Parts of the largest forces so far: that contact bears on a body that it lets go, and on one that it
    /// touches without a force.
    static constexpr double little = 0.01, unloaded = 1e-5;
  };
  struct Loss {
    double time = -1.;
    std::string text;
  };
  /// Fails the step that loses this mode.
  bool lose(const RigidBodySupport::Mode &mode, double t, NewtonReport &report);
  /// What holds the bodies beside contact, at the trial state.
  RigidBodySupport hold_bodies() const;
  /// The same with contact. Collective.
  RigidBodySupport::Result find_support(const std::vector<bool> &unloaded_bodies = {}) const;
  template <class AddContact> void add_supporting_points(const AddContact &add) const;
  void add_supports(RigidBodySupport &support) const;
  /// What supports and contact resist at the trial state, contact of stabilised bodies in one sense only.
  RigidBodySupport::Result find_support_by_contact() const;
  /// A mode that only points resist which slip, or nearly do. Collective.
  std::optional<RigidBodySupport::Mode> find_sliding_soon() const;
  /// Σ |f| of the nodes of contacts, by body [force]. Collective.
  std::vector<double> contact_forces_on_bodies() const;
  /// A body that is free to move so is held by viscous forces from now on if contact bore next to nothing at
  /// the end of the last step. Returns whether it is.
  bool hold_if_let_go(const RigidBodySupport::Mode &mode);
  /// The same with bodies that others touch without a force, at the end of this step. Collective.
  void hold_unloaded_bodies();
  void report_let_go(double t, NewtonReport &report);

  ImplicitProblem &problem_;
  RigidBodies bodies_;
  std::vector<double> forces_n_, largest_forces_; ///< on bodies at the end of the last step; so far
  Loss loss_; ///< the earliest of a body that a step failed for; explains what steps before it fail for
  std::vector<RigidBodySupport::Mode> let_go_;  ///< bodies that this step has begun to hold
  RigidBodySupport::Result support_;            ///< at the end of the last accepted step
  RigidBodySupport::Result support_by_contact_; ///< the same, while bodies are stabilised
};

} // namespace billet

#endif
