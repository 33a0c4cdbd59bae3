// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_STEP_FAILURE_H
#define BILLET_SOLVE_STEP_FAILURE_H

#include "billet/diagnostics.h"

#include <optional>

namespace billet {

/// Reason to reject the trial state of a step, whatever its residual.
struct StepFailure {
  enum class Kind {
    explained,    ///< only a shorter step helps
    slides,       ///< nodes slide too far: the iterations may have left their path
    penetrates,   ///< higher penalties help
    makes_energy, ///< damping of contact helps
    round_off     ///< round-off of contact exceeds its permitted part of the forces
  };
  Kind kind;
  Explanation why;
};

/// Asks the judges one after the other, up to the first failure; none: all accept. A judge is a
/// function without arguments that returns a std::optional<StepFailure>.
template <class... Judges> std::optional<StepFailure> find_first_failure(const Judges &...judges) {
  std::optional<StepFailure> failure;
  static_cast<void>((... || (failure = judges()).has_value()));
  return failure;
}

} // namespace billet

#endif
