// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/path_guard.h"

#include "billet/diagnostic_kinds.h"

#include <cmath>
#include <sstream>

namespace billet {

namespace {

constexpr const char *goes_unseen = " reverses, or turns fully, within the step";

StepFailure explained(const Explanation &why) { return {StepFailure::Kind::explained, why}; }

} // namespace

bool PathGuard::may_be_cut(const double t) const {
  const auto &stepping = parts_.parameters().time_stepping;
  return stepping.control == parameters::TimeStepping::Control::automatic &&
         t - problem_.state().time > stepping.min_step * (1. + Limits::rounding);
}

std::optional<StepFailure> PathGuard::judge_thin_tools() const {
  for (const auto &contact : parts_.contacts())
    if (contact.checks().may_let_nodes_through() &&
        !problem_.on_all_ranks(!contact.checks().lets_nodes_through()))
      return explained(contact.checks().describe_passage());
  return {};
}

std::optional<StepFailure> PathGuard::judge_path(const bool is_thorough) {
  if (problem_.find_free_part(is_thorough) == 1.)
    return {};
  return explained({problem_.obstacle() + ", or penetrate more than contact can track",
                    "Try a smaller 'Minimum step', a larger 'Normal penalty' or smaller facets"});
}

std::optional<StepFailure> PathGuard::judge_turns(const double t) const {
  const SolutionState &state = problem_.state();
  for (const auto &contact : parts_.contacts().of_tools()) {
    const std::size_t tool = contact.tool();
    const double angle =
        std::abs(parts_.tools().place(tool, t, parts_.tools().offsets()[tool]).rotation_angle -
                 state.placements[tool].rotation_angle);
    if (parts_.removal().is_removed(tool) || !contact.settings().has_friction() ||
        angle <= Limits::max_turn * (1. + Limits::rounding) ||
        !(state.tool_loads[tool].area > 0. ||
          !problem_.on_all_ranks(!contact.measures().has_touching_nodes())))
      continue;
    std::ostringstream text;
    text.precision(3);
    text << "tool '" << parts_.scene().tools()[tool].name() << "' turns by " << angle * 180. / M_PI
         << " degrees in the step, but friction allows at most " << Limits::max_turn * 180. / M_PI;
    const bool is_fixed =
        parts_.parameters().time_stepping.control == parameters::TimeStepping::Control::fixed;
    return explained(
        {text.str(), std::string("Try a smaller ") + (is_fixed ? "'Initial step'" : "'Minimum step'")});
  }
  return {};
}

std::optional<StepFailure> PathGuard::judge_prescribed_motion(const double t) const {
  if (!may_be_cut(t))
    return {};
  const std::string unseen = motions_.find_unseen(problem_.state().time, t);
  if (unseen.empty())
    return {};
  return explained({unseen + goes_unseen, ""});
}

DiagnosticList PathGuard::check_motion(const double t) const {
  if (may_be_cut(t)) // but was not cut
    return {};
  const std::string unseen = motions_.find_unseen(problem_.state().time, t);
  if (unseen.empty())
    return {};
  return {Diagnostic(diagnostic::unseen_motion, unseen + goes_unseen).time(t)};
}

std::optional<StepFailure> PathGuard::judge_first_contact(const double t) const {
  if (!may_be_cut(t))
    return {};
  const double maximum =
      parts_.contacts().max([](const auto &contact) { return contact.measures().closing_of_new_contacts(); });
  if (!(maximum > Limits::max_closing))
    return {};
  std::ostringstream text;
  text.precision(3);
  text << "nodes approach by " << maximum << " facet sizes in the step of first contact; allowed are "
       << Limits::max_closing;
  return explained({text.str(), ""});
}

} // namespace billet
