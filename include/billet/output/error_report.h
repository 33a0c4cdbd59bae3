// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_ERROR_REPORT_H
#define BILLET_OUTPUT_ERROR_REPORT_H

#include "billet/diagnostics.h"

#include <string>
#include <utility>
#include <vector>

namespace billet {

/// Estimated error of a run, with its target and costs.
struct ErrorReport {
  /// Source of errors: its name, its error relative to the forces or energies, and its remedy.
  struct Source {
    std::string name;
    double error;
    std::string remedy;
    bool is_known = true; ///< false: it could not be measured
  };

  std::string of_what;          ///< reference quantity of the errors: forces or energies
  double since = 0.;            ///< time from which errors are known; 0: from the start
  double target = 0.;           ///< 0: none
  bool is_known = true;         ///< whether there was a reference quantity to normalise by
  std::vector<Source> sources;  ///< estimated sources
  double mesh = 0.;             ///< from MeshErrors::error(); not one of the sources
  bool is_mesh_known = true;    ///< MeshErrors::sees_variation()
  bool has_mesh_target = false; ///< whether levels of the mesh are compared after the run
  std::vector<std::pair<std::string, double>> costs;

  /// Returns the sum of the known errors.
  double total() const;
  /// Returns the estimate and, if there is a target, whether it is missed or unknown.
  DiagnosticList diagnostics() const;
  /// Writes error_estimate.csv into this folder: quantity, value. Throws SolutionFailure if it cannot be
  /// written.
  void write(const std::string &folder) const;

private:
  Diagnostic estimate() const;
};

} // namespace billet

#endif
