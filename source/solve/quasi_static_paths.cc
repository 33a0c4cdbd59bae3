// SPDX-License-Identifier: LGPL-2.1-or-later
// Nodes that would go through tools or bodies: in a step's first guess, in a correction, in a whole step.
#include "billet/solve/quasi_static.h"

#include <Epetra_Vector.h>

#include <algorithm>

namespace billet {

std::vector<Placement> QuasiStatic::placements_now() const {
  std::vector<Placement> placements;
  for (std::size_t tool = 0; tool < scene_.tools().size(); ++tool)
    placements.push_back(place(tool, time_, offsets_[tool]));
  return placements;
}

double QuasiStatic::find_free_part(const Vector &from, const std::vector<Placement> &tools_from,
                                   const Vector &to, const bool is_thorough) {
  const std::vector<Placement> tools_to = placements_now();
  std::vector<double> parts;
  for (const auto &contact : contacts_)
    parts.push_back(
        contact.find_free_part(from, tools_from[contact.tool()], to, tools_to[contact.tool()], is_thorough));
  if (!parts.empty())
    dealii::Utilities::MPI::min(parts, discretization_.communicator(), parts);
  for (const auto &contact : body_contacts_)
    parts.push_back(contact->find_free_part(from, to, is_thorough));
  const auto least = std::min_element(parts.begin(), parts.end());
  if (least == parts.end() || *least == 1.)
    return 1.;
  const auto which = static_cast<std::size_t>(least - parts.begin());
  if (which < contacts_.size())
    path_failure_ = "nodes of contact pair '" + scene_.pairs()[contacts_[which].pair()].name +
                    "' would go through tool '" + scene_.tools()[contacts_[which].tool()].name() + "'";
  else
    path_failure_ = "nodes of contact pair '" + body_contacts_[which - contacts_.size()]->name() +
                    "' would go through the other body";
  return *least;
}

double QuasiStatic::max_step_length(const Epetra_Vector &x, const Epetra_Vector &direction) {
  if (contacts_.empty() && body_contacts_.empty())
    return 1.;
  set_trial(x);
  const Vector from = trial_ghosted_;
  const std::vector<Placement> tools_from = placements_now();
  Epetra_Vector end(x);
  end.Update(1., direction, 1.);
  set_trial(end);
  const double part = find_free_part(from, tools_from, trial_ghosted_, false);
  constexpr double least = 1e-3; // so short a correction is none
  return part < least ? 0. : part;
}

bool QuasiStatic::goes_through(const bool is_thorough, NewtonReport &report) {
  trial_ghosted_ = trial_;
  if (find_free_part(state_.displacements, state_.placements, trial_ghosted_, is_thorough) == 1.)
    return false;
  report.converged = false;
  report.is_explained = true;
  report.failure = path_failure_ +
                   ", or deeper into it than contact follows them. Try a smaller 'Smallest step', a larger "
                   "'Normal penalty' or smaller facets";
  return true;
}

} // namespace billet
