// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_HANGING_NODES_H
#define BILLET_DISCRETIZATION_HANGING_NODES_H

#include <deal.II/dofs/dof_handler.h>

#include <string>

namespace billet {

/// Throws InputError on all ranks if any rank's part of the mesh has hanging nodes. `method`, which
/// does not support them, begins the message. Collective.
void require_no_hanging_nodes(const dealii::DoFHandler<3> &dof_handler, const std::string &method);

} // namespace billet

#endif
