// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_STICK_SOFTNESS_H
#define BILLET_SOLVE_STICK_SOFTNESS_H

#include "billet/scene/scene.h"
#include "billet/solve/solution.h"

#include <vector>

namespace billet {

/// What friction lacks in a pair whose nodes stick to elastic tangential springs, (L9) of doc/theory.md.
struct StickSoftness {
  double pressure = 0.; ///< Σ p A [force]
  double friction = 0.; ///< Σ |t| A [force]
  double lost = 0.;     ///< what sticking nodes would have more on rigid springs, at most [force]
  double stored = 0.;   ///< in the springs [energy]

  /// What is lost, of the friction on rigid springs.
  double part() const { return lost > 0. ? lost / (friction + lost) : 0.; }
};

/// Measures it, by the stiffness of bodies that are sheared through their thickness.
class StickSprings {
public:
  /// Collective.
  StickSprings(const Scene &scene, const Discretization &discretization);

  /// Of each pair, pairs with tools first; `reports`: of each pair. Collective; the same on all ranks.
  std::vector<StickSoftness> measure(const std::vector<std::vector<ContactNodeReport>> &reports) const;

private:
  struct Pair {
    double friction_coefficient;
    double stiffness; ///< of its bodies in series, G/H [force/length³]
  };
  MPI_Comm communicator_;
  std::vector<Pair> pairs_; ///< with tools first
};

/// The smallest edge of a box that has the volume and the least moment ∫ x² dV about the centre of each
/// undeformed body [length]: its thickness, however it lies. Collective.
std::vector<double> body_thicknesses(const Discretization &discretization);

} // namespace billet

#endif
