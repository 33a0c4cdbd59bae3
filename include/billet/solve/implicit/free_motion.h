// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_FREE_MOTION_H
#define BILLET_SOLVE_IMPLICIT_FREE_MOTION_H

#include "billet/solve/implicit/implicit_problem.h"

#include <optional>
#include <set>
#include <string>

namespace billet {

/// A rigid-body mode of a body that supports and contacts do not resist.
struct FreeMode {
  RigidMotion motion;
  bool touches = false; ///< whether the body is in contact
};

/// Finds such a mode of the body, if there is one. Collective.
std::optional<FreeMode> find_free_mode(const ImplicitProblem &problem, std::size_t body);

/// Throws InputError if a body without stabilisation has such a mode at the start.
void check_free_modes(const ImplicitProblem &problem);

/// Returns why the run ends if a body has such a mode without these tools or supports; else an
/// empty text. `what_happens`: what they are at this time, such as "removed". Collective.
std::string describe_free_mode(const ImplicitProblem &problem, std::size_t body,
                               const std::set<std::string> &removed, const std::string &what_happens);

/// Returns how far tools and supports move by what the scene prescribes, in the step to time t
/// [length]. Collective.
double prescribed_motion(const ImplicitProblem &problem, double t);

/// Returns a failure if the trial state moves farther, in the step or in the run, than tools and
/// supports explain. For static scenes. Collective.
std::optional<StepFailure> judge_travel(const ImplicitProblem &problem, double t);

} // namespace billet

#endif
