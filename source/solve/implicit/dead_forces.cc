// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/dead_forces.h"

#include <map>
#include <utility>

namespace billet {

using dealii::Tensor;

DeadForces::DeadForces(const Discretization &discretization, Vector forces)
    : discretization_(discretization), forces_(std::move(forces)) {
  const dealii::IndexSet &owned = discretization.owned_dofs();
  const auto values = owned_values(std::as_const(forces_));
  std::map<std::size_t, dealii::Point<3>> sites;
  for (const auto &cell : discretization.dof_handler().active_cell_iterators()) {
    if (cell->is_artificial())
      continue;
    for (const unsigned int v : cell->vertex_indices()) {
      const DofIndex dof = cell->vertex_dof_index(v, 0);
      if (!owned.is_element(dof))
        continue;
      const std::size_t place = owned.index_within_set(dof);
      if (values[place] != 0. || values[place + 1] != 0. || values[place + 2] != 0.)
        sites.emplace(place, cell->vertex(v));
    }
  }
  for (const auto &[place, position] : sites)
    sites_.push_back({place, position});
}

Resultant DeadForces::resultant(const Vector &displacements) const {
  const auto values = owned_values(forces_), u = owned_values(displacements);
  std::vector<Resultant> sum(1);
  for (const Site &site : sites_) {
    Tensor<1, 3> x = site.position, at_node;
    for (unsigned int i = 0; i < 3; ++i) {
      at_node[i] = values[site.place + i];
      x[i] += u[site.place + i];
    }
    sum.front().force += at_node;
    sum.front().moment += dealii::cross_product_3d(x, at_node);
  }
  sum_over_ranks(sum, discretization_.communicator());
  return sum.front();
}

} // namespace billet
