// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_CHECKS_H
#define BILLET_TESTS_CHECKS_H

#include <cstddef>
#include <iostream>
#include <string>
#include <vector>

/// What tests share that need not know deal.II; testing.h has the rest. All tests of a folder are one
/// program, which runs the test that its argument names:
///
///     namespace NAME_test {
///     BILLET_TEST(NAME) { check("what must hold", error, tolerance); }
///     } // namespace NAME_test
///
/// It fails if a check fails. What it prints last, its numbers, must be those of its line in the folder's
/// numbers.txt: how many checks there were, what record() got, and the work that was done.
namespace billet::testing {

/// A test of this program.
struct Test {
  std::string name;
  void (*run)();
  bool uses_mpi; ///< MPI is initialised before it runs
};

/// Returns the tests of this program.
inline std::vector<Test> &tests() {
  static std::vector<Test> all;
  return all;
}

/// Adds a test to the program.
struct Registration {
  Registration(const char *name, void (*run)(), const bool uses_mpi) {
    tests().push_back({name, run, uses_mpi});
  }
};

#define BILLET_REGISTER_TEST(name, uses_mpi)                                                                 \
  static void run_##name();                                                                                  \
  static const billet::testing::Registration registration_of_##name(#name, &run_##name, uses_mpi);           \
  static void run_##name()
/// A test that knows no other ranks.
#define BILLET_TEST(name) BILLET_REGISTER_TEST(name, false)
/// A test that runs with MPI, on as many ranks as its lines in numbers.txt say.
#define BILLET_MPI_TEST(name) BILLET_REGISTER_TEST(name, true)

/// Returns the arguments of the program behind the test's name.
inline std::vector<std::string> &arguments() {
  static std::vector<std::string> all;
  return all;
}

inline std::size_t &n_checks() {
  static std::size_t n = 0;
  return n;
}

inline std::size_t &n_failures() {
  static std::size_t n = 0;
  return n;
}

inline int exit_code() { return n_failures() == 0 ? 0 : 1; }

/// Prints the outcome of a check, with `detail` behind it.
inline void report_check(const std::string &name, const bool holds, const std::string &detail = "") {
  std::cout << name << ": " << (holds ? "ok" : "FAILED") << detail << std::endl;
  ++n_checks();
  n_failures() += holds ? 0 : 1;
}

inline void check(const std::string &name, const bool holds) { report_check(name, holds); }

/// Prints a number that must be the one of numbers.txt, within the tolerance that stands there.
inline void record(const std::string &name, const double value) {
  const auto digits = std::cout.precision(12);
  std::cout << "number " << name << " = " << value << std::endl;
  std::cout.precision(digits);
}

} // namespace billet::testing

#endif
