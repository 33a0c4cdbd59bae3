// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/penetration_measurement.h"

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

/// Returns the largest difference of a group, as part of it.
double difference(const StepResults::Groups &a, const StepResults::Groups &b,
                  const std::vector<double> &min_sizes) {
  double maximum = 0.;
  for (std::size_t group = 0; group < a.size(); ++group) {
    const double scale = std::max(size_of(b[group]), min_sizes[group]);
    if (scale > 0.)
      maximum = std::max(maximum, distance_of(a[group], b[group]) / scale);
  }
  return maximum;
}

} // namespace

bool StepResults::has_forces_of_contacts() const {
  const auto &pairs = parts_.scene().body_pairs();
  return !parts_.contacts().of_tools().empty() ||
         std::any_of(pairs.begin(), pairs.end(), [](const auto &pair) { return !pair.is_self_contact; });
}

StepResults::Groups StepResults::accepted() const {
  Groups results(1);
  for (const auto &load : problem_.state().tool_loads)
    results[0].push_back(load.force);
  for (const auto &load : problem_.state().body_pair_loads)
    results[0].push_back(load.force);
  if (!has_forces_of_contacts())
    results[0].push_back(dealii::Tensor<1, 3>({problem_.step().start.supports.l2_norm(), 0., 0.}));
  add_travels(parts_.tools().start_offsets(), results);
  return results;
}

StepResults::Groups StepResults::of_trial() const {
  Groups results(1);
  const Contacts::Loads loads = parts_.contacts().compute_loads();
  for (const auto *of : {&loads.of_tools, &loads.of_body_pairs})
    for (const ContactLoad &load : *of)
      results[0].push_back(load.force);
  if (!has_forces_of_contacts())
    results[0].push_back(dealii::Tensor<1, 3>({problem_.step().trial.supports.l2_norm(), 0., 0.}));
  add_travels(parts_.tools().offsets(), results);
  return results;
}

void StepResults::add_travels(const std::vector<double> &offsets, Groups &results) const {
  const auto &tools = parts_.scene().tools();
  for (std::size_t i = 0; i < tools.size(); ++i)
    if (tools[i].is_driven())
      results.push_back({dealii::Tensor<1, 3>({offsets[i], 0., 0.})});
}

std::vector<double> StepResults::min_sizes() const {
  std::vector<double> sizes(1, 0.);
  const double work = std::abs(problem_.state().energies.external), time = problem_.state().time;
  const auto &tools = parts_.scene().tools();
  for (std::size_t i = 0; i < tools.size(); ++i)
    if (tools[i].is_driven()) {
      const double reach = parts_.discretization().radius() / parts_.tools().unit_of(i);
      // Without work there may have been no step, and no load yet.
      const double load = work > 0. ? std::abs(tools[i].load(time)) : 0.;
      sizes.push_back(work < load * reach ? work / load : work > 0. ? reach : 0.);
    }
  return sizes;
}

std::vector<std::string> StepResults::names() const {
  std::vector<std::string> names = {"forces"};
  for (const auto &tool : parts_.scene().tools())
    if (tool.is_driven())
      names.push_back("travel of '" + tool.name() + "'");
  return names;
}

void PenetrationMeasurement::begin_with_augmentation() {
  if (is_wanted_ && !measured_)
    measured_ = OfPenetration{parts_.contacts().find_penetration(), results_.of_trial(), {}, 0., 0};
}

void PenetrationMeasurement::measure(const Vector &accepted, const double accuracy, NewtonReport &report) {
  if (measured_ && measured_->with.empty()) // discarded
    return;
  if (!measured_ && (!(problem_.force_scale() > 0.) || !(parts_.contacts().find_penetration() > 0.))) {
    measured_ = OfPenetration(); // no contact
    return;
  }
  double left = 0.;
  if (measured_) { // tractions have been augmented in this step
    measured_->without = results_.of_trial();
    measured_->residual = report.force;
    left = parts_.contacts().find_penetration() / measured_->penetration;
  } else if (!parts_.contacts().empty())
    left = augment_once(accepted, accuracy, report);
  if (!measured_ || measured_->without.empty())
    return;
  left = std::isfinite(left) ? std::min(Limits::max_left, left) : 0.;
  for (std::size_t group = 0; group < measured_->with.size(); ++group)
    for (std::size_t i = 0; i < measured_->with[group].size(); ++i)
      measured_->without[group][i] +=
          left / (1. - left) * (measured_->without[group][i] - measured_->with[group][i]);
}

double PenetrationMeasurement::augment_once(const Vector &accepted, const double accuracy,
                                            NewtonReport &report) {
  Vector x(accepted), residual(accepted), dx(accepted);
  double left = 0.;
  const std::vector<double> min_sizes = results_.min_sizes();
  measured_ = OfPenetration{parts_.contacts().find_penetration(), results_.of_trial(), {}, 0., 0};
  for (auto &contact : parts_.contacts())
    contact.penalties().augment();
  const parameters::Solver &solver = parts_.parameters().solver;
  bool is_admissible = problem_.compute_residual(x, residual), is_accurate = false;
  while (is_admissible && !is_accurate && measured_->n_iterations < Limits::max_iterations) {
    dx = 0.;
    is_admissible =
        problem_.compute_tangent(x) && problem_.solve_tangent(residual, dx, solver.linear_tolerance);
    if (!is_admissible)
      break;
    x -= dx;
    const double energy = residual * dx;
    ++measured_->n_iterations;
    is_admissible = problem_.compute_residual(x, residual);
    const double norm = residual.l2_norm();
    report.iterations.push_back({norm / problem_.force_scale(), std::abs(energy), 1.});
    measured_->residual = norm / problem_.force_scale();
    is_accurate = measured_->residual <=
                  std::max(accuracy * solver.force_tolerance,
                           Limits::accuracy * difference(results_.of_trial(), measured_->with, min_sizes));
  }
  if (is_admissible && is_accurate) {
    measured_->without = results_.of_trial();
    left = parts_.contacts().find_penetration() / measured_->penetration;
  }
  parts_.contacts().take_back_augmentation();
  return left;
}

double PenetrationMeasurement::find_allowed() const {
  if (!measured_ || measured_->without.empty())
    return 0.;
  const double error = difference(measured_->without, measured_->with, results_.min_sizes());
  if (!(error > allowed_ && allowed_ > 0.))
    return 0.;
  return std::max(1., measured_->penetration * allowed_ / error);
}

} // namespace billet
