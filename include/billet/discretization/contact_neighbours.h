// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_CONTACT_NEIGHBOURS_H
#define BILLET_DISCRETIZATION_CONTACT_NEIGHBOURS_H

#include "billet/scene/scene.h"

#include <deal.II/lac/dynamic_sparsity_pattern.h>

namespace billet {

/// Adds to the pattern, of active cells, those that lie opposite each other at the faces of a pair of bodies:
/// with these as neighbours, METIS seldom cuts between bodies that touch. Each face has the face whose middle
/// is nearest to its own, as long as that is no farther away than the faces are large.
void add_contact_neighbours(const Scene &scene, const dealii::Triangulation<3> &mesh,
                            dealii::DynamicSparsityPattern &pattern);

} // namespace billet

#endif
