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

/// Centres and sizes of the undeformed bodies of a static scene, and the nodes that supports constrain.
struct RigidBodies {
  /// For the supports that `acts` chooses. Collective.
  RigidBodies(const Scene &scene, const Discretization &discretization, const HoldFilter &acts);

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
  /// Adds the forces to the residual. Returns their reference value for residuals [force]. Collective.
  double add_forces(const StepState &step, Vector &residual) const;
  void add_tangent(const TangentSystem &system) const;
  /// Accepts the step: fades the forces on bodies that are not free. Returns the work of the forces.
  /// Collective.
  double commit(const StepState &step, const std::vector<bool> &is_free, double driven_work);

  /// Returns messages before the run about bodies that need no stabilisation.
  DiagnosticList check_needless() const;
  /// Returns messages at the end of the run. `forces`: the largest norm of the nodal forces there.
  /// Collective.
  DiagnosticList finish(double time, double max_energy, double forces,
                        const RigidBodySupport::Result &support_by_contact) const;

  void save(StateWriter &writer) const;
  void load(StateReader &reader);

private:
  const Scene &scene_;
  const Discretization &discretization_;
  std::unique_ptr<ContactStabilisation> stabilisation_;
  std::vector<bool> is_needless_; ///< of bodies that supports hold; or empty
};

} // namespace billet

#endif
