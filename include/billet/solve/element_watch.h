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

/// Compares the elements of each body with elements that are accurate in bending, (L1) of
/// doc/theory.md. Warns of elements that are too stiff or too soft. The final warning refers to the
/// state of largest deformation energy, or to the last state if it is still loaded. In statics a
/// note is printed at the first loaded step. A sheet that bends first and is stretched later may be
/// inaccurate there and accurate in the end.
class ElementWatch {
public:
  ElementWatch(const Scene &scene, const Discretization &discretization);

  /// Checks an accepted step. Collective.
  DiagnosticList watch(const SolutionState &state, bool is_last);

  /// Returns the relative error of forces (of driven tools) over all bodies at the last comparison.
  /// If they are too large, it is a lower bound; if too small, an estimate. It is 0 if no body is
  /// doubtful.
  double error() const;
  /// Returns the energies of the bodies at the last comparison.
  const std::vector<ElementEnergies> &energies() const { return energies_; }

  /// Returns messages about the last comparison; notes if it is that of the first loaded step.
  DiagnosticList judge(bool is_first) const;

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

  /// Factor above which, or below whose inverse, an element is unfit for its deformation.
  static constexpr double doubtful_factor = 1.1;

private:
  void compare(const SolutionState &state);
  /// Returns warnings about plastic bending, (L3) and (L10). They concern bodies with too few
  /// one-point elements through the thickness, or with flow between the points of assumed-strain
  /// bricks or at their faces.
  DiagnosticList judge_bending() const;
  /// Returns warnings about probes that read stresses of one-point elements that bend.
  DiagnosticList judge_probes() const;
  /// Returns (L1), on the safe side for bodies that yield.
  double factor_of(std::size_t body) const;
  /// Whether the body's elements are too stiff or too soft for its deformation.
  bool is_doubtful(std::size_t body) const;
  /// Whether the energies of a body exceed round-off and 1 % of those of all bodies.
  bool counts(std::size_t body) const;

  const Scene &scene_;
  const Discretization &discretization_;
  std::vector<ElementComparison> comparisons_; ///< by body
  std::vector<double> volumes_;                ///< of the undeformed bodies
  std::vector<ElementEnergies> energies_;      ///< by body
  double compared_energy_ = 0., compared_time_ = 0., max_energy_ = 0.;
};

} // namespace billet

#endif
