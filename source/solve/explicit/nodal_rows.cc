// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/nodal_rows.h"

namespace billet {

NodalRows::NodalRows(const LocalNodes &nodes) : nodes_(nodes), keys_(nodes.discretization()) {
  for (unsigned int node = 0; node < nodes.size(); ++node)
    of_nodes_.push_back(keys_(nodes.dofs(node)[0]));
}

void NodalRows::load(const StateReader &reader, const std::string &name, NodalVectors &values) const {
  const std::vector<double> rows = reader.read_rows(name, 3, of_nodes_);
  for (std::size_t node = 0; node < of_nodes_.size(); ++node)
    for (unsigned int i = 0; i < 3; ++i)
      values[nodal_stride * node + i] = rows[3 * node + i];
}

} // namespace billet
