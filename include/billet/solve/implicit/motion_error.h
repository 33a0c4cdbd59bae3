// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_MOTION_ERROR_H
#define BILLET_SOLVE_IMPLICIT_MOTION_ERROR_H

#include "billet/forces/inertia.h"
#include "billet/scene/scene.h"
#include "billet/state.h"
#include "billet/usage.h"

#include <vector>

namespace billet {

/// Error of the time integration of a step, root mean square over the mass, as part of what is allowed.
class MotionError {
public:
  /// `lumped`: row sums of the mass. Collective.
  MotionError(const Scene &scene, const Discretization &discretization, const LocalNodes &nodes,
              const Inertia &inertia, const Vector &lumped);

  bool is_wanted() const { return parameters_.error_tolerance > 0.; }
  /// Factor of the tolerances of iterations: where the user wants smaller errors of steps than by default
  /// what iterations leave must not be as large as these.
  double wanted_accuracy() const;
  /// Of an error that is this factor times `change`, at these displacements. Collective.
  double of_step(double factor, const Vector &change, const Vector &displacements) const;
  /// Accepts these displacements. Collective.
  void commit(const Vector &displacements);

  void save(StateWriter &writer) const { writer.write("largest displacement", {largest_displacement_}); }
  void load(const StateReader &reader) { largest_displacement_ = reader.number("largest displacement"); }

private:
  struct Limits {
    static constexpr double default_tolerance = 1e-3;
    /// Least displacement to resolve, of the scene's radius: at the start nothing has moved yet.
    static constexpr double min_displacement = 1e-6;
  };
  struct BodyAxis {
    std::size_t body;
    unsigned int axis;
  };
  /// Of a body, about the mean of the field over its mass.
  struct Spread {
    double square; ///< Σ m x²
    double mass;
  };
  std::vector<Spread> spread_of_bodies(const Vector &field) const;
  double mean_size(const Vector &field) const;
  /// What the error tolerance is a part of, (I7): the displacements, root mean square over the mass. How far
  /// bodies have gone together counts up to the largest one's radius of gyration: a long flight makes the
  /// impact at its end no larger.
  double displacement_to_resolve(const Vector &displacements) const;

  const Discretization &discretization_;
  const parameters::ImplicitDynamics &parameters_;
  const Inertia &inertia_;
  const Vector &lumped_;
  std::vector<BodyAxis> body_axes_; ///< of owned dofs
  double largest_displacement_ = 0., largest_gyration_ = 0.;
  HeldMemory memory_{Capability::error_control};
};

} // namespace billet

#endif
