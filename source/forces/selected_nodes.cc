// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/forces/selected_nodes.h"

#include "billet/discretization/boundary_facets.h"

#include <map>

namespace billet {

std::vector<SelectedNode> collect_selected_nodes(const AppliedLoad &load,
                                                 const Discretization &discretization,
                                                 const std::size_t body) {
  std::vector<SelectedNode> result;
  if (!load.nodes)
    return result;
  std::map<DofIndex, SelectedNode> nodes;
  for (const auto &element : discretization.elements(body))
    for (const unsigned int v : element.cell->vertex_indices()) {
      const auto &position = element.cell->vertex(v);
      if (load.nodes->contains(position))
        nodes[element.dofs[3 * v]] = {{element.dofs[3 * v], element.dofs[3 * v + 1], element.dofs[3 * v + 2]},
                                      position};
    }
  for (const auto &entry : nodes)
    result.push_back(entry.second);
  return result;
}

std::vector<SpringSite> collect_springs(const AppliedLoad &load, const Discretization &discretization,
                                        const std::size_t body) {
  std::vector<SpringSite> springs;
  const auto directions_of_nodes = load.load.supports(dealii::Tensor<1, 3>());
  for (const SelectedNode &node : collect_selected_nodes(load, discretization, body))
    springs.push_back({node, directions_of_nodes});
  for (const auto &facet : collect_boundary_facets(discretization, body, load.boundary_ids)) {
    const auto directions = load.load.supports(facet.area_vector() / facet.area_vector().norm());
    for (unsigned int a = 0; a < 4; ++a)
      springs.push_back({{facet.dofs[a], facet.corners[a]}, directions});
  }
  return springs;
}

} // namespace billet
