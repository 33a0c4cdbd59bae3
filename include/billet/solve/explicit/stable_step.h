// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_STABLE_STEP_H
#define BILLET_SOLVE_EXPLICIT_STABLE_STEP_H

#include "billet/contact/contacts.h"
#include "billet/diagnostics.h"

#include <mpi.h>

#include <string>

namespace billet {

/// Bounds on the step on a rank.
struct StepBounds {
  /// Stable step of the elements alone; negative if the rank has failed [time].
  double element_step;
  double frequency_square; ///< largest Σ k/m of contacts and springs at a node [1/time²]
  double damping_rate;     ///< largest c/m of dashpots at a node [1/time]
};

/// Stable step of central differences, by Gershgorin's theorem, and the part of it that is used.
class StableStep {
public:
  /// Steps are at most `safety_factor` times the stable step.
  explicit StableStep(const double safety_factor) : safety_factor_(safety_factor) {}

  /// Computes the stable step from the bounds of all ranks. `of_tools` is the addition of free
  /// tools to frequency_square. Returns false, on all ranks, if one has failed; then the value is
  /// negative. Collective.
  bool update(const StepBounds &own, double of_tools, MPI_Comm communicator);
  /// Returns the stable step [time].
  double value() const { return value_; }
  /// Returns the maximum step. `crossing_step`: limit by nodes that come through surfaces [time].
  double allowed(double crossing_step) const;
  /// Returns the maximum step while no node comes through a surface [time].
  double usual() const { return factor_ * safety_factor_ * value_; }
  /// Returns the same if contact had this frequency_square on this rank, and there were no
  /// dashpots. Collective.
  double usual_with(double frequency_square, MPI_Comm communicator) const;
  /// Multiplies all further steps by this factor, beside the safety factor.
  void shorten(const double factor) { factor_ = factor; }

  /// Whether contact makes steps much shorter than the elements require.
  bool is_set_by_contact() const;
  /// Returns why the run cannot continue if an element is so flat that the run would hardly end;
  /// else empty.
  Explanation describe_collapse() const;
  /// Returns a message if an element is flat at time t.
  DiagnosticList check_elements(double t) const;
  /// Returns messages about causes of much shorter steps: contact at time t or flat elements.
  /// Collective.
  DiagnosticList check(double t, const Contacts &contacts, MPI_Comm communicator) const;

private:
  std::string describe_flat_elements() const;

  double safety_factor_;
  double factor_ = 1.; ///< beside the safety factor
  double value_ = 0.;
  /// Stable step of the elements alone, over all ranks; that at the start.
  double of_elements_ = 0., of_elements_first_ = 0.;
};

} // namespace billet

#endif
