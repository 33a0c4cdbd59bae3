// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TRIAL_H
#define BILLET_TRIAL_H

#include <functional>

namespace billet {

/// Limits of a trial.
struct TrialLimits {
  unsigned int seconds;  ///< of processor time
  std::size_t megabytes; ///< of memory, in addition to that of this process
};

enum class TrialEnd { returned, crashed, out_of_time, out_of_memory };

/// Calls `action` in a copy of this process, and returns how it ended: a library may crash or never
/// end on a damaged file. The changes and the output of `action` stay in the copy. It may throw,
/// which counts as a return, and must not communicate with other ranks. If the system allows no
/// copy, the function returns TrialEnd::returned without a call.
TrialEnd try_in_copy(const TrialLimits &limits, const std::function<void()> &action);

} // namespace billet

#endif
