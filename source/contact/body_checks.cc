// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/body_checks.h"

#include "billet/algebra/gather.h"
#include "billet/contact/facet_contact.h"

#include <deal.II/base/mpi.h>

#include <array>
#include <sstream>

namespace billet {

Explanation BodyChecks::describe_restless() const {
  std::array<double, 5> mine{}; // number of changes, position, number of nodes
  for (const auto &node : contact_.measures().find_restless()) {
    mine[4] += 1.;
    if (node.n_changes > mine[0])
      mine = {static_cast<double>(node.n_changes), node.position[0], node.position[1], node.position[2],
              mine[4]};
  }
  std::array<double, 5> worst{};
  double n_nodes = 0.;
  for (const auto &of_rank : all_gather(communicator_, mine)) {
    n_nodes += of_rank[4];
    if (of_rank[0] > worst[0])
      worst = of_rank;
  }
  if (n_nodes == 0.)
    return {};
  std::ostringstream text;
  text << "; contact pair '" << pair_.name << "': " << n_nodes
       << (n_nodes == 1. ? " node keeps" : " nodes keep") << " changing facet or status, most often, "
       << worst[0] << " times, the one at (" << worst[1] << ", " << worst[2] << ", " << worst[3] << ")";
  return {text.str(), contact_.method() == FacetMethod::overlap
                          ? "Try a lower penalty, with a 'Penetration tolerance' if penetration is then too "
                            "large"
                          : "Try smaller steps, a lower penalty, 'Facets = overlap' or a larger 'Smoothing'"};
}

std::string BodyChecks::describe_obstacle() const {
  return "nodes of contact pair '" + pair_.name + "' would go through the other body";
}

} // namespace billet
