// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/penalty_continuation.h"

#include "billet/diagnostic_kinds.h"

#include <algorithm>
#include <cmath>

namespace billet {

std::vector<PenaltyContinuation::Octaves> PenaltyContinuation::octaves_above(const Start start) const {
  const ContactSet &contacts = parts_.contacts();
  const std::vector<double> normal = contacts.stiffening_left(),
                            tangential = contacts.collect_min([](const auto &contact) {
                              return contact.penalties().tangential_stiffening_left();
                            });
  const int lower = start == Start::low ? Limits::low : 0;
  const auto octaves = [lower](const double left) {
    return left < std::ldexp(1., lower) ? static_cast<int>(std::lround(-std::log2(left))) + lower : 0;
  };
  std::vector<Octaves> result(normal.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = {octaves(normal[i]), octaves(tangential[i])};
  return result;
}

bool PenaltyContinuation::is_possible(const Start start) const {
  if (start == Start::low && !permits_low_)
    return false;
  const std::vector<Octaves> above = octaves_above(start);
  return std::any_of(above.begin(), above.end(),
                     [](const Octaves &o) { return std::max(o.normal, o.tangential) > 0; });
}

void PenaltyContinuation::soften(const std::vector<Octaves> &above, const int softer, const int octaves) {
  // Powers of 2, so that the penalties are the same to the last bit afterwards.
  const auto change = [&](const int at_most) {
    return std::ldexp(1., std::min(softer, at_most) - std::min(octaves, at_most));
  };
  ContactSet &contacts = parts_.contacts();
  for (std::size_t i = 0; i < above.size(); ++i)
    contacts[i].penalties().scale(change(above[i].normal), change(above[i].tangential));
  contacts.restart();
  problem_.scales().spring_round_off = contacts.find_spring_round_off();
}

NewtonReport PenaltyContinuation::iterate(const Start start, std::vector<double> &offsets,
                                          Vector &displacements) {
  const std::vector<Octaves> above = octaves_above(start);
  int maximum = 0;
  for (const Octaves &o : above)
    maximum = std::max(maximum, std::max(o.normal, o.tangential));
  int softer = 0;
  const auto soften_to = [&](const int octaves) {
    soften(above, softer, octaves);
    softer = octaves;
  };
  NewtonReport report;
  Vector reached = displacements;
  std::vector<double> reached_offsets = offsets;
  int stride = Limits::first_stride, last = maximum;
  unsigned int n_retreats = 0;
  soften_to(maximum);
  for (;;) {
    report.append(solver_.iterate(offsets, displacements));
    if (report.converged && softer == 0)
      break;
    if (report.converged) {
      reached = displacements;
      reached_offsets = offsets;
      last = softer;
    } else if (softer < maximum && stride > 1 && n_retreats < Limits::max_retreats &&
               !report.is_lost_in_round_off) {
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

Diagnostic PenaltyContinuation::describe() const {
  return Diagnostic(diagnostic::penalty_too_high, "Newton's method needs lower penalties first, and many "
                                                  "iterations, because of the penalty of contact pair " +
                                                      parts_.contacts().stiffest_pairs())
      .time(problem_.step().time)
      .advice("Reduce 'Normal penalty', with a 'Penetration tolerance' if penetration is then too large");
}

} // namespace billet
