// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/hanging_nodes.h"

#include "billet/errors.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace billet {

void require_no_hanging_nodes(const dealii::DoFHandler<3> &dof_handler, const std::string &method) {
  const auto &mesh = dof_handler.get_triangulation();
  const auto has_finer_neighbour = [](const auto &cell) {
    const auto faces = cell->face_indices();
    return cell->is_locally_owned() && std::any_of(faces.begin(), faces.end(), [&cell](const unsigned int f) {
             return cell->face(f)->has_children();
           });
  };
  bool has = false;
  if (mesh.n_levels() > 1)
    for (const auto &cell : mesh.active_cell_iterators())
      has = has || has_finer_neighbour(cell);
  if (dealii::Utilities::MPI::max(has ? 1 : 0, dof_handler.get_communicator()) == 1)
    throw InputError(method +
                     " does not support hanging nodes: use a mesh whose elements meet face to face, or "
                     "an implicit scheme");
}

} // namespace billet
