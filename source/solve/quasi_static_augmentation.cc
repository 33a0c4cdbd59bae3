// SPDX-License-Identifier: LGPL-2.1-or-later
// The augmented Lagrangian of contacts with a 'Penetration tolerance'.
#include "billet/diagnostic_kinds.h"
#include "billet/solve/quasi_static.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

namespace {

/// What augmentations are left with, one after the other, as part of what is asked for.
class Pace {
public:
  void add(const double error) { errors_.push_back(error); }

  /// What each of the last augmentations left of the error, in the mean.
  double ratio() const {
    return std::pow(errors_.back() / errors_[errors_.size() - 1 - window], 1. / window);
  }
  /// Whether, at this pace, the error will be above 1 after `most` augmentations.
  bool is_hopeless(const unsigned int most) const {
    const auto n = static_cast<unsigned int>(errors_.size()) - 1;
    return n >= 2 * window && std::log(errors_.back()) + (most - n) * std::log(ratio()) > 0.;
  }
  /// So many more it would take; the error has to fall.
  double to_go() const { return std::ceil(-std::log(errors_.back()) / std::log(ratio())); }

private:
  static constexpr unsigned int window = 5;
  std::vector<double> errors_;
};

} // namespace

std::vector<double> QuasiStatic::augmentation_errors() const {
  std::vector<double> errors = of_contacts([](const auto &contact) { return contact.augmentation_error(); });
  dealii::Utilities::MPI::max(errors, discretization_.communicator(), errors);
  return errors;
}

double QuasiStatic::augmentation_error() const {
  double error = 0.;
  for (const double of_contact : augmentation_errors())
    error = std::max(error, of_contact);
  return error;
}

double QuasiStatic::find_penetration() const {
  constexpr double unit = 1e-5; // facet sizes: the tightest tolerance that a target error sets
  double of_penalties = 0.;
  for (const auto &contact : contacts_)
    if (scene_.pairs()[contact.pair()].penetration_tolerance == 0.)
      of_penalties = std::max(of_penalties, contact.penetration().of_facet);
  for (std::size_t i = 0; i < body_contacts_.size(); ++i)
    if (scene_.body_pairs()[i].penetration_tolerance == 0.)
      of_penalties = std::max(of_penalties, body_contacts_[i]->penetration().of_facet);
  return std::max(augmentation_error(),
                  dealii::Utilities::MPI::max(of_penalties, discretization_.communicator()) / unit);
}

double QuasiStatic::find_spring_round_off() const {
  const double reach = discretization_.centre().norm() + discretization_.radius();
  double force = 0.;
  for (const auto &contact : contacts_)
    force = std::max(force, contact.largest_spring() * (reach + contact.tool_reach()));
  for (const auto &contact : body_contacts_)
    force = std::max(force, contact->largest_spring() * reach);
  // Three times what the last bit of a position makes.
  return 3. * std::numeric_limits<double>::epsilon() *
         dealii::Utilities::MPI::max(force, discretization_.communicator());
}

std::vector<double> QuasiStatic::stiffening_left() const {
  std::vector<double> room = of_contacts([](const auto &contact) { return contact.stiffening_left(); });
  dealii::Utilities::MPI::min(room, discretization_.communicator(), room);
  return room;
}

void QuasiStatic::stiffen(const std::size_t contact, const double factor) {
  if (contact < contacts_.size())
    contacts_[contact].stiffen(factor);
  else
    body_contacts_[contact - contacts_.size()]->stiffen(factor);
}

void QuasiStatic::stiffen_slow_contacts(const std::vector<double> &before,
                                        const std::vector<double> &errors) {
  // An augmentation leaves K/(K + k) of the gap, K the stiffness of the bodies there and k the penalty's.
  constexpr double slow = 0.25, wanted = 0.1; // Bertsekas, Constrained Optimization, 1982, sec. 2.2.5
  const std::vector<double> room = stiffening_left();
  bool is_stiffer = false;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double left = errors[i] / before[i];
    if (!(errors[i] > penetration_allowed_ && left > slow && room[i] > 1.))
      continue;
    const double factor =
        left < 1. ? std::min(room[i], left / (1. - left) * (1. - wanted) / wanted) : room[i];
    is_stiffer = true;
    stiffen(i, factor);
  }
  if (is_stiffer)
    spring_round_off_ = find_spring_round_off();
}

DiagnosticList QuasiStatic::soften_augmented_contacts() {
  const std::vector<double> room = stiffening_left();
  DiagnosticList messages;
  for (std::size_t i = 0; i < room.size(); ++i) {
    if (!(room[i] < 1.))
      continue;
    const bool is_tool = i < contacts_.size();
    if ((is_tool ? scene_.pairs()[contacts_[i].pair()].penetration_tolerance
                 : scene_.body_pairs()[i - contacts_.size()].penetration_tolerance) == 0.)
      continue;
    stiffen(i, room[i]);
    std::ostringstream text;
    text << "The penalty was reduced to " << enough_penalty
         << " E/h, since Newton's method failed; augmentation enforces the 'Penetration tolerance'";
    messages.push_back(Diagnostic(diagnostic::penalty_reduced, text.str())
                           .pair(is_tool ? scene_.pairs()[contacts_[i].pair()].name
                                         : body_contacts_[i - contacts_.size()]->name())
                           .time(time_)
                           .value("penalty [E/h]", enough_penalty));
  }
  spring_round_off_ = find_spring_round_off();
  return messages;
}

void QuasiStatic::augment_contacts() {
  for (auto &contact : contacts_)
    contact.augment();
  for (auto &contact : body_contacts_)
    contact->augment();
}

void QuasiStatic::augment(NewtonReport &report, std::vector<double> &offsets, Vector &displacements) {
  const unsigned int most = scene_.parameters().solver.most_augmentations;
  // Residuals leave gaps, too: where augmentations do not close them, residuals have to be smaller.
  constexpr double slow = 0.5, smaller = 0.1, smallest = 0.01;
  const double accuracy = accuracy_;
  double last_error = std::numeric_limits<double>::infinity();
  std::vector<double> before;
  Pace pace;
  for (unsigned int n = 0; report.converged; ++n) {
    const std::vector<double> errors = augmentation_errors();
    double error = 0.;
    for (const double of_contact : errors)
      error = std::max(error, of_contact / penetration_allowed_);
    if (error <= 1.)
      break;
    if (error > slow * last_error)
      accuracy_ = std::max(smaller * accuracy_, smallest * accuracy);
    last_error = error;
    pace.add(error);
    if (n == most || pace.is_hopeless(most)) {
      if (may_leave_penetration_)
        break;
      std::ostringstream message;
      message << "after " << n << " augmentations contact is still " << error
              << " times its 'Penetration tolerance' from what it should be";
      if (n < most && pace.ratio() < 1.)
        message << ", and at their pace, each leaves " << pace.ratio() << " of that, it would take "
                << pace.to_go() << " more";
      else if (n < most)
        message << ", and they no longer lessen it";
      message << ": try a larger penalty or 'Penetration tolerance', "
              << (motion_ ? "or none: nodes that have come in would have to stop within a step"
                          : "or more 'Most augmentations'");
      report.converged = false;
      report.failure = message.str();
      break;
    }
    if (measures_penetration_ && !is_probing_ && !of_penetration_)
      of_penetration_ = OfPenetration{find_penetration(), trial_results(), {}, 0., 0};
    augment_contacts();
    if (n > 0)
      stiffen_slow_contacts(before, errors);
    before = errors;
    report.append(iterate(offsets, displacements));
  }
  accuracy_ = accuracy;
}

} // namespace billet
