// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_MESH_REFINEMENTS_H
#define BILLET_SCENE_MESH_REFINEMENTS_H

#include "billet/error_notes.h"
#include "billet/parameters/scene.h"

#include <deal.II/grid/tria.h>

#include <vector>

namespace billet {

/// Refinement level of each body: how often each of its elements has been divided into eight.
/// Empty: 0 for all bodies.
using MeshLevels = std::vector<unsigned int>;

/// Maximum of a level: keys of elements cannot represent more.
constexpr unsigned int max_refinements = 5;

/// Returns the levels after time t: those whose 'Refinement times' are reached.
MeshLevels find_mesh_levels(const parameters::Scene &scene, double t);

/// Returns all refinement times of the scene, ascending, each once [time].
std::vector<double> refinement_times(const parameters::Scene &scene);

/// Notes errors of 'Refinement times': after the end of the run, too many, or with something that
/// cannot be carried over to a finer mesh.
void check_refinements(const parameters::Scene &scene, ErrorNotes &errors);

/// Divides the elements of each body `levels[body]` times into eight: edges, faces and elements at
/// their middles. Cell material ids are the indices of bodies. Throws InputError if an element has
/// a corner at which its parts could be inverted.
void refine_bodies(const parameters::Scene &scene, const MeshLevels &levels, dealii::Triangulation<3> &mesh);

} // namespace billet

#endif
