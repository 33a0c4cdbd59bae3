// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/implicit_reactions.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

namespace {

/// Returns the sums over all nodes of these vectors. Collective.
std::vector<Tensor<1, 3>> sum_nodes(const std::vector<const Vector *> &vectors, const MPI_Comm communicator) {
  std::vector<double> sums(3 * vectors.size(), 0.);
  for (std::size_t v = 0; v < vectors.size(); ++v) {
    const auto values = owned_values(*vectors[v]);
    for (std::size_t k = 0; k < values.size(); ++k) // owned dofs come node by node
      sums[3 * v + k % 3] += values[k];
  }
  dealii::Utilities::MPI::sum(sums, communicator, sums);
  std::vector<Tensor<1, 3>> result(vectors.size());
  for (std::size_t k = 0; k < sums.size(); ++k)
    result[k / 3][static_cast<unsigned int>(k % 3)] = sums[k];
  return result;
}

} // namespace

ImplicitReactions::ImplicitReactions(const ImplicitProblem &problem)
    : problem_(problem), supports_(problem.scene(), problem.discretization(), problem.supports().acting()) {
  values_.of_supports.resize(named_supports(problem.scene()).size());
  values_.of_tool_pairs.resize(problem.scene().pairs().size());
  values_.between_nodes.resize(problem.scene().pairs().size());
  values_.of_loads.resize(named_loads(problem.scene()).size());
}

void ImplicitReactions::start() {
  supports_.follow(problem_.supports().acting());
  const ForceState &trial = problem_.step().trial;
  Vector residual = trial.supports;
  problem_.scheme().complete(trial.contact, residual);
  residual *= problem_.scheme().residual_weight();
  const SupportReactions::Forces forces = supports_.compute(residual, trial.displacements);
  const std::vector<Tensor<1, 3>> sums =
      sum_nodes({&trial.supports, &trial.internal, &trial.contact, &residual}, problem_.communicator());
  values_.of_supports = forces.of_supports;
  std::fill(values_.of_tool_pairs.begin(), values_.of_tool_pairs.end(), ContactLoad());
  ForceBalance &balance = values_.balance;
  balance = {};
  for (const Resultant &resultant : values_.of_supports)
    balance.reactions += resultant.force;
  // Residuals have the opposite sign of forces.
  balance.loads = sums[1] + sums[2] - sums[0];
  balance.inertia = sums[0] - sums[3];
  balance.free = -forces.free;
  balance.round_off = problem_.round_off_force();
  balance.size = std::max(trial.internal.l1_norm() + trial.contact.l1_norm() + trial.supports.l1_norm() +
                              residual.l1_norm(),
                          problem_.scales().lasting);
}

void ImplicitReactions::set_pair(const std::size_t pair, const ContactLoad &load,
                                 const FacetPenetration &between_nodes, const Placement &placement) {
  values_.of_tool_pairs[pair] = about_origin(load, placement);
  values_.between_nodes[pair] = between_nodes;
  values_.balance.contact += load.force;
}

} // namespace billet
