// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_ELEMENT_WATCH_H
#define BILLET_SOLVE_ELEMENT_WATCH_H

#include "billet/diagnostics.h"
#include "billet/mechanics/element_comparison.h"
#include "billet/scene/scene.h"
#include "billet/solve/solution.h"
#include "billet/state.h"

#include <vector>

namespace billet {

/// Compares the elements of each body with ones that bend right, (L4) of doc/theory.md, and warns where they
/// are too stiff or too soft. In statics at the first loaded step, whenever the energy of deformation has
/// doubled, and at the end. In dynamics a wave front is no measure: there the state of the largest energy
/// counts, and the message comes at the end.
class ElementWatch {
public:
  ElementWatch(const Scene &scene, const Discretization &discretization);

  /// After an accepted step. Collective.
  DiagnosticList watch(const SolutionState &state, bool is_last);

  /// By what part forces are too large (of driven tools) at least, over all bodies together, at the last
  /// comparison; 0 where no body is found too stiff.
  double error() const;
  /// The energies of the bodies at the last comparison.
  const std::vector<ElementEnergies> &energies() const { return energies_; }

  /// What compare() finds of these energies; `time`: when they were.
  DiagnosticList judge(double time) const;

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

  /// Beyond this factor, or below its inverse, an element is wrong for what it does.
  static constexpr double doubtful_factor = 1.1;

private:
  void compare(const SolutionState &state);
  /// Whether the energies of a body are more than round-off and a part of all that counts.
  bool counts(std::size_t body) const;

  const Scene &scene_;
  const Discretization &discretization_;
  std::vector<ElementComparison> comparisons_; ///< by body
  std::vector<double> volumes_;                ///< of the undeformed bodies
  std::vector<ElementEnergies> energies_;      ///< by body
  double compared_energy_ = 0., compared_time_ = 0., largest_energy_ = 0.;
};

} // namespace billet

#endif
