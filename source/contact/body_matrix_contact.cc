// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/body_matrix_contact.h"

#include "billet/contact/facet_contact.h"

#include <array>

namespace billet {

BodyMatrixContact::BodyMatrixContact(BodyContactParts &parts, const ContactTangent tangent)
    : parts_(parts), couplings_(parts.pair, parts.nodes, parts.surfaces, *parts.contact, tangent),
      paths_(parts.communicator, partners_of(parts.pair), parts.surfaces.keys, parts.surfaces.facets,
             parts.surfaces.penetrations) {}

void BodyMatrixContact::place(const Vector &displacements, FacetSearch::Positions &positions) const {
  const std::vector<unsigned int> &nodes = parts_.surfaces.local_nodes;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    positions[i] = get_vector(parts_.nodes.positions().data(), nodes[i]);
    for (unsigned int c = 0; c < 3; ++c)
      positions[i][c] += displacements(parts_.nodes.dofs(nodes[i])[c]);
  }
}

void BodyMatrixContact::update(const Vector &displacements) {
  place(displacements, parts_.positions);
  parts_.evaluate(parts_.duration);
}

void BodyMatrixContact::add_forces(Vector &residual) const {
  for (std::size_t i = 0; i < parts_.surfaces.local_nodes.size(); ++i) {
    const dealii::Tensor<1, 3> &force = parts_.forces[i];
    const std::array<double, 3> values{-force[0], -force[1], -force[2]};
    residual.add(3, parts_.nodes.dofs(parts_.surfaces.local_nodes[i]).data(), values.data());
  }
}

double BodyMatrixContact::find_free_part(const ContactPath &path) const {
  FacetSearch::Positions from(parts_.positions.size()), to(parts_.positions.size());
  place(path.from, from);
  place(path.to, to);
  return paths_.find_free_part(from, to, path.is_thorough);
}

void BodyMatrixContact::begin(const ContactStep & /*step*/, const Vector &displacements) {
  parts_.positions_n.resize(parts_.positions.size());
  place(displacements, parts_.positions_n);
  update(displacements);
  parts_.allow_overlap();
}

} // namespace billet
