// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_DISCRETIZATION_H
#define BILLET_DISCRETIZATION_DISCRETIZATION_H

#include "billet/algebra/vector.h"
#include "billet/mechanics/mean_dilatation.h"
#include "billet/scene/mesh_refinements.h"
#include "billet/scene/scene.h"

#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>

#include <array>
#include <vector>

namespace billet {

using DofIndex = dealii::types::global_dof_index;
using CellIterator = dealii::DoFHandler<3>::active_cell_iterator;

/// Owned hexahedral element.
struct Element {
  CellIterator cell;
  std::array<DofIndex, n_element_dofs> dofs; ///< node by node
};

/// Mesh of all bodies, partitioned by METIS, and the displacement's degrees of freedom on it. Each
/// rank holds its own cells and one layer around them. Cell material ids are body indices.
class Discretization {
public:
  /// Builds the mesh on the first rank, with bodies refined to `levels`, and distributes it. Throws
  /// InputError.
  Discretization(const Scene &scene, MPI_Comm communicator, MeshLevels levels = {});
  ~Discretization();

  MPI_Comm communicator() const { return communicator_; }
  const dealii::DoFHandler<3> &dof_handler() const { return dof_handler_; }
  const dealii::IndexSet &owned_dofs() const { return owned_; }
  const dealii::IndexSet &relevant_dofs() const { return relevant_; }
  std::size_t n_bodies() const { return elements_.size(); }
  /// Returns the owned elements of a body.
  const std::vector<Element> &elements(const std::size_t body) const { return elements_[body]; }

  /// Returns the refinement level of each body.
  const MeshLevels &levels() const { return levels_; }
  /// Returns the number of elements of each body on all ranks. Collective.
  std::vector<std::size_t> count_elements() const;
  std::size_t n_global_elements() const { return tria_.n_global_active_cells(); }

  /// Middle, and half the diagonal, of the bounding box of the undeformed bodies [length].
  const dealii::Tensor<1, 3> &centre() const { return centre_; }
  double radius() const { return radius_; }

  /// Vector of owned entries; of relevant entries to read from; of entries to which every rank that
  /// shares a dof can add.
  Vector make_owned_vector() const { return Vector(owned_, communicator_); }
  Vector make_ghosted_vector() const { return Vector(owned_, relevant_, communicator_); }
  Vector make_additive_vector() const {
    Vector vector;
    vector.reinit(owned_, relevant_, communicator_, true);
    return vector;
  }

private:
  MPI_Comm communicator_;
  dealii::parallel::fullydistributed::Triangulation<3> tria_;
  dealii::FESystem<3> fe_;
  dealii::DoFHandler<3> dof_handler_;
  dealii::IndexSet owned_, relevant_;
  std::vector<std::vector<Element>> elements_;
  dealii::Tensor<1, 3> centre_;
  double radius_ = 0.;
  MeshLevels levels_;
};

/// Returns the entries of a ghosted vector at the dofs of an element.
inline ElementVectors gather(const Vector &vector, const std::array<DofIndex, n_element_dofs> &dofs) {
  ElementVectors values{};
  for (unsigned int i = 0; i < n_element_dofs; ++i)
    values[i] = vector(dofs[i]);
  return values;
}

/// Returns the reference positions of an element's nodes.
ElementVectors nodal_positions(const CellIterator &cell);

} // namespace billet

#endif
