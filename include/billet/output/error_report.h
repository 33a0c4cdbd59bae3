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

  std::string of_what;         ///< reference quantity of the errors: forces or energies
  double since = 0.;           ///< time from which errors are known; 0: from the start
  double target = 0.;          ///< of the sources; 0: none
  bool is_known = true;        ///< whether there was a reference quantity to normalise by
  std::vector<Source> sources; ///< estimated sources
  double mesh_target = 0.;     ///< of levels of the mesh, compared after the run; 0: none are
  double mesh = 0.;            ///< from MeshErrors::error(); not one of the sources
  bool is_mesh_known = true;   ///< whether that sees all; the note 'mesh-error' says why not
  std::vector<std::pair<std::string, double>> costs;

  /// Whether errors of all sources are known.
  bool knows_all() const;
  /// Returns the sum of the known errors.
  double total() const;
  /// Returns the estimate and, if there is a target, whether it is unknown, or missed: with levels
  /// of the mesh only missed() tells.
  DiagnosticList diagnostics() const;
  /// Returns a warning if the sum of the known errors and that of the mesh, from its levels,
  /// exceeds both targets together. Returns nothing if not, or if there is no target.
  DiagnosticList missed(double of_levels = 0.) const;
  /// Writes error_estimate.csv into this folder: quantity, value. Throws SolutionFailure if it
  /// cannot be written.
  void write(const std::string &folder) const;

private:
  Diagnostic estimate() const;
};

} // namespace billet

#endif
