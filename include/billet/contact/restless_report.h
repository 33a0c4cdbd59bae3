// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_RESTLESS_REPORT_H
#define BILLET_CONTACT_RESTLESS_REPORT_H

#include <deal.II/base/tensor.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace billet {

/// Node that changes its status, or the place that it touches, in many iterations of a step.
struct RestlessNode {
  dealii::Tensor<1, 3> position;
  unsigned int n_changes;
};

/// Returns a clause on the restless nodes of a pair on all ranks, and the most restless one; empty
/// if there are none. `changing`: what they change, such as "facet or status". Collective.
std::string describe_restless_nodes(const std::vector<RestlessNode> &nodes, const std::string &pair,
                                    const std::string &changing, MPI_Comm communicator);

} // namespace billet

#endif
