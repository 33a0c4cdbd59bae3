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

/// Compares the elements of each body with ones that bend right, (L1) of doc/theory.md, and warns where they
/// are too stiff or too soft: at the end of the run, of the state of the largest energy of deformation or of
/// the last one where it is still loaded. In statics a note tells it at the first loaded step already; a
/// sheet that bends first and is stretched then may be wrong there and right in the end.
class ElementWatch {
public:
  ElementWatch(const Scene &scene, const Discretization &discretization);

  /// After an accepted step. Collective.
  DiagnosticList watch(const SolutionState &state, bool is_last);

  /// By what part forces (of driven tools) are wrong, over all bodies together, at the last comparison: at
  /// least, where they are too large; about, where they are too small. 0 where no body is doubtful.
  double error() const;
  /// The energies of the bodies at the last comparison.
  const std::vector<ElementEnergies> &energies() const { return energies_; }

  /// Messages about the last comparison; notes where it is that of the first loaded step.
  DiagnosticList judge(bool is_first) const;

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

  /// Beyond this factor, or below its inverse, an element is wrong for what it does.
  static constexpr double doubtful_factor = 1.1;

private:
  void compare(const SolutionState &state);
  /// Bodies that bend and yield with too few one-point elements through the thickness, or where the points of
  /// bricks of assumed strains do not see it, (L3).
  DiagnosticList judge_bending() const;
  /// (L1), on the safe side for bodies that yield.
  double factor_of(std::size_t body) const;
  /// Whether its element is too stiff or too soft for what it does.
  bool is_doubtful(std::size_t body) const;
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
