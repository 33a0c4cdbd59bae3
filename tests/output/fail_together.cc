// SPDX-License-Identifier: LGPL-2.1-or-later
// An exception on one rank reaches all ranks with its whole diagnostic.
#include "billet/fail_together.h"
#include "../testing.h"
#include "billet/diagnostic_kinds.h"

#include <deal.II/base/mpi.h>

#include <functional>
#include <limits>
#include <stdexcept>

namespace fail_together_test {

using namespace billet;
using billet::testing::check;

namespace {

Diagnostic full_diagnostic() {
  return Diagnostic(diagnostic::energy_drift, "The energy \"drifts\"\nby \xff")
      .pair("top")
      .body("ball")
      .at(dealii::Tensor<1, 3>({0.1, 1. / 3., -std::numeric_limits<double>::infinity()}))
      .time(0.7)
      .value("depth", 0.1)
      .measure("drift [%]", 12.3)
      .value("depth", std::numeric_limits<double>::infinity())
      .advice("Do this");
}

bool is_same(const Diagnostic &a, const Diagnostic &b) {
  return a.text() == b.text() && a.json() == b.json() && a.what() == b.what() &&
         a.identity() == b.identity() && a.values() == b.values() && a.measure() == b.measure();
}

/// Whether the action, on the last rank alone, makes every rank throw an `Error` that `holds`.
template <class Error>
bool all_throw(const std::function<void()> &action, const std::function<bool(const Error &)> &holds) {
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  int passes = 0;
  try {
    fail_together(MPI_COMM_WORLD, [&] {
      if (rank + 1 == n_ranks)
        action();
    });
  } catch (const Error &error) {
    passes = holds(error) ? 1 : 0;
  }
  return dealii::Utilities::MPI::min(passes, MPI_COMM_WORLD) == 1;
}

} // namespace

BILLET_MPI_TEST(fail_together) {
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit); // one rank prints

  const Diagnostic full = full_diagnostic();
  check("the text has all parts",
        full.text().find("(pair 'top', body 'ball', at (0.1, 0.33333, -inf), time 0.7). Do this.") !=
            std::string::npos);
  check("a failure keeps its diagnostic",
        all_throw<SolutionFailure>([&] { throw SolutionFailure(full); },
                                   [&](const auto &error) {
                                     return is_same(error.diagnostic(), full) && error.what() == full.what();
                                   }));
  check("a lost file has advice apart from its name",
        all_throw<SolutionFailure>([&] { throw file_lost("history.csv"); },
                                   [](const auto &error) {
                                     return error.what() == std::string("history.csv cannot be written") &&
                                            error.diagnostic().advice() == "Check whether the disk is full";
                                   }));
  check("an input error, too",
        all_throw<InputError>([&] { throw InputError(full); },
                              [&](const auto &error) { return is_same(error.diagnostic(), full); }));
  const Diagnostic plain(diagnostic::bad_input, "It's wrong");
  check("a plain text stays plain", all_throw<InputError>([] { throw InputError("It's wrong"); },
                                                          [&](const auto &error) {
                                                            return is_same(error.diagnostic(), plain) &&
                                                                   error.diagnostic().text() ==
                                                                       "error[bad-input]: It's wrong.";
                                                          }));
  check("several input errors stay several", all_throw<InputError>(
                                                 [&] {
                                                   throw InputError(billet::DiagnosticList{full, plain});
                                                 },
                                                 [&](const auto &error) {
                                                   return error.diagnostics().size() == 2 &&
                                                          is_same(error.diagnostics()[0], full) &&
                                                          is_same(error.diagnostics()[1], plain);
                                                 }));
  check("other exceptions keep their text",
        all_throw<std::runtime_error>(
            [] { throw std::logic_error("a defect"); },
            [](const auto &error) { return error.what() == std::string("a defect"); }));
  bool is_called = false;
  fail_together(MPI_COMM_WORLD, [&is_called] { is_called = true; });
  check("without an exception nothing is thrown", is_called);

  check("before the start a failure is an input error, with its diagnostic",
        all_throw<InputError>([&] { check_before_start([&] { throw SolutionFailure(full); }); },
                              [&](const auto &error) { return is_same(error.diagnostic(), full); }));
  check("there the general kind becomes 'bad-input'",
        all_throw<InputError>([] { check_before_start([] { throw SolutionFailure("It's wrong"); }); },
                              [&](const auto &error) { return is_same(error.diagnostic(), plain); }));
}

} // namespace fail_together_test
