// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/explicit_parts.h"

#include "billet/contact/overlap.h"

namespace billet {

ExplicitParts::ExplicitParts(const Scene &scene_in, const Discretization &discretization_in)
    : scene(scene_in), discretization(discretization_in), clock(scene.parameters().file_name),
      nodes(discretization), motion(scene, nodes), elements(scene, nodes), contacts(scene, nodes),
      forces(scene, nodes, elements, settings().contact_resolution),
      masses(nodes, elements, settings().scaled_step / settings().safety_factor), tools(scene, nodes) {
  motion.begin(scene);
  if (!scene.parameters().restart.is_wanted()) // a restart begins with deformed bodies
    for (auto &contact : contacts.of_bodies())
      if (contact.settings().overlap.closed_gap > 0.) {
        contact.without_matrix().update(motion.displacements());
        contact.allow_overlap();
      }
}

} // namespace billet
