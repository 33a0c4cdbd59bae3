// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_CHECKS_H
#define BILLET_TESTS_CHECKS_H

#include <iostream>
#include <string>

/// What tests share that need not know deal.II; testing.h has the rest. A test prints one line per case,
/// `name: ok` or `name: FAILED`, so that its .output holds names only, and ends with `return
/// billet::testing::exit_code();`.
namespace billet::testing {

inline unsigned int &n_failures() {
  static unsigned int n = 0;
  return n;
}

inline int exit_code() { return n_failures() == 0 ? 0 : 1; }

inline void check(const std::string &name, const bool holds) {
  std::cout << name << ": " << (holds ? "ok" : "FAILED") << std::endl;
  n_failures() += holds ? 0 : 1;
}

} // namespace billet::testing

#endif
