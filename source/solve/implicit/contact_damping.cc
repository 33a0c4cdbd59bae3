// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/contact_damping.h"

#include "billet/solve/implicit/step_state.h"

namespace billet {

ContactDamping::ContactDamping(const FreeMass &mass, const TimeIntegrator &integrator,
                               const Vector &accelerations)
    : mass_(mass), integrator_(integrator), accelerations_(accelerations), at_end_(accelerations),
      without_contact_(accelerations), forces_n_(accelerations) {}

void ContactDamping::choose(const ForceState &start) {
  forces_n_ = start.supports;
  if (is_on_ && start.contact.l2_norm() == 0.)
    is_on_ = false;
  else if (is_on_)
    damp(start);
}

void ContactDamping::damp(const ForceState &start) {
  forces_n_ = start.supports;
  forces_n_ -= start.contact;
  is_on_ = true;
  without_contact_ = accelerations_;
  without_contact_ -= mass_.accelerations_by(start.contact);
}

void ContactDamping::finish(const Vector &contact_forces) {
  if (is_on_)
    at_end_ = mass_.accelerations_by(contact_forces);
}

void ContactDamping::complete(Vector &accelerations) const {
  if (is_on_)
    accelerations.add(1. - 1. / integrator_.gamma(), at_end_);
}

} // namespace billet
