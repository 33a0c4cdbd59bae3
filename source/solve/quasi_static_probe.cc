// SPDX-License-Identifier: LGPL-2.1-or-later
// Tries of steps that are not taken, to measure what the steps that are taken are off.
#include "billet/solve/quasi_static.h"

#include <Epetra_Vector.h>

#include <algorithm>

namespace billet {

bool QuasiStatic::has_forces_of_contacts() const {
  const auto &pairs = scene_.body_pairs();
  return !contacts_.empty() ||
         std::any_of(pairs.begin(), pairs.end(), [](const auto &pair) { return !pair.is_self_contact; });
}

std::vector<dealii::Tensor<1, 3>> QuasiStatic::forces() const {
  std::vector<dealii::Tensor<1, 3>> result;
  for (const auto &load : state_.tool_loads)
    result.push_back(load.force);
  for (const auto &load : state_.body_pair_loads)
    result.push_back(load.force);
  if (!has_forces_of_contacts())
    result.push_back(dealii::Tensor<1, 3>({support_forces_n_.l2_norm(), 0., 0.}));
  return result;
}

std::vector<dealii::Tensor<1, 3>> QuasiStatic::trial_forces() const {
  std::vector<dealii::Tensor<1, 3>> result(state_.tool_loads.size());
  for (const auto &contact : contacts_)
    result[contact.tool()] += contact.compute_load().force;
  for (const auto &contact : body_contacts_)
    result.push_back(contact->compute_load().force);
  if (!has_forces_of_contacts())
    result.push_back(dealii::Tensor<1, 3>({support_forces_.l2_norm(), 0., 0.}));
  return result;
}

QuasiStatic::Probe QuasiStatic::probe(const double t, const double previous_step,
                                      const bool measures_penetration) {
  Probe probe;
  if (!body_failure_.empty()) // the step itself tells
    return probe;
  choose_contact_damping();
  is_probing_ = true;
  probe_.reset();
  probe.newton = attempt_step(t, previous_step);
  is_probing_ = false;
  if (probe.newton.converged) {
    probe.forces = trial_forces();
    probe_ = std::make_unique<ProbedState>(ProbedState{t, trial_, offsets_});
    probe.penetration = find_penetration();
    if (measures_penetration && !(contacts_.empty() && body_contacts_.empty())) {
      Vector displacements = trial_;
      std::vector<double> offsets = offsets_;
      for (auto &contact : contacts_)
        contact.augment();
      for (auto &contact : body_contacts_)
        contact->augment();
      const NewtonReport augmented = iterate(offsets, displacements);
      probe.newton.iterations.insert(probe.newton.iterations.end(), augmented.iterations.begin(),
                                     augmented.iterations.end());
      if (augmented.converged) {
        const Epetra_Vector accepted = pack(displacements, offsets);
        Epetra_Vector residual(accepted);
        compute_residual(accepted, residual);
        // What is left of the penetrations goes on like this: a geometric series.
        constexpr double most_left = 0.8;
        const double left =
            probe.penetration > 0. ? std::min(most_left, find_penetration() / probe.penetration) : 0.;
        probe.without_penetration = trial_forces();
        for (std::size_t i = 0; i < probe.forces.size(); ++i)
          probe.without_penetration[i] +=
              left / (1. - left) * (probe.without_penetration[i] - probe.forces[i]);
      }
    }
  }
  probe.newton.linear_iterations = linear_->take_iterations();
  probe.newton.note = linear_->take_note();
  return probe;
}

bool QuasiStatic::follow_probe(const double t) {
  if (!probe_ || t > probe_->time || state_.time >= probe_->time)
    return false;
  const double ratio = (t - state_.time) / (probe_->time - state_.time);
  trial_ = probe_->displacements;
  trial_ -= u_n_;
  trial_ *= ratio;
  trial_ += u_n_;
  for (const std::size_t tool : unknown_tools_)
    offsets_[tool] = offsets_n_[tool] + ratio * (probe_->offsets[tool] - offsets_n_[tool]);
  // Supports that do not move evenly would crush the elements beside them.
  constexpr double largest_jump = 0.1;
  Vector jump = trial_, motion = trial_;
  supports_.at_time(t).distribute(trial_);
  jump -= trial_;
  motion -= u_n_;
  return jump.l2_norm() <= largest_jump * motion.l2_norm();
}

} // namespace billet
