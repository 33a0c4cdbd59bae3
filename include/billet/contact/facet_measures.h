// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_MEASURES_H
#define BILLET_CONTACT_FACET_MEASURES_H

#include "billet/contact/contact_load.h"
#include "billet/contact/facet_contact_parts.h"
#include "billet/contact/friction_use.h"
#include "billet/contact/restless_report.h"
#include "billet/contact/start_gaps.h"
#include "billet/contact/status_changes.h"
#include "billet/contact/supporting_point.h"

#include <vector>

namespace billet {

/// Measures and reports of contact between surfaces at the last evaluation, of this rank.
class FacetMeasures {
public:
  /// The parts must outlive this object.
  explicit FacetMeasures(const FacetContactParts &parts) : parts_(parts) {}

  /// Returns the maximum penetration of nodes.
  Penetration penetration() const;
  /// Returns the maximum penetration relative to the reach of the touched facets.
  double excessive_penetration() const;
  /// Returns the maximum closing in the step of a node that presses at its end but not at its start
  /// [facet sizes].
  double closing_of_new_contacts() const;
  /// See ContactMeasures.
  double max_sliding(double expected) const;
  FrictionUse friction_use() const;
  /// Returns the status of each slave, and its traction times its area.
  std::vector<SlaveForce> slave_forces() const;

  /// State of a slave node, for output.
  struct NodeReport {
    ContactStatus status = ContactStatus::open;
    double pressure = 0., gap = 0., slip = 0.;
    double area = 0.; ///< of all facets around it
    dealii::Tensor<1, 3> traction;
    double penetration = 0.;          ///< where it presses, as in penetration()
    double tangential_stiffness = 0.; ///< 0 without friction [force/length³]
    SurfaceForce total = {};
  };
  /// Reports each of this rank's nodes.
  std::vector<NodeReport> report() const;
  /// Returns what is to be judged of the gaps at the start, by the undeformed positions of this
  /// rank's nodes. Collective.
  StartGaps start_gaps(const ContactSurfaces::Positions &undeformed) const;

  /// Returns the nodes that have exceeded the maximum number of changes of facet or status since
  /// restart().
  std::vector<RestlessNode> find_restless() const;

  /// Calls visit(position, normal of the facet, surfaces of node and facet) for each slave that
  /// touches now.
  template <class Visit> void visit_touching(const Visit &visit) const {
    for (std::size_t s = 0; s < parts_.touching.size(); ++s)
      if (const SlaveState &state = parts_.touching[s]; state.presses())
        visit(parts_.surfaces.positions()[parts_.slaves.node(s)], state.contact.normal,
              parts_.slaves.surface(s), parts_.surfaces.facet(state.touched.facet).surface);
  }
  /// Calls visit(SupportingPoint, surface of the point, touched surface) for slaves and crossing
  /// edges.
  template <class Visit> void visit_supporting(const Visit &visit) const {
    choose_friction(parts_.settings.friction, [&](const auto &law) {
      for (std::size_t s = 0; s < parts_.touching.size(); ++s)
        if (const SlaveState &state = parts_.touching[s]; state.presses())
          visit(make_supporting_point(parts_.surfaces.positions()[parts_.slaves.node(s)],
                                      state.contact.normal, law, state.traction.status,
                                      state.traction.traction),
                parts_.slaves.surface(s), parts_.surfaces.facet(state.touched.facet).surface);
    });
    if (parts_.edges)
      parts_.edges->visit_supporting(parts_.surfaces.positions(), visit);
  }

private:
  /// Returns the forces on this rank's nodes, and their areas.
  std::vector<SurfaceForce> nodal_forces() const;

  const FacetContactParts &parts_;
};

} // namespace billet

#endif
