// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_STABLE_STEP_H
#define BILLET_SOLVE_EXPLICIT_STABLE_STEP_H

#include "billet/contact/contacts.h"
#include "billet/diagnostics.h"

#include <mpi.h>

#include <string>

namespace billet {

/// What bounds the step on a rank.
struct StepBounds {
  double element_step;     ///< stable step of the elements alone; negative where the rank has failed [time]
  double frequency_square; ///< largest Σ k/m of contacts and springs at a node [1/time²]
  double damping_rate;     ///< largest c/m of dashpots at a node [1/time]
};

/// The stable step of central differences, by Gershgorin's theorem, and how much of it is taken.
class StableStep {
public:
  /// Steps are at most `safety_factor` times the stable step.
  explicit StableStep(const double safety_factor) : safety_factor_(safety_factor) {}

  /// Computes the stable step from the bounds of all ranks. `of_tools` is what free tools add to
  /// frequency_square. False, on all ranks, if one has failed; then the value is negative. Collective.
  bool update(const StepBounds &own, double of_tools, MPI_Comm communicator);
  /// Returns the stable step [time].
  double value() const { return value_; }
  /// Returns the longest step that is taken where nodes that come through surfaces ask for `crossing_step`
  /// [time].
  double allowed(double crossing_step) const;
  /// Returns the longest step that is taken as long as nothing comes through a surface [time].
  double usual() const { return factor_ * safety_factor_ * value_; }
  /// Steps are this part of what the safety factor allows, from now on.
  void shorten(const double factor) { factor_ = factor; }

  /// Returns why the run cannot go on: an element is so flat that it would hardly end. Else empty.
  std::string describe_collapse() const;
  /// Returns messages about what makes steps much shorter than they would be without: contact at time t or
  /// flat elements. Collective.
  DiagnosticList check(double t, const Contacts &contacts, MPI_Comm communicator) const;

private:
  std::string describe_flat_elements() const;

  double safety_factor_;
  double factor_ = 1.; ///< beside the safety factor
  double value_ = 0.;
  double of_elements_ = 0., of_elements_first_ = 0.; ///< of the elements alone, of all ranks; at the start
};

} // namespace billet

#endif
