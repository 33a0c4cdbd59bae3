// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_GIVEN_SOLUTION_H
#define BILLET_TESTS_GIVEN_SOLUTION_H

#include "billet/solve/solution.h"

#include <string>
#include <vector>

namespace billet::testing {

/// A state that nothing has solved, without elements' results.
class GivenSolution : public Solution {
public:
  explicit GivenSolution(const Discretization &discretization) : discretization_(discretization) {
    state_.displacements = discretization.make_ghosted_vector();
  }

  /// Sets the displacement of the nodes of a body as a function of their undeformed positions.
  template <class Displacement> void move(const std::size_t body, const Displacement &displacement) {
    set(state_.displacements, body, displacement);
  }

  SolutionState &state() { return state_; }
  const SolutionState &state() const override { return state_; }
  const Discretization &discretization() const override { return discretization_; }
  std::vector<ElementSummary> summarize(std::size_t) const override { return {}; }
  std::vector<StateAverages> average_states(std::size_t) const override { return {}; }
  std::vector<std::vector<ContactNodeReport>> report_contacts() const override { return {}; }
  std::array<std::size_t, 2> history_sizes() const override { return {0, 0}; }
  std::string method() const override { return "formulas"; }
  DiagnosticList initial_diagnostics() const override { return {}; }
  const Reactions &reactions() const override { return reactions_; }

protected:
  template <class Function> void set(Vector &vector, const std::size_t body, const Function &function) {
    Vector owned = discretization_.make_owned_vector();
    for (const Element &element : discretization_.elements(body))
      for (unsigned int a = 0; a < n_element_nodes; ++a) {
        const dealii::Tensor<1, 3> value = function(dealii::Tensor<1, 3>(element.cell->vertex(a)));
        for (unsigned int i = 0; i < 3; ++i) {
          const DofIndex dof = element.dofs[std::size_t{3} * a + i];
          if (discretization_.owned_dofs().is_element(dof))
            owned(dof) = value[i];
        }
      }
    owned.compress(dealii::VectorOperation::insert);
    vector = owned;
  }

  const Discretization &discretization_;
  SolutionState state_;
  Reactions reactions_;
};

} // namespace billet::testing

#endif
