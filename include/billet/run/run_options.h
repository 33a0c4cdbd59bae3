// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_RUN_OPTIONS_H
#define BILLET_RUN_RUN_OPTIONS_H

#include "billet/diagnostics.h"

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace billet {

class ConsoleLog;
struct ErrorReport;

/// Mesh of a body in a run that has reached its end.
struct BodyMesh {
  std::size_t n_elements; ///< of all ranks
  /// Part of the relative error of the forces, by (W5) and (W8) of the theory.
  double error;
  bool is_resolved = true; ///< whether that sees all: what varies in single elements, and contact
  double reach = 0.;       ///< largest distance of all bodies from the origin, or more [length]
};

/// Messages and folder of a run that has reached its end.
struct Verdict {
  DiagnosticList messages;
  std::string folder; ///< to which its results are moved afterwards; empty: they stay
};

/// Options of a run that its parameters do not have, such as those of the command line.
struct RunOptions {
  bool replaces_results = false; ///< rather than to move those of an earlier run aside
  ConsoleLog *log = nullptr;     ///< to be opened in the output folder; null: none
  bool is_quiet = false;         ///< the console gets warnings and errors only, the log all
  /// Options that changed the scene, for the command that resumes the run.
  std::string changes = {};
  /// Gets lines of steps if the console is quiet and the log is open already.
  std::ostream *steps = nullptr;
  /// Judges a run that has reached its end, with these meshes of bodies and its estimated errors;
  /// its history is complete. Collective. Empty: none. A run that is judged is one of several, and
  /// cannot be resumed.
  std::function<Verdict(const std::vector<BodyMesh> &, const ErrorReport &)> judge = {};
};

} // namespace billet

#endif
