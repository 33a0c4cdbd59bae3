// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_STICK_SOFTNESS_H
#define BILLET_SOLVE_STICK_SOFTNESS_H

#include "billet/scene/scene.h"
#include "billet/solve/solution.h"

#include <vector>

namespace billet {

/// Lost friction of a pair whose nodes stick to elastic tangential springs, (L9) of doc/theory.md.
struct StickSoftness {
  double pressure = 0.; ///< Σ p A [force]
  double friction = 0.; ///< Σ |t| A [force]
  /// Upper bound of the additional friction of sticking nodes on rigid springs [force].
  double lost = 0.;
  double stored = 0.; ///< in the springs [energy]

  /// Returns the lost part of the friction on rigid springs.
  double part() const { return lost > 0. ? lost / (friction + lost) : 0.; }
};

/// Measures StickSoftness by the shear stiffness of bodies through their thickness.
class StickSprings {
public:
  /// Collective.
  StickSprings(const Scene &scene, const Discretization &discretization);

  /// Measures each pair, pairs with tools first; `reports`: of each pair. Collective; the same on
  /// all ranks.
  std::vector<StickSoftness> measure(const std::vector<std::vector<ContactNodeReport>> &reports) const;

private:
  struct Pair {
    double friction_coefficient;
    double stiffness; ///< of its bodies in series, G/H [force/length³]
  };
  MPI_Comm communicator_;
  std::vector<Pair> pairs_; ///< with tools first
};

/// Returns the thickness of each undeformed body [length]. It is the smallest edge of a box with
/// the same volume and the same smallest moment ∫ x² dV about the centre. Collective.
std::vector<double> body_thicknesses(const Discretization &discretization);

} // namespace billet

#endif
