// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/implicit_reactions.h"

#include <algorithm>
#include <cmath>

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

/// Returns the body of each owned node.
std::vector<std::size_t> find_bodies(const Discretization &discretization) {
  const auto &owned = discretization.owned_dofs();
  std::vector<std::size_t> bodies(owned.n_elements() / 3);
  std::vector<DofIndex> dofs(discretization.dof_handler().get_fe().n_dofs_per_cell());
  for (const auto &cell : discretization.dof_handler().active_cell_iterators())
    if (!cell->is_artificial()) {
      cell->get_dof_indices(dofs);
      for (const DofIndex dof : dofs)
        if (owned.is_element(dof))
          bodies[owned.index_within_set(dof) / 3] = cell->material_id();
    }
  return bodies;
}

} // namespace

ImplicitReactions::ImplicitReactions(const ImplicitProblem &problem)
    : problem_(problem), supports_(parts_.scene(), parts_.discretization(), parts_.supports().acting()),
      bodies_of_nodes_(find_bodies(parts_.discretization())) {
  for (const NamedSupport &support : named_supports(parts_.scene()))
    bodies_of_supports_.push_back(support.body);
  values_.of_supports.resize(named_supports(parts_.scene()).size());
  values_.of_tool_pairs.resize(parts_.scene().pairs().size());
  values_.between_nodes.resize(parts_.scene().pairs().size());
  values_.of_loads.resize(named_loads(parts_.scene()).size());
}

void ImplicitReactions::start() {
  supports_.follow(parts_.supports().acting());
  const ForceState &trial = problem_.step().trial;
  Vector residual = trial.supports, at_end = trial.supports;
  parts_.scheme().complete(trial.contact, residual);
  residual *= parts_.scheme().residual_weight();
  const SupportReactions::Forces weighted = supports_.compute(residual, trial.displacements);
  const std::vector<Tensor<1, 3>> sums =
      sum_nodes({&trial.supports, &trial.internal, &trial.contact}, parts_.communicator());
  balance_bodies(residual, weighted.of_supports);
  values_.of_supports = weighted.of_supports;
  if (parts_.scheme().has_inertia()) {
    parts_.scheme().add_end_inertia(at_end);
    values_.of_supports = supports_.compute(at_end, trial.displacements).of_supports;
  }
  std::fill(values_.of_tool_pairs.begin(), values_.of_tool_pairs.end(), ContactLoad());
  ForceBalance &balance = values_.balance;
  balance = {};
  for (const Resultant &resultant : values_.of_supports)
    balance.reactions += resultant.force;
  // Residuals have the opposite sign of forces.
  balance.loads = sums[1] + sums[2] - sums[0];
  balance.free = -weighted.free;
  // The inertia that is in balance with the forces at the end of the step, but for the free
  // residual.
  if (parts_.scheme().has_inertia())
    balance.inertia = balance.free + sums[0] - balance.reactions;
  balance.round_off = problem_.round_off_force();
  balance.size = std::max(trial.internal.l1_norm() + trial.contact.l1_norm() + trial.supports.l1_norm() +
                              residual.l1_norm(),
                          problem_.scales().lasting);
  add_fading();
}

void ImplicitReactions::add_fading() {
  const StepState &step = problem_.step();
  parts_.switched_supports().visit_fading(
      step.time, [&](const std::size_t support, const double left, const DeadForces &forces) {
        const Resultant resultant = forces.resultant(step.trial.displacements);
        values_.of_supports[support].force += left * resultant.force;
        values_.of_supports[support].moment += left * resultant.moment;
        values_.balance.reactions += left * resultant.force;
        values_.balance.loads -= left * resultant.force;
      });
}

void ImplicitReactions::balance_bodies(const Vector &residual, const std::vector<Resultant> &of_supports) {
  constexpr std::size_t n_sums = 4; // of the residual by axes, and of the forces' magnitudes
  std::vector<double> sums(n_sums * parts_.scene().bodies().size(), 0.);
  const auto rest = owned_values(residual), internal = owned_values(problem_.step().trial.internal);
  for (std::size_t n = 0; n < bodies_of_nodes_.size(); ++n) {
    double *of_body = &sums[n_sums * bodies_of_nodes_[n]];
    for (unsigned int i = 0; i < 3; ++i)
      of_body[i] += rest[3 * n + i];
    of_body[3] += std::hypot(internal[3 * n], internal[3 * n + 1], internal[3 * n + 2]);
  }
  dealii::Utilities::MPI::sum(sums, parts_.communicator(), sums);
  values_.of_bodies.assign(parts_.scene().bodies().size(), {});
  for (std::size_t b = 0; b < values_.of_bodies.size(); ++b) {
    for (unsigned int i = 0; i < 3; ++i)
      values_.of_bodies[b].free[i] = -sums[n_sums * b + i];
    values_.of_bodies[b].nodal = sums[n_sums * b + 3];
  }
  for (std::size_t s = 0; s < bodies_of_supports_.size(); ++s)
    values_.of_bodies[bodies_of_supports_[s]].free += of_supports[s].force;
}

void ImplicitReactions::set_pair(const std::size_t pair, const ContactLoad &load,
                                 const FacetPenetration &between_nodes, const Placement &placement) {
  values_.of_tool_pairs[pair] = about_origin(load, placement);
  values_.between_nodes[pair] = between_nodes;
  values_.balance.contact += load.force;
}

void ImplicitReactions::add_removed(const std::optional<std::size_t> pair, const ContactLoad &load,
                                    const Placement &placement) {
  if (pair)
    values_.of_tool_pairs[*pair] += about_origin(load, placement);
  values_.balance.contact += load.force;
  values_.balance.loads -= load.force;
}

} // namespace billet
