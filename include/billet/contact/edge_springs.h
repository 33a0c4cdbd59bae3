// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_EDGE_SPRINGS_H
#define BILLET_CONTACT_EDGE_SPRINGS_H

#include "billet/contact/contact_surfaces.h"
#include "billet/contact/edge_contact.h"
#include "billet/contact/facet_contact_load.h"
#include "billet/contact/facet_contact_settings.h"
#include "billet/contact/slave_nodes.h"
#include "billet/contact/supporting_point.h"
#include "billet/state.h"
#include "billet/usage.h"

#include <vector>

namespace billet {

/// Penalty springs between crossing edges, without friction.
class EdgeSprings {
public:
  using Positions = FacetSearch::Positions;

  /// Constructs the springs. `stiffness` are the full penalties of this rank's nodes; each spring
  /// takes the mean of its four nodes, times the stiffening factor of `penalties`. The latter must
  /// outlive this object.
  EdgeSprings(const FacetContactSettings &settings, const std::vector<ContactStiffness> &stiffness,
              const SlavePenalties &penalties);

  /// Lists the pairs that may cross. Collective.
  void rebuild(const ContactSurfaces &surfaces);
  /// Finds the pairs that cross, with offsets once a step has ended.
  void update(const ContactSurfaces &surfaces, bool has_started);
  void commit() { edges_.commit(); }

  /// Adds the forces on nodes, including ghosts.
  void add_forces(Positions &forces) const;
  /// Adds the sums Σ_j |K_ij| of FacetBounds to nodes, including ghosts [force/length].
  void add_row_sums(std::vector<double> &sums) const;
  void add_load(const Positions &positions, FacetContactLoad &load) const;
  /// Visits as FacetMeasures::visit_supporting() does.
  template <class Visit> void visit_supporting(const Positions &positions, const Visit &visit) const {
    for (const auto &crossing : crossings_)
      if (crossing.counted_gap() < 0.) {
        dealii::Tensor<1, 3> position;
        for (unsigned int i = 0; i < 2; ++i)
          position += crossing.weights[i] * positions[crossing.nodes[i]];
        visit(make_supporting_point(position, crossing.normal, Frictionless(), ContactStatus::slip, {}),
              crossing.surfaces[0], crossing.surfaces[1]);
      }
  }

  void save(StateWriter &writer, unsigned int rank) const;
  void load(const StateReader &reader);

private:
  /// Returns k of a crossing [pressure/length].
  double stiffness_of(const EdgeContact::Crossing &crossing) const;

  EdgeContact edges_;
  double penetration_;
  std::vector<double> stiffness_; ///< of nodes, with ghosts
  const SlavePenalties &penalties_;
  std::vector<EdgeContact::Crossing> crossings_;
  HeldMemory memory_{Capability::edges};
};

} // namespace billet

#endif
