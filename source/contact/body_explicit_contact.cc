// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/body_explicit_contact.h"

#include "billet/contact/facet_contact.h"

namespace billet {

void BodyExplicitContact::place(const NodalVectors &displacements, FacetSearch::Positions &positions) const {
  const std::vector<unsigned int> &nodes = parts_.surfaces.local_nodes;
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i] =
        get_vector(parts_.nodes.positions().data(), nodes[i]) + get_vector(displacements.data(), nodes[i]);
}

void BodyExplicitContact::update(const NodalVectors &displacements) {
  place(displacements, parts_.positions);
  parts_.evaluate(parts_.duration);
}

ContactLoad BodyExplicitContact::add_forces(NodalVectors &forces, NodalVectors &bounds) {
  const std::vector<unsigned int> &nodes = parts_.surfaces.local_nodes;
  row_sums_.assign(nodes.size(), 0.);
  parts_.contact->bounds().add_row_sums(row_sums_);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    add_vector(forces.data(), nodes[i], parts_.forces[i]);
    bounds[std::size_t{nodal_stride} * nodes[i]] += row_sums_[i];
  }
  ContactLoad load;
  load.dissipation = parts_.contact->works().local_dissipation();
  return load;
}

void BodyExplicitContact::add_crossings(Crossings &crossings) const {
  parts_.contact->bounds().add_crossings(crossings);
}

void BodyExplicitContact::begin(const ContactStep & /*step*/, const NodalVectors &displacements) {
  parts_.positions_n.resize(parts_.positions.size());
  place(displacements, parts_.positions_n);
}

} // namespace billet
