// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/constraint_lines.h"

#include "billet/compatibility.h"

#include <deal.II/dofs/dof_tools.h>

#include <algorithm>
#include <utility>

namespace billet {

Constraints build_constraints(const dealii::IndexSet &owned, const dealii::IndexSet &relevant,
                              const std::vector<ConstraintSource> &sources) {
  Constraints constraints;
  compatibility::reinit(constraints, owned, relevant);
  for (const auto &source : sources)
    for (std::size_t i = 0; i < source.lines.size(); ++i) {
      const ConstraintLine &line = source.lines[i];
      if (constraints.is_constrained(line.dof))
        continue;
      constraints.add_line(line.dof);
      constraints.add_entries(line.dof, line.others);
      constraints.set_inhomogeneity(line.dof, source.values.empty() ? 0. : source.values[i]);
    }
  constraints.close();
  return constraints;
}

std::vector<ConstraintLine> collect_hanging_nodes(const dealii::DoFHandler<3> &dof_handler,
                                                  const dealii::IndexSet &relevant) {
  if (dof_handler.get_triangulation().n_levels() == 1)
    return {};
  Constraints constraints;
  compatibility::reinit(constraints, dof_handler.locally_owned_dofs(), relevant);
  dealii::DoFTools::make_hanging_node_constraints(dof_handler, constraints);
  std::vector<ConstraintLine> lines;
  for (const auto &line : constraints.get_lines())
    lines.push_back({line.index, line.entries});
  return lines;
}

std::vector<ConstraintLine> collect_links(const dealii::DoFHandler<3> &dof_handler,
                                          const dealii::IndexSet &relevant) {
  return collect_hanging_nodes(dof_handler, relevant);
}

bool couple_ranks(const Constraints &constraints, const dealii::IndexSet &owned,
                  const MPI_Comm communicator) {
  const auto &lines = constraints.get_lines();
  const bool here = std::any_of(lines.begin(), lines.end(), [&owned](const auto &line) {
    return owned.is_element(line.index) &&
           std::any_of(line.entries.begin(), line.entries.end(),
                       [&owned](const auto &entry) { return !owned.is_element(entry.first); });
  });
  return dealii::Utilities::MPI::max(here ? 1 : 0, communicator) == 1;
}

void condense(const Constraints &constraints, const bool couples_ranks, Vector &forces) {
  // This works on the rank's own values: writing through deal.II's vector would be collective, but
  // ranks have different numbers of constraints.
  const dealii::ArrayView<double> values = owned_values(forces);
  const dealii::IndexSet owned = forces.locally_owned_elements();
  const auto place = [&owned](const DofIndex dof) { return owned.index_within_set(dof); };
  std::vector<std::pair<DofIndex, double>> foreign;
  for (const auto &line : constraints.get_lines()) {
    if (!owned.is_element(line.index))
      continue;
    double &force = values[place(line.index)];
    for (const auto &[dof, factor] : line.entries)
      if (owned.is_element(dof))
        values[place(dof)] += factor * force;
      else
        foreign.emplace_back(dof, factor * force);
    force = 0.;
  }
  if (!couples_ranks)
    return;
  Vector sums;
  sums.reinit(owned, constraints.get_local_lines(), forces.get_mpi_communicator(), true);
  for (const auto &[dof, force] : foreign)
    sums(dof) += force;
  sums.compress(dealii::VectorOperation::add);
  const dealii::ArrayView<const double> sum = owned_values(std::as_const(sums));
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] += sum[i];
}

} // namespace billet
