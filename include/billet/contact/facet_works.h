// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_WORKS_H
#define BILLET_CONTACT_FACET_WORKS_H

#include "billet/contact/facet_contact_load.h"
#include "billet/contact/facet_contact_parts.h"
#include "billet/contact/step_works.h"

namespace billet {

/// Forces, energies and works of contact between surfaces in the step, after its last evaluation.
class FacetWorks {
public:
  /// The parts must outlive this object.
  explicit FacetWorks(const FacetContactParts &parts) : parts_(parts) {}

  /// Collective.
  FacetContactLoad compute_load() const;
  /// Returns the dissipation by friction in this step, on this rank [energy].
  double local_dissipation() const;
  /// Computes the works as ContactMeasures::compute_step_works() does. Collective.
  StepWorks compute_step_works(double weight) const;

private:
  /// Whether slaves that leave transfer their load to slaves that enter, see FrictionAccount. With
  /// friction; collective.
  bool hands_over() const;
  /// Returns which dissipation of a slave counts. With friction; collective.
  double FrictionWorks::*counted_dissipation() const {
    return hands_over() ? &FrictionWorks::dissipation_handed_over : &FrictionWorks::dissipation;
  }
  void add_friction(FacetContactLoad &load) const;
  void add_slave(std::size_t s, FacetContactLoad &load) const;
  void add_forces(std::size_t s, FacetContactLoad &load) const;
  /// Computes the works on this rank; miscounted_friction(s) is the work of friction in them.
  template <class Friction>
  StepWorks local_step_works(double weight, const Friction &miscounted_friction) const;

  const FacetContactParts &parts_;
};

} // namespace billet

#endif
