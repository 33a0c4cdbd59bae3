// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_WITHOUT_TRAPS_H
#define BILLET_WITHOUT_TRAPS_H

#include <cfenv>

namespace billet {

/// Disables trapping of floating-point exceptions during its lifetime, for computations that may
/// yield non-finite values and check for them.
class WithoutTraps {
public:
  WithoutTraps() { std::feholdexcept(&environment_); }
  ~WithoutTraps() { std::fesetenv(&environment_); }
  WithoutTraps(const WithoutTraps &) = delete;
  WithoutTraps &operator=(const WithoutTraps &) = delete;

private:
  std::fenv_t environment_{};
};

} // namespace billet

#endif
