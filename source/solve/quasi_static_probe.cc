// SPDX-License-Identifier: LGPL-2.1-or-later
// Tries of steps that are not taken, to measure what the steps that are taken are off.
#include "billet/solve/quasi_static.h"

#include <Epetra_Vector.h>

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

/// The largest difference of a group, as part of it.
double difference(const QuasiStatic::Results &a, const QuasiStatic::Results &b) {
  double largest = 0.;
  for (std::size_t group = 0; group < a.size(); ++group) {
    const double scale = ErrorControl::size(b[group]);
    if (scale > 0.)
      largest = std::max(largest, ErrorControl::distance(a[group], b[group]) / scale);
  }
  return largest;
}

} // namespace

bool QuasiStatic::has_forces_of_contacts() const {
  const auto &pairs = scene_.body_pairs();
  return !contacts_.empty() ||
         std::any_of(pairs.begin(), pairs.end(), [](const auto &pair) { return !pair.is_self_contact; });
}

QuasiStatic::Results QuasiStatic::results() const {
  Results results(1);
  for (const auto &load : state_.tool_loads)
    results[0].push_back(load.force);
  for (const auto &load : state_.body_pair_loads)
    results[0].push_back(load.force);
  if (!has_forces_of_contacts())
    results[0].push_back(dealii::Tensor<1, 3>({support_forces_n_.l2_norm(), 0., 0.}));
  add_travels(offsets_n_, results);
  return results;
}

QuasiStatic::Results QuasiStatic::trial_results() const {
  Results results(1);
  results[0].resize(state_.tool_loads.size());
  for (const auto &contact : contacts_)
    results[0][contact.tool()] += contact.compute_load().force;
  for (const auto &contact : body_contacts_)
    results[0].push_back(contact->compute_load().force);
  if (!has_forces_of_contacts())
    results[0].push_back(dealii::Tensor<1, 3>({support_forces_.l2_norm(), 0., 0.}));
  add_travels(offsets_, results);
  return results;
}

void QuasiStatic::add_travels(const std::vector<double> &offsets, Results &results) const {
  for (std::size_t i = 0; i < scene_.tools().size(); ++i)
    if (scene_.tools()[i].is_driven())
      results.push_back({dealii::Tensor<1, 3>({offsets[i], 0., 0.})});
}

std::vector<std::string> QuasiStatic::result_names() const {
  std::vector<std::string> names = {"forces"};
  for (const auto &tool : scene_.tools())
    if (tool.is_driven())
      names.push_back("travel of '" + tool.name() + "'");
  return names;
}

QuasiStatic::Probe QuasiStatic::probe(const double t, const double previous_step) {
  Probe probe;
  if (!body_failure_.empty()) // the step itself tells
    return probe;
  choose_contact_damping();
  is_probing_ = true;
  probe_.reset();
  const SoftnessLimit learnt = softness_;
  probe.newton = attempt_step(t, previous_step);
  softness_ = learnt;
  is_probing_ = false;
  if (probe.newton.converged) {
    probe.results = trial_results();
    probe_ = std::make_unique<ProbedState>(ProbedState{t, trial_, offsets_});
  }
  probe.newton.linear_iterations = linear_->take_iterations();
  append(probe.newton.diagnostics, linear_->take_diagnostics());
  return probe;
}

void QuasiStatic::measure_penetration(const Epetra_Vector &accepted, NewtonReport &report) {
  if (of_penetration_ && of_penetration_->with.empty()) // of no use any more
    return;
  if (!of_penetration_ && (!(force_scale_ > 0.) || !(find_penetration() > 0.))) {
    of_penetration_ = OfPenetration(); // nothing touches
    return;
  }
  Epetra_Vector x(accepted), residual(accepted), dx(accepted);
  double left = 0.;
  if (of_penetration_) { // tractions have been augmented in this step
    of_penetration_->without = trial_results();
    of_penetration_->residual = report.force;
    left = find_penetration() / of_penetration_->penetration;
  } else if (!(contacts_.empty() && body_contacts_.empty())) {
    of_penetration_ = OfPenetration{find_penetration(), trial_results(), {}, 0., 0};
    augment_contacts();
    // As far as the difference is known to some digits.
    constexpr unsigned int most_iterations = 4;
    constexpr double accurate = 0.05;
    const parameters::Solver &solver = scene_.parameters().solver;
    bool is_admissible = compute_residual(x, residual), is_accurate = false;
    while (is_admissible && !is_accurate && of_penetration_->n_iterations < most_iterations) {
      dx.PutScalar(0.);
      is_admissible = compute_tangent(x) && solve_tangent(residual, dx, solver.linear_tolerance);
      if (!is_admissible)
        break;
      x.Update(-1., dx, 1.);
      double energy = 0., norm = 0.;
      residual.Dot(dx, &energy);
      ++of_penetration_->n_iterations;
      is_admissible = compute_residual(x, residual);
      residual.Norm2(&norm);
      report.iterations.push_back({norm / force_scale_, std::abs(energy), 1.});
      of_penetration_->residual = norm / force_scale_;
      is_accurate = of_penetration_->residual <=
                    std::max(accuracy_ * solver.force_tolerance,
                             accurate * difference(trial_results(), of_penetration_->with));
    }
    if (is_admissible && is_accurate) {
      of_penetration_->without = trial_results();
      left = find_penetration() / of_penetration_->penetration;
    }
    take_back_augmentation();
  }
  if (!of_penetration_ || of_penetration_->without.empty())
    return;
  // What is left of the penetrations goes on like this: a geometric series.
  constexpr double most_left = 0.8;
  left = std::isfinite(left) ? std::min(most_left, left) : 0.;
  for (std::size_t group = 0; group < of_penetration_->with.size(); ++group)
    for (std::size_t i = 0; i < of_penetration_->with[group].size(); ++i)
      of_penetration_->without[group][i] +=
          left / (1. - left) * (of_penetration_->without[group][i] - of_penetration_->with[group][i]);
}

bool QuasiStatic::allow_less_penetration() {
  if (!of_penetration_ || of_penetration_->without.empty())
    return false;
  const double error = difference(of_penetration_->without, of_penetration_->with);
  if (!(error > allowed_at_measurement_ && allowed_at_measurement_ > 0.))
    return false;
  penetration_allowed_ = std::max(1., of_penetration_->penetration * allowed_at_measurement_ / error);
  return true;
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
