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
  for (const double penetration : of_contacts([](const auto &contact) {
         return contact.settings().has_tolerance() ? 0. : contact.penetration().of_facet;
       }))
    of_penalties = std::max(of_penalties, penetration);
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

std::vector<double> QuasiStatic::stiffen_slow_contacts(const std::vector<double> &before,
                                                       const std::vector<double> &errors,
                                                       const std::vector<double> &added) {
  // An augmentation leaves K/(K + k) of the gap, K the stiffness of the bodies there and k the penalty's.
  constexpr double slow = 0.25, wanted = 0.1; // Bertsekas, Constrained Optimization, 1982, sec. 2.2.5
  // Where softness is what counts. Stiff springs between facets that do not fit hold more than their mean
  // gaps: pairs of bodies are as stiff only where an augmentation adds nearly all that springs hold to the
  // force, as where bodies are confined.
  constexpr double nearly_all = 0.98, much = 100., more_of_tools = 100., more_of_confined = 1e4;
  std::vector<double> room = stiffening_left(), factors(errors.size(), 1.);
  const std::vector<bool> limits =
      of_contacts([](const auto &contact) { return contact.settings().limits_softness(); });
  bool is_stiffer = false;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double left = errors[i] / before[i];
    if (limits[i])
      room[i] *= added[i] > nearly_all && errors[i] > much ? more_of_confined
                 : i < contacts_.size()                    ? more_of_tools
                                                           : 1.;
    if (!(errors[i] > 1. && left > slow && room[i] >= 2.))
      continue;
    factors[i] =
        whole_octaves(left < 1. ? std::min(room[i], left / (1. - left) * (1. - wanted) / wanted) : room[i]);
    is_stiffer = true;
    stiffen(i, factors[i]);
  }
  if (is_stiffer)
    spring_round_off_ = find_spring_round_off();
  return factors;
}

bool QuasiStatic::soften_augmented_contacts(DiagnosticList &messages) {
  const std::vector<double> room = stiffening_left();
  const std::vector<std::string> names = of_contacts([](const auto &contact) { return contact.name(); });
  const std::vector<bool> is_augmented =
      of_contacts([](const auto &contact) { return contact.settings().is_augmented(); });
  bool has_softened = false;
  for (std::size_t i = 0; i < room.size(); ++i) {
    if (!(room[i] < 1.) || !is_augmented[i])
      continue;
    const double factor = whole_octaves(room[i]), penalty = enough_penalty / room[i] * factor;
    stiffen(i, factor);
    has_softened = true;
    std::ostringstream text;
    text << "The penalty was reduced to " << penalty
         << " E/h, since Newton's method failed; augmentation makes up for that";
    messages.push_back(Diagnostic(diagnostic::penalty_reduced, text.str())
                           .pair(names[i])
                           .time(time_)
                           .value("penalty [E/h]", penalty));
  }
  spring_round_off_ = find_spring_round_off();
  return has_softened;
}

void QuasiStatic::augment_contacts() {
  for (auto &contact : contacts_)
    contact.augment();
  for (auto &contact : body_contacts_)
    contact->augment();
}

QuasiStatic::AugmentationDemands
QuasiStatic::augmentation_demands(const std::vector<ContactSprings> &springs) const {
  AugmentationDemands demands;
  demands.of_contacts = augmentation_errors();
  for (double &demand : demands.of_contacts) {
    demand /= penetration_allowed_;
    demands.by_tolerances = std::max(demands.by_tolerances, demand);
  }
  demands.largest = demands.by_tolerances;
  if (springs.empty())
    return demands;
  const std::vector<double> excess = softness_.excess(springs);
  for (std::size_t i = 0; i < excess.size(); ++i) {
    demands.of_contacts[i] = std::max(demands.of_contacts[i], excess[i]);
    demands.largest = std::max(demands.largest, excess[i]);
  }
  return demands;
}

std::vector<ContactSprings> QuasiStatic::contact_springs() const {
  if (!softness_.is_used())
    return {};
  auto springs = of_contacts([](const auto &contact) { return contact.compute_springs(); });
  std::vector<double> sums;
  for (const auto &[normal, tangential] : springs)
    sums.insert(sums.end(), {normal.force, normal.held, tangential.force, tangential.held});
  dealii::Utilities::MPI::sum(sums, discretization_.communicator(), sums);
  for (std::size_t i = 0; i < springs.size(); ++i) {
    springs[i].normal.force = sums[4 * i];
    springs[i].normal.held = sums[4 * i + 1];
    springs[i].tangential.force = sums[4 * i + 2];
    springs[i].tangential.held = sums[4 * i + 3];
  }
  return springs;
}

std::vector<std::array<SoftnessLimit::Change, 2>>
QuasiStatic::changes_of(const std::vector<ContactSprings> &before,
                        const std::vector<ContactSprings> &after) const {
  constexpr std::size_t n_sums = 4;
  std::vector<double> sums;
  std::vector<std::array<SoftnessLimit::Change, 2>> changes(after.size());
  for (std::size_t i = 0; i < after.size(); ++i)
    for (const auto direction : {&ContactSprings::normal, &ContactSprings::tangential}) {
      const auto &then = (before[i].*direction).of_nodes, &now = (after[i].*direction).of_nodes;
      double of_nodes = 0.;
      dealii::Tensor<1, 3> in_all;
      for (std::size_t n = 0; n < now.size(); ++n) {
        of_nodes += (now[n] - then[n]).norm();
        in_all += now[n] - then[n];
      }
      sums.insert(sums.end(), {of_nodes, in_all[0], in_all[1], in_all[2]});
    }
  dealii::Utilities::MPI::sum(sums, discretization_.communicator(), sums);
  for (std::size_t i = 0; i < after.size(); ++i)
    for (std::size_t d = 0; d < 2; ++d) {
      const double *sum = sums.data() + n_sums * (2 * i + d);
      const double scalar = d == 0 ? after[i].normal.force - before[i].normal.force
                                   : after[i].tangential.force - before[i].tangential.force;
      changes[i][d] = {sum[0], std::max(std::abs(scalar), std::hypot(sum[1], sum[2], sum[3]))};
    }
  return changes;
}

void QuasiStatic::augment_where_asked() {
  for (auto &contact : contacts_)
    if (contact.settings().is_augmented())
      contact.augment();
  for (auto &contact : body_contacts_)
    if (contact->settings().is_augmented())
      contact->augment();
}

void QuasiStatic::augment(NewtonReport &report, std::vector<double> &offsets, Vector &displacements) {
  const unsigned int most = scene_.parameters().solver.most_augmentations;
  // What limits softness alone fails no step: it is told at the end.
  constexpr unsigned int most_of_softness = 6;
  // Residuals leave gaps, too: where augmentations do not close them, residuals have to be smaller.
  constexpr double slow = 0.5, smaller = 0.1, smallest = 0.01;
  const double accuracy = accuracy_;
  double last_error = std::numeric_limits<double>::infinity();
  std::vector<double> before, stiffer(contacts_.size() + body_contacts_.size(), 1.),
      added(stiffer.size(), 0.);
  std::unique_ptr<Vector> soft;
  std::vector<double> soft_offsets;
  const std::size_t hardest = report.hardest;
  Pace pace;
  softness_.begin();
  std::vector<ContactSprings> springs = contact_springs();
  for (unsigned int n = 0; report.converged; ++n) {
    const AugmentationDemands demands = augmentation_demands(springs);
    const double error = demands.largest;
    const bool is_of_softness = demands.by_tolerances <= 1.;
    if (error <= 1.)
      break;
    if (error > slow * last_error)
      accuracy_ = std::max(smaller * accuracy_, smallest * accuracy);
    last_error = error;
    pace.add(error);
    if (is_of_softness && (n >= most_of_softness || pace.is_hopeless(most_of_softness)))
      break;
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
    if (is_of_softness && n == 0) {
      soft = std::make_unique<Vector>(displacements);
      soft_offsets = offsets;
    }
    augment_where_asked();
    if (n > 0) {
      const std::vector<double> factors = stiffen_slow_contacts(before, demands.of_contacts, added);
      for (std::size_t i = 0; i < factors.size(); ++i)
        stiffer[i] *= factors[i];
    }
    before = demands.of_contacts;
    report.append(iterate(offsets, displacements));
    if (!report.converged && soft && is_of_softness) { // as it was before
      for (std::size_t i = 0; i < stiffer.size(); ++i)
        if (stiffer[i] != 1.)
          stiffen(i, 1. / stiffer[i]);
      take_back_augmentation();
      displacements = *soft;
      offsets = soft_offsets;
      const NewtonReport again = iterate(offsets, displacements);
      report.append(again);
      // What found no end in a short step finds none in a shorter one.
      report.hardest = std::max(hardest, again.hardest);
      break;
    }
    if (const auto after = contact_springs(); report.converged && !after.empty()) {
      const auto changes = changes_of(springs, after);
      softness_.learn(springs, changes);
      // Where bodies hardly give way springs keep what they hold, and as much is added to the force. Beside a
      // much larger force that tells nothing: friction may be what is augmented.
      constexpr double least_held = 0.05, kept = 0.9;
      for (std::size_t i = 0; i < added.size(); ++i) {
        const ContactSprings::Direction &then = springs[i].normal, &now = after[i].normal;
        added[i] = then.held > least_held * then.force && now.held > kept * then.held
                       ? changes[i][0].in_all / then.held
                       : 0.;
      }
      springs = after;
    }
  }
  accuracy_ = accuracy;
}

void QuasiStatic::take_back_augmentation() {
  for (auto &contact : contacts_)
    contact.take_back_augmentation();
  for (auto &contact : body_contacts_)
    contact->take_back_augmentation();
}

} // namespace billet
