// SPDX-License-Identifier: LGPL-2.1-or-later
// Penalties that are too soft for what presses, or too stiff for sixteen digits.
#include "billet/solve/quasi_static.h"

#include <sstream>

namespace billet {

std::string QuasiStatic::watch_penalties() {
  constexpr double deep = 0.1; // of a facet: what is deeper is seen in pictures and counts in areas
  std::ostringstream note;
  note.precision(2);
  const auto look = [&](const std::string &name, const double own_depth) {
    const double depth = dealii::Utilities::MPI::max(own_depth, discretization_.communicator());
    if (depth <= deep || has_told_soft_)
      return;
    note
        << "Contact pair '" << name << "' lets nodes " << depth
        << " facet sizes deep: its penalty is soft for what presses here. Try a larger 'Normal penalty' or a "
           "'Penetration tolerance'\n";
    has_told_soft_ = true;
  };
  if (!has_told_soft_) {
    for (const auto &contact : contacts_)
      look(scene_.pairs()[contact.pair()].name, contact.penetration());
    for (const auto &contact : body_contacts_)
      look(contact->name(), contact->penetration());
  }
  const double tolerance = scene_.parameters().solver.force_tolerance;
  if (!has_told_stiff_ && force_scale_ > 0. && round_off_force() > tolerance * force_scale_) {
    note << "Round-off leaves " << round_off_force() / force_scale_
         << " of the forces, more than 'Force tolerance' = " << tolerance
         << " asks for, and is accepted: try a softer penalty, with a 'Penetration tolerance' where that is "
            "too "
            "soft, or bodies nearer to the origin\n";
    has_told_stiff_ = true;
  }
  return note.str();
}

} // namespace billet
