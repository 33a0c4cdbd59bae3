// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_WITHOUT_TRAPS_H
#define BILLET_WITHOUT_TRAPS_H

#include <cfenv>

namespace billet {

/// In programs in which floating-point exceptions are trapped: as long as one of these lives, they are not.
/// For what may well be no number, and is looked at before it is used.
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
