// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_ERROR_REPORT_H
#define BILLET_OUTPUT_ERROR_REPORT_H

#include "billet/diagnostics.h"

#include <string>
#include <utility>
#include <vector>

namespace billet {

/// The estimated error of a run, beside what was asked for and what it cost.
struct ErrorReport {
  /// One source of errors: its name, its part of the forces or energies, and what lowers it.
  struct Source {
    std::string name;
    double error;
    std::string remedy;
    bool is_known = true; ///< else it could not be measured
  };

  std::string of_what;         ///< that the errors are parts of: forces, energies
  double since = 0.;           ///< time from which on they are known; 0: from the start
  double target = 0.;          ///< 0: none was asked for
  bool is_known = true;        ///< whether there was something that errors can be parts of
  std::vector<Source> sources; ///< that are estimated
  double stress_jumps = 0.;    ///< see stress_jumps()
  std::vector<std::pair<std::string, double>> costs;

  /// Of what is known.
  double total() const;
  /// The estimate, and whether it meets the target.
  DiagnosticList diagnostics() const;
  /// error_estimate.csv in this folder: quantity, value. Throws SolutionFailure if it cannot be written.
  void write(const std::string &folder) const;

private:
  Diagnostic estimate() const;
};

} // namespace billet

#endif
