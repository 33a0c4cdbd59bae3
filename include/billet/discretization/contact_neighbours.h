// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_CONTACT_NEIGHBOURS_H
#define BILLET_DISCRETIZATION_CONTACT_NEIGHBOURS_H

#include "billet/scene/scene.h"

#include <deal.II/lac/dynamic_sparsity_pattern.h>

namespace billet {

/// Adds couplings between active cells that face each other at the faces of a pair of bodies. With
/// these neighbours, METIS rarely cuts between bodies in contact. Each face couples with the
/// nearest face by midpoints, if their distance does not exceed the size of the faces.
void add_contact_neighbours(const Scene &scene, const dealii::Triangulation<3> &mesh,
                            dealii::DynamicSparsityPattern &pattern);

} // namespace billet

#endif
