// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/stable_step.h"

#include "billet/contact/overlap.h"
#include "billet/diagnostic_kinds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace billet {

namespace {

/// Limits, as parts of a stable step.
struct StableStepLimits {
  /// Minimum step for nodes that come through surfaces, as part of the stable step, (E5).
  static constexpr double shortest = 0.25;
  /// Stable step of the elements, over that at the start, below which the run would hardly end.
  static constexpr double collapsed = 1e-5;
  /// The same below which an element is reported as flat.
  static constexpr double flat = 0.01;
  /// Stable step over that of the elements alone, below which the penalty is reported as too high.
  static constexpr double much_shorter = 0.1;
};

constexpr const char *flat_element_advice =
    "Try a finer mesh, or better shaped elements, where deformation is largest, or a hardening material";

} // namespace

bool StableStep::update(const StepBounds &own, const double of_tools, const MPI_Comm communicator) {
  // ω² <= ω_e² + max Σ k/m by Gershgorin, and with damping ω² Δt²/4 + Δt c/(2 m) <= 1. Each bound
  // is reduced over all ranks before they are combined: else the step would depend on the
  // partition.
  std::array<double, 3> bounds{own.element_step, -own.frequency_square, -own.damping_rate};
  MPI_Allreduce(MPI_IN_PLACE, bounds.data(), 3, MPI_DOUBLE, MPI_MIN, communicator);
  value_ = bounds[0];
  if (value_ < 0.)
    return false;
  of_elements_ = bounds[0];
  if (of_elements_first_ == 0.)
    of_elements_first_ = of_elements_;
  bounds[1] -= of_tools;
  const double a = 1. / (bounds[0] * bounds[0]) - 0.25 * bounds[1], b = -0.5 * bounds[2];
  value_ = 2. / (b + std::sqrt(b * b + 4. * a));
  return true;
}

double StableStep::usual_with(const double frequency_square, const MPI_Comm communicator) const {
  const double of_contact = dealii::Utilities::MPI::max(frequency_square, communicator);
  return factor_ * safety_factor_ / std::sqrt(1. / (of_elements_ * of_elements_) + 0.25 * of_contact);
}

double StableStep::allowed(const double crossing_step) const {
  const double stable = usual();
  return std::min(stable, std::max(factor_ * crossing_step, StableStepLimits::shortest * stable));
}

bool StableStep::is_set_by_contact() const { return value_ < StableStepLimits::much_shorter * of_elements_; }

std::string StableStep::describe_flat_elements() const {
  std::ostringstream text;
  text.precision(3);
  text << "the stable step of the elements falls to " << of_elements_ << ", from " << of_elements_first_
       << " at the start, since one element is nearly flat";
  return text.str();
}

Explanation StableStep::describe_collapse() const {
  if (!(of_elements_ < StableStepLimits::collapsed * of_elements_first_))
    return {};
  return {describe_flat_elements() + ", so the run cannot finish in reasonable time", flat_element_advice};
}

DiagnosticList StableStep::check_elements(const double t) const {
  if (!(of_elements_ < StableStepLimits::flat * of_elements_first_))
    return {};
  std::string text = describe_flat_elements();
  text.front() = 'T';
  return {Diagnostic(diagnostic::flat_elements, text)
              .time(t)
              .value("stable step", of_elements_)
              .advice(flat_element_advice)};
}

DiagnosticList StableStep::check(const double t, const Contacts &contacts,
                                 const MPI_Comm communicator) const {
  DiagnosticList messages;
  if (is_set_by_contact()) {
    std::vector<double> room = // by pair, on all ranks
        contacts.collect([](const auto &contact) { return contact.penalties().stiffening_left(); });
    dealii::Utilities::MPI::min(room, communicator, room);
    const auto stiffest = std::min_element(room.begin(), room.end());
    const auto i = static_cast<std::size_t>(stiffest - room.begin());
    if (stiffest != room.end() && *stiffest < 1. && contacts[i].settings().input->penalty.is_given) {
      std::ostringstream text;
      text.precision(3);
      text << "The penalty, " << enough_penalty / *stiffest << " E/h, makes steps "
           << std::round(of_elements_ / value_) << " times shorter than the elements require";
      messages.push_back(Diagnostic(diagnostic::penalty_too_high, text.str())
                             .pair(contacts[i].name())
                             .time(t)
                             .value("penalty [E/h]", enough_penalty / *stiffest));
    }
  }
  append(messages, check_elements(t));
  return messages;
}

} // namespace billet
