// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_BODY_STABILISATION_H
#define BILLET_SOLVE_IMPLICIT_BODY_STABILISATION_H

#include "billet/discretization/supports.h"
#include "billet/solve/contact_stabilisation.h"
#include "billet/solve/implicit/step_state.h"
#include "billet/solve/rigid_body_support.h"
#include "billet/state.h"

#include <memory>
#include <vector>

namespace billet {

/// Centres and sizes of the undeformed bodies of a static scene, and the nodes that supports and
/// springs constrain.
struct RigidBodies {
  using LoadFilter = std::function<bool(const LoadTimes &)>;

  /// For the supports that `acts`, and the springs that `springs_act` chooses. Collective.
  RigidBodies(const Scene &scene, const Discretization &discretization, const ConstraintFilter &acts,
              const LoadFilter &springs_act);

  /// Whether supports alone resist all rigid-body modes; then the other members are empty.
  bool are_held() const { return frames.empty(); }

  struct SupportedNode {
    std::size_t body;
    dealii::Tensor<1, 3> position, normal; ///< undeformed
    std::array<DofIndex, 3> dofs;
  };
  std::vector<RigidBodySupport::Body> frames;
  std::vector<SupportedNode> supported_nodes; ///< on this rank
};

/// State of the bodies at the end of a run.
struct FinalState {
  double time;
  double max_energy; ///< largest energy of the run
  double forces;     ///< larger norm of the internal and the contact forces of all nodes [force]
  std::vector<double> forces_on_bodies; ///< the same of the nodes of each body [force]
  const RigidBodySupport::Result &support_by_contact;
};

/// Viscous forces that stabilise bodies of static scenes until contact supports them; see
/// ContactStabilisation.
class BodyStabilisation {
public:
  BodyStabilisation(const Scene &scene, const Discretization &discretization)
      : scene_(scene), discretization_(discretization) {}
  /// Prepares the forces for bodies that supports do not hold. Collective.
  void prepare(const RigidBodies &bodies);

  /// Returns the forces; null if supports hold all bodies.
  const ContactStabilisation *get() const { return stabilisation_.get(); }
  bool acts() const { return stabilisation_ != nullptr && stabilisation_->acts(); }
  bool acts_on(const std::size_t body) const {
    return stabilisation_ != nullptr && stabilisation_->acts_on(body);
  }
  void hold(const std::size_t body) { stabilisation_->hold(body); }

  void start_step(double duration);
  /// Adds the forces to the residual. Returns their reference value for residuals [force].
  /// Collective.
  double add_forces(const StepState &step, Vector &residual) const;
  void add_tangent(const TangentSystem &system) const;
  /// Returns the drifts of the bodies before the step, and their mean displacements in it, for
  /// RigidBodySupport::weigh_translations(). Only if the forces act. Collective.
  std::vector<std::vector<dealii::Tensor<1, 3>>> translations(const StepState &step) const;
  /// Accepts the step: fades the forces on bodies that are not free, and adds drifts. Returns the
  /// work of the forces. Collective.
  double commit(const StepState &step, const RigidBodySupport::Result &support_by_contact,
                double driven_work);

  /// Returns messages before the run about bodies that need no stabilisation.
  DiagnosticList check_needless() const;
  /// Returns messages at the end of the run. Collective.
  DiagnosticList finish(const FinalState &state) const;

  void save(StateWriter &writer) const;
  void load(StateReader &reader);

private:
  struct Limits {
    /// Maximum drift of a body that contact leaves free [size of the body].
    static constexpr double max_drift = 0.01;
    /// Component of its direction that is printed as zero.
    static constexpr double no_component = 0.01;
  };
  std::vector<ContactStabilisation::Motion> motions(const StepState &step) const;
  /// Appends messages about a body that contact leaves free at the end. Collective.
  void judge_free_body(std::size_t body, const FinalState &state, DiagnosticList &messages) const;

  const Scene &scene_;
  const Discretization &discretization_;
  std::unique_ptr<ContactStabilisation> stabilisation_;
  std::vector<double> sizes_;     ///< of bodies, their longest extents [length]
  std::vector<bool> is_needless_; ///< of bodies that supports hold; or empty
};

} // namespace billet

#endif
