// SPDX-License-Identifier: LGPL-2.1-or-later
// Ways out where Newton's method fails: softer penalties that lead to stiff ones, and the exact tangent.
#include "billet/diagnostic_kinds.h"
#include "billet/solve/quasi_static.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

std::vector<QuasiStatic::Octaves> QuasiStatic::octaves_above_enough() const {
  std::vector<double> room = of_contacts([](const auto &contact) { return contact.stiffening_left(); });
  const std::vector<double> tangential =
      of_contacts([](const auto &contact) { return contact.tangential_stiffening_left(); });
  room.insert(room.end(), tangential.begin(), tangential.end());
  dealii::Utilities::MPI::min(room, discretization_.communicator(), room);
  const auto octaves = [](const double left) {
    return left < 1. ? static_cast<int>(std::lround(-std::log2(left))) : 0;
  };
  std::vector<Octaves> result(tangential.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = {octaves(room[i]), octaves(room[result.size() + i])};
  return result;
}

bool QuasiStatic::has_stiff_contacts() const {
  // Inertia, and shorter steps, do the same for dynamic scenes.
  if (motion_)
    return false;
  const std::vector<Octaves> above = octaves_above_enough();
  return std::any_of(above.begin(), above.end(),
                     [](const Octaves &o) { return std::max(o.normal, o.tangential) > 0; });
}

NewtonReport QuasiStatic::iterate_from_softer(std::vector<double> &offsets, Vector &displacements) {
  const std::vector<Octaves> above = octaves_above_enough();
  int most = 0;
  for (const Octaves &o : above)
    most = std::max(most, std::max(o.normal, o.tangential));
  // Powers of 2, so that the penalties are the same to the last bit afterwards.
  int softer = 0;
  const auto soften_to = [&](const int octaves) {
    const auto change = [&](const int at_most) {
      return std::ldexp(1., std::min(softer, at_most) - std::min(octaves, at_most));
    };
    for (std::size_t i = 0; i < above.size(); ++i) {
      const double normal = change(above[i].normal), tangential = change(above[i].tangential);
      if (i < contacts_.size())
        contacts_[i].scale_penalties(normal, tangential);
      else
        body_contacts_[i - contacts_.size()]->scale_penalties(normal, tangential);
    }
    softer = octaves;
    for (auto &contact : contacts_)
      contact.restart();
    for (auto &contact : body_contacts_)
      contact->restart();
    spring_round_off_ = find_spring_round_off();
  };
  constexpr int first_stride = 3;
  constexpr unsigned int most_retreats = 4;
  NewtonReport report;
  Vector reached = displacements;
  std::vector<double> reached_offsets = offsets;
  int stride = first_stride, last = most;
  unsigned int n_retreats = 0;
  soften_to(most);
  for (;;) {
    report.append(iterate(offsets, displacements));
    if (report.converged && softer == 0)
      break;
    if (report.converged) {
      reached = displacements;
      reached_offsets = offsets;
      last = softer;
    } else if (softer < most && stride > 1 && n_retreats < most_retreats && !report.is_lost_in_round_off) {
      displacements = reached;
      offsets = reached_offsets;
      stride = 1;
      ++n_retreats;
    } else
      break;
    soften_to(std::max(0, last - stride));
  }
  soften_to(0);
  return report;
}

Diagnostic QuasiStatic::needs_softer_penalties() const {
  return Diagnostic(diagnostic::penalty_too_high, "Newton's method needs lower penalties first, and many "
                                                  "iterations, because of the penalty of contact pair " +
                                                      stiffest_pairs())
      .time(time_)
      .advice("Reduce 'Normal penalty', with a 'Penetration tolerance' where that is too low");
}

bool QuasiStatic::take_exact_tangent() {
  if (tangent_ == ContactTangent::exact || (contacts_.empty() && body_contacts_.empty()))
    return false;
  tangent_ = ContactTangent::exact;
  for (auto &contact : contacts_)
    contact.set_tangent(tangent_);
  if (linear_) { // else it is made when it is known who touches whom
    linear_->release();
    linear_.reset();
    build_matrix();
  }
  return true;
}

} // namespace billet
