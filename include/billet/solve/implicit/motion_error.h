// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_MOTION_ERROR_H
#define BILLET_SOLVE_IMPLICIT_MOTION_ERROR_H

#include "billet/forces/inertia.h"
#include "billet/scene/scene.h"
#include "billet/state.h"
#include "billet/usage.h"

#include <vector>

namespace billet {

/// Error of the time integration of a step, root mean square over the mass, over the allowed error.
class MotionError {
public:
  /// `lumped`: row sums of the mass. Collective.
  MotionError(const Scene &scene, const Discretization &discretization, const LocalNodes &nodes,
              const Inertia &inertia, const Vector &lumped);

  bool is_wanted() const { return parameters_.error_tolerance > 0.; }
  /// Returns the factor of the tolerances of iterations. If the scene requires smaller errors of
  /// steps than the default, the iterations' errors must be smaller, too.
  double wanted_accuracy() const;
  /// Returns the error that is `factor` times `change`, at these displacements, over the allowed
  /// one. Collective.
  double of_step(double factor, const Vector &change, const Vector &displacements) const;
  /// Accepts these displacements. Collective.
  void commit(const Vector &displacements);

  void save(StateWriter &writer) const { writer.write("largest displacement", {max_displacement_}); }
  void load(const StateReader &reader) { max_displacement_ = reader.number("largest displacement"); }

private:
  struct Limits {
    static constexpr double default_tolerance = 1e-3;
    /// Minimum displacement to resolve, as part of the scene's radius: at the start nothing has
    /// moved yet.
    static constexpr double min_displacement = 1e-6;
  };
  struct BodyAxis {
    std::size_t body;
    unsigned int axis;
  };
  /// Spread of a field in a body about its mean over the mass.
  struct Spread {
    double square; ///< Σ m x²
    double mass;
  };
  std::vector<Spread> spread_of_bodies(const Vector &field) const;
  double mean_size(const Vector &field) const;
  /// Returns the reference of the error tolerance, (I7): the displacements, root mean square over
  /// the mass. The common motion of bodies counts up to the largest radius of gyration: a long
  /// flight does not enlarge the impact at its end.
  double displacement_to_resolve(const Vector &displacements) const;

  const Discretization &discretization_;
  const parameters::ImplicitDynamics &parameters_;
  const Inertia &inertia_;
  const Vector &lumped_;
  std::vector<BodyAxis> body_axes_; ///< of owned dofs
  double max_displacement_ = 0., max_gyration_ = 0.;
  HeldMemory memory_{Capability::error_control};
};

} // namespace billet

#endif
