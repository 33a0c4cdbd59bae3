// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_EXPLICIT_MOTION_H
#define BILLET_SOLVE_EXPLICIT_EXPLICIT_MOTION_H

#include "billet/discretization/prescribed_motion.h"
#include "billet/discretization/support_reactions.h"
#include "billet/solve/explicit/explicit_clock.h"
#include "billet/solve/explicit/nodal_masses.h"
#include "billet/solve/explicit/nodal_rows.h"
#include "billet/solve/restart.h"

#include <exception>
#include <optional>
#include <utility>
#include <vector>

namespace billet {

/// Displacements and velocities of the nodes of a rank, with the constraints of supports:
///   v_{n+½} = v_{n−½} + ½ (Δt_{n−1} + Δt_n) M⁻¹ F_n,   u_{n+1} = u_n + Δt_n v_{n+½}.
class ExplicitMotion {
public:
  ExplicitMotion(const Scene &scene, const LocalNodes &nodes);

  /// Sets the motion at time 0. Throws InputError if initial velocities or supports are not
  /// admissible. Collective.
  void begin(const Scene &scene);

  /// Returns the displacements at t_n [length].
  const NodalVectors &displacements() const { return u_; }
  /// Returns the velocities after kick(), v_{n+½}; before it, v_{n−½}, or v_0 at the start.
  const NodalVectors &velocities() const { return v_; }
  /// Returns v_{n−½}, after kick().
  const NodalVectors &velocities_before() const { return v_before_; }
  /// Returns the mean of both, after kick().
  NodalVectors mean_velocities() const;
  /// Returns the displacements at the start of the step that ends now and had the length `step`.
  NodalVectors displacements_before(double step) const;
  /// Returns the largest displacement of a node of this rank [length].
  double max_displacement() const;

  /// Returns the constrained nodes, and the forces of supports on them, the same on all their ranks
  /// [force]. Forces of other nodes are 0.
  const std::vector<unsigned int> &constrained_nodes() const { return held_.nodes(); }
  const NodalVectors &support_forces() const { return supports_; }

  /// Changes velocities by `forces`, which it sets to 0. The two nodes at one place of a prism, on
  /// the axis of a wedge, move as one. Each takes the part of their forces that its mass has of
  /// theirs. A failure of supports is reported at the next forces; see check().
  void kick(const ExplicitClock &clock, const NodalMasses &masses, NodalVectors &forces);
  /// Throws SolutionFailure if supports have failed on this rank in the last kick.
  void check() const {
    if (failure_)
      std::rethrow_exception(failure_);
  }
  void move(double step);
  /// Lets supports go and takes others as they are due at t, between steps; `t_forces`: time of the
  /// last kick. The reactions of those that let go fade from there on. Failures: as of kick().
  void switch_supports(double t_forces, double t);
  /// Returns the constraints that act.
  const ActingConstraints &acting() const { return held_.acting(); }
  /// Adds the fading forces of supports at t that this rank owns.
  void add_fading(double t, NodalVectors &forces) const;
  /// Adds the resultants of the same forces to those of supports, in the order of named_supports().
  void add_fading(double t, std::vector<Resultant> &of_supports) const;

  /// `step`: from the last forces to now.
  void save(StateWriter &writer, const NodalRows &rows, double step) const;
  void load(const StateReader &reader, const NodalRows &rows);
  /// Reads the displacements and, if there are some, the velocities of another method.
  void load_foreign(const StateReader &reader, const NodalRows &rows);
  /// Takes the supports that hold at t, after displacements are loaded. Collective.
  void load_supports(const StateReader &reader, const NodalRows &rows, double t);

private:
  /// Forces of supports that have let nodes of this rank go.
  struct Fading {
    FadeTimes times;
    std::optional<std::size_t> support; ///< index in named_supports(); none: of another scene
    std::vector<std::pair<unsigned int, dealii::Tensor<1, 3>>> forces;
  };
  void find_twins();
  /// Makes the reactions of supports that end forces that fade.
  void release_forces(double t_forces, const ConstraintFilter &acts);
  void save_supports(StateWriter &writer, const NodalRows &rows) const;

  const LocalNodes &nodes_;
  PrescribedMotion held_;
  NodalVectors u_, v_, v_before_;
  NodalVectors supports_;
  std::vector<std::pair<unsigned int, unsigned int>> twins_; ///< nodes of a prism at one place
  std::vector<Fading> fading_;
  std::exception_ptr failure_; ///< of this rank, in the last kick
};

} // namespace billet

#endif
