// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_UNBALANCED_BODIES_H
#define BILLET_SOLVE_UNBALANCED_BODIES_H

#include "billet/solve/solution.h"
#include "billet/state.h"

#include <array>
#include <vector>

namespace billet {

/// Compares what the accepted residuals leave out of balance on each body with the forces that are
/// reported on it. 'Force tolerance' is a part of all nodal forces. A force that is small beside
/// them may be known to no digit although each step has converged. An example is the friction of a
/// press fit beside its pressure. The free residual of a body, summed, is the error of the sum of
/// its reported forces.
class UnbalancedBodies {
public:
  UnbalancedBodies(const Scene &scene, const Discretization &discretization);

  /// Adds an accepted step. Explicit schemes have no residual; they need none of this.
  void add(const Solution &solution);
  /// Returns a warning for each body whose forces along an axis are off by more than a fiftieth of
  /// the largest one along that axis. A force below a tenth of 'Force tolerance' times the nodal
  /// forces of the body does not count. What residuals leave is of that size, and the force may be
  /// 0 but for them. Nor does the round-off of Young's modulus times the body's size squared.
  DiagnosticList judge() const;

  /// Returns the round-off of Young's modulus times the size squared, of each body [force]. It
  /// includes the body's springs and rigid faces, whose stiffnesses act on positions. Collective.
  static std::vector<double> find_round_off(const Scene &scene, const Discretization &discretization);
  /// Returns the force up to which one does not count, as judge() says; `nodal`: see BodyBalance.
  static double least_force(double round_off, double nodal, const parameters::Solver &settings);

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  /// Along one axis, over the run.
  struct Course {
    double force = 0.;           ///< largest reported force [force]
    double rest = 0., time = 0.; ///< largest sum of the free residual [force], and its time
  };
  struct Of {
    std::array<Course, 3> axes;
    double size = 0.; ///< largest BodyBalance::nodal [force]
  };

  const Scene &scene_;
  std::vector<double> round_off_;               ///< by body [force]
  std::vector<std::size_t> bodies_of_supports_; ///< in the order of named_supports()
  std::vector<Of> bodies_;
};

} // namespace billet

#endif
