// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_CONTACT_MEASURES_H
#define BILLET_CONTACT_CONTACT_MEASURES_H

#include "billet/contact/contact_load.h"
#include "billet/contact/facet_penetration.h"
#include "billet/contact/friction_use.h"
#include "billet/contact/status_changes.h"
#include "billet/contact/step_works.h"
#include "billet/contact/supporting_point.h"
#include "billet/scene/rigid_motions.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace billet {

/// Measures of a contact pair at the last update() of its forces. They are of this rank unless
/// documented otherwise.
class ContactMeasures {
public:
  virtual ~ContactMeasures() = default;
  ContactMeasures(const ContactMeasures &) = delete;
  ContactMeasures &operator=(const ContactMeasures &) = delete;

  virtual Penetration penetration() const = 0;
  /// Returns the penetration relative to the acceptable one.
  virtual double excessive_penetration() const = 0;
  /// Returns the maximum closing in the step of a node that presses at its end but not at its start
  /// [facet sizes].
  virtual double closing_of_new_contacts() const = 0;
  /// Returns the load on the first body. Collective.
  virtual ContactLoad compute_load() const = 0;
  /// Returns the works that the trapezoidal rule miscounts, before commit(). `weight` is that of
  /// the forces at the end of the step in the mean forces. Collective.
  virtual StepWorks compute_step_works(double weight) const = 0;
  /// Returns the status and the force of each slave node.
  virtual std::vector<SlaveForce> slave_forces() const = 0;
  virtual std::vector<ContactNodeReport> report() const = 0;
  /// Returns the number of doubles of history.
  virtual std::size_t history_size() const = 0;
  /// Returns the largest length, apart from positions, that enters gaps: the radius of a tool's
  /// curvature, at most its size [length].
  virtual double surface_reach() const { return 0.; }
  /// Adds the resistances that constrain this body where a tool or another body touches it.
  virtual void add_resistances(std::size_t body, std::vector<Resistance> &resistances) const = 0;
  /// Visitor that receives the body of the point and the body that it touches; for a tool, the same
  /// body twice.
  using VisitSupporting = std::function<void(const SupportingPoint &, std::size_t body, std::size_t other)>;
  /// Visits the points in contact; none for self-contact.
  virtual void visit_supporting(const VisitSupporting &visit) const = 0;
  /// Returns the maximum motion over the step of a node that pressed at its start, at least 0
  /// [facet sizes]. The motion is relative to the touched surface, and counts beyond `expected`
  /// [length].
  virtual double max_sliding(double expected) const = 0;
  /// Returns the sums of tangential forces and of their limits over the nodes that press.
  virtual FrictionUse friction_use() const { return {}; }
  /// Returns the penetration of a tool between the nodes of facets; 0 without a tool. Collective.
  virtual FacetPenetration penetration_between_nodes() const { return {}; }

protected:
  ContactMeasures() = default;
};

} // namespace billet

#endif
