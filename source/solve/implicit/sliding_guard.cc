// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/sliding_guard.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/solve/implicit/free_motion.h"

#include <algorithm>
#include <sstream>

namespace billet {

SlidingGuard::SlidingGuard(ImplicitProblem &problem) : problem_(problem) {
  if (has_fixed_steps() || parts_.contacts().empty())
    return;
  problem.judge_trials([this]() -> std::string {
    if (n_attempts_ % 2 == 1 || !has_forces())
      return "";
    const Sliding sliding = measure();
    if (sliding.facets <= Limits::max_sliding && n_refused_ <= Limits::max_refused)
      return "";
    return refuse(sliding);
  });
}

std::string SlidingGuard::refuse(const Sliding &sliding) {
  ++n_refused_;
  slides_too_far_ = true;
  refused_ = sliding.contact;
  return "nodes of contact pair '" + parts_.contacts()[sliding.contact].name() + "' slide too far";
}

bool SlidingGuard::has_fixed_steps() const {
  return parts_.parameters().time_stepping.control == parameters::TimeStepping::Control::fixed;
}

bool SlidingGuard::has_forces() const {
  const auto &driven = parts_.tools().unknown();
  return has_loads() || std::any_of(driven.begin(), driven.end(), [this](const std::size_t tool) {
           return parts_.scene().tools()[tool].load(problem_.step().time) != 0.;
         });
}

SlidingGuard::Sliding SlidingGuard::measure() const {
  const double expected = 2. * prescribed_motion(problem_, problem_.step().time);
  const std::vector<double> of_contacts = parts_.contacts().collect_max(
      [expected](const auto &contact) { return contact.measures().max_sliding(expected); });
  const auto maximum = std::max_element(of_contacts.begin(), of_contacts.end());
  return {*maximum, static_cast<std::size_t>(maximum - of_contacts.begin())};
}

bool SlidingGuard::has_loads() const {
  const auto &bodies = parts_.scene().bodies();
  return std::any_of(bodies.begin(), bodies.end(), [](const Body &body) { return !body.loads.empty(); });
}

Explanation SlidingGuard::describe(const std::size_t contact, const double t,
                                   const Explanation &cause) const {
  std::ostringstream text;
  text.precision(4);
  std::string advice;
  for (const std::size_t tool : parts_.tools().unknown()) {
    const Tool &which = parts_.scene().tools()[tool];
    if (which.load(t) == 0. || (has_loads() && !cause.empty())) // the loads slide the body
      continue;
    const bool turns = which.control() == Tool::Control::moment;
    text << (advice.empty() ? "" : ", and ") << "tool '" << which.name() << "' finds no resistance to its "
         << (turns ? "moment" : "force") << " of " << which.load(t) << " at time " << t << " and a "
         << (turns ? "turn" : "travel") << " of " << parts_.tools().start_offsets()[tool] << ": it jumps";
    for (std::size_t i = 0; i < friction_.size(); ++i)
      if (parts_.contacts()[i].rigid_tool() == tool && friction_[i].limit > 0.)
        text << ", while contact pair '" << parts_.contacts()[i].name() << "' bears a friction force of "
             << friction_[i].tangential << " of at most " << friction_[i].limit;
    advice = std::string("Use ") + (turns ? "'Rotation angle'" : "'Translation'") + " of the tool" +
             " instead of its load";
  }
  if (advice.empty() && cause.empty())
    text << "loads find no resistance at time " << t << ": bodies jump";
  text << (advice.empty() || cause.empty() ? "" : "; ") << cause.what << ". Nodes of contact pair '"
       << parts_.contacts()[contact].name() << "' slide by more than " << Limits::max_sliding
       << " facet sizes in a step of " << t - problem_.state().time << ", which contact cannot follow";
  append_sentences(advice, cause.advice);
  append_sentences(advice, "'Scheme = implicit dynamics' and 'explicit' resolve jumps");
  return {text.str(), advice};
}

std::optional<StepFailure> SlidingGuard::judge(const double t, DiagnosticList &messages) {
  const bool is_idle = parts_.contacts().empty() || !has_forces();
  const Sliding sliding = is_idle ? Sliding() : measure();
  if (sliding.facets > Limits::max_sliding && !has_fixed_steps())
    return StepFailure{StepFailure::Kind::slides, {refuse(sliding), ""}};
  n_attempts_ = 0;
  slides_too_far_ = false;
  cause_ = {};
  if (is_idle)
    return {};
  friction_ = parts_.contacts().friction_uses();
  if (sliding.facets <= Limits::max_sliding)
    return {};
  const Explanation why = describe(sliding.contact, t, {});
  messages.push_back(Diagnostic(diagnostic::untracked_sliding, why.what)
                         .time(t)
                         .measure("sliding [facet sizes]", sliding.facets)
                         .advice("Use 'Step control = automatic', which cuts such steps. " + why.advice));
  return {};
}

Explanation SlidingGuard::explain(const double t, const Explanation &cause) {
  if (!cause.empty())
    cause_ = cause;
  return slides_too_far_ ? describe(refused_, t, cause_) : Explanation();
}

} // namespace billet
