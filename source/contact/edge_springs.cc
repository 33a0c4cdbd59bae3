// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/edge_springs.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

EdgeSprings::EdgeSprings(const FacetContactSettings &settings, const std::vector<ContactStiffness> &stiffness,
                         const SlavePenalties &penalties)
    : edges_(settings.partners, settings.flat_edge), penetration_(settings.edge_penetration),
      penalties_(penalties) {
  for (const auto &of_node : stiffness)
    stiffness_.push_back(of_node.normal);
}

void EdgeSprings::rebuild(const ContactSurfaces &surfaces) {
  surfaces.exchange().update(stiffness_);
  edges_.rebuild(surfaces.search().facets(), surfaces.exchange().n_own_facets(), surfaces.positions(),
                 surfaces.margin(), penetration_);
  memory_.set(edges_.n_pairs() * 2 * sizeof(std::size_t));
}

void EdgeSprings::update(const ContactSurfaces &surfaces, const bool has_started) {
  Usage::count(Capability::edges, edges_.n_pairs());
  crossings_ = edges_.find_crossings(surfaces.positions_n(), surfaces.positions(), has_started);
}

double EdgeSprings::stiffness_of(const EdgeContact::Crossing &crossing) const {
  double sum = 0.;
  for (const unsigned int node : crossing.nodes)
    sum += penalties_.stiffening() * stiffness_[node];
  return 0.25 * sum;
}

void EdgeSprings::add_forces(Positions &forces) const {
  for (const auto &crossing : crossings_)
    if (crossing.counted_gap() < 0.) {
      const auto of_nodes = crossing.forces(stiffness_of(crossing));
      for (unsigned int i = 0; i < 4; ++i)
        forces[crossing.nodes[i]] += of_nodes[i];
    }
}

void EdgeSprings::add_row_sums(std::vector<double> &sums) const {
  for (const auto &crossing : crossings_) {
    // The second derivatives of ½ k A g², except those of A and g, which are smaller by g/L. The
    // full area applies always, since the reduced area changes fast where it fades.
    const double k = stiffness_of(crossing), penetration = std::max(-crossing.counted_gap(), 0.);
    double sum = 0.;
    for (const auto &gradient : crossing.area_gradients)
      sum += gradient.norm();
    for (unsigned int i = 0; i < 4; ++i)
      sums[crossing.nodes[i]] +=
          k * (2. * crossing.weights[i] * crossing.full_area +
               penetration * (crossing.weights[i] * sum + 2. * crossing.area_gradients[i].norm()));
  }
}

void EdgeSprings::add_load(const Positions &positions, FacetContactLoad &load) const {
  for (const auto &crossing : crossings_) {
    if (!(crossing.counted_gap() < 0.))
      continue;
    const double stiffness = stiffness_of(crossing);
    const auto forces = crossing.forces(stiffness);
    for (unsigned int i = 0; i < 4; ++i) {
      load.residual_force += forces[i];
      load.residual_moment +=
          dealii::cross_product_3d(positions[crossing.nodes[i]] - positions[crossing.nodes[0]], forces[i]);
      if (crossing.surfaces[0] != crossing.surfaces[1] && crossing.surfaces[i / 2] == 0) {
        load.force += forces[i];
        load.moment += dealii::cross_product_3d(positions[crossing.nodes[i]], forces[i]);
      }
    }
    load.absolute_force += (forces[0] + forces[1]).norm();
    load.stored_energy += 0.5 * stiffness * crossing.area * crossing.counted_gap() * crossing.counted_gap();
    load.deepest = std::max(load.deepest, -crossing.gap);
    load.deepest_relative =
        std::max(load.deepest_relative, -0.5 * crossing.gap / std::sqrt(crossing.full_area));
  }
}

void EdgeSprings::save(StateWriter &writer, const unsigned int rank) const {
  write_list(writer, "edges", rank, edges_.offsets());
}

void EdgeSprings::load(const StateReader &reader) {
  if (!reader.has("edges"))
    return;
  for (unsigned int rank = 0; rank < reader.n_ranks(); ++rank)
    edges_.add_offsets(read_list(reader, "edges", rank));
}

} // namespace billet
