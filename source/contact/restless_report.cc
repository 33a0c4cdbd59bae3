// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/restless_report.h"

#include "billet/algebra/gather.h"

#include <array>
#include <sstream>

namespace billet {

std::string describe_restless_nodes(const std::vector<RestlessNode> &nodes, const std::string &pair,
                                    const std::string &changing, const MPI_Comm communicator) {
  std::array<double, 5> mine{}; // number of changes, position, number of nodes
  for (const RestlessNode &node : nodes) {
    mine[4] += 1.;
    if (node.n_changes > mine[0])
      mine = {static_cast<double>(node.n_changes), node.position[0], node.position[1], node.position[2],
              mine[4]};
  }
  std::array<double, 5> worst{};
  double n_nodes = 0.;
  for (const auto &of_rank : all_gather(communicator, mine)) {
    n_nodes += of_rank[4];
    if (of_rank[0] > worst[0])
      worst = of_rank;
  }
  if (n_nodes == 0.)
    return "";
  std::ostringstream text;
  text << "; contact pair '" << pair << "': " << n_nodes << (n_nodes == 1. ? " node keeps" : " nodes keep")
       << " changing " << changing << ", most often, " << worst[0] << " times, the one at (" << worst[1]
       << ", " << worst[2] << ", " << worst[3] << ")";
  return text.str();
}

} // namespace billet
