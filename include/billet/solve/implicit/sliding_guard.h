// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_SLIDING_GUARD_H
#define BILLET_SOLVE_IMPLICIT_SLIDING_GUARD_H

#include "billet/solve/implicit/implicit_problem.h"

#include <cstddef>
#include <string>
#include <vector>

namespace billet {

/// Bounds how far forces slide bodies over each other, or over tools, in a static step. If an
/// equilibrium is lost, Newton's method may find another one far away, and contact has not seen
/// what is between them. With automatic steps, a solution that slides too far is rejected.
/// Iterations may slide further, and return.
///
/// If they fail, the next attempt takes trial states that slide too far as inadmissible, so that it
/// finds an equilibrium that is near. The one after that does not, and so on in turn.
class SlidingGuard {
public:
  explicit SlidingGuard(ImplicitProblem &problem);

  /// Begins an attempt of a step.
  void begin() {
    ++n_attempts_;
    n_refused_ = 0;
  }
  /// Records the friction of a converged step. If nodes slide too far, returns a failure, or adds a
  /// warning if the step's length is fixed. Collective.
  std::optional<StepFailure> judge(double t, DiagnosticList &messages);
  /// Explains a step that failed after states slid too far; empty if none did. `cause`: why bodies
  /// slide, if it is known; from one attempt it holds for those after it.
  Explanation explain(double t, const Explanation &cause);

private:
  struct Limits {
    /// Maximum sliding of a node in a step, beyond twice what tools and supports prescribe [facet
    /// sizes].
    static constexpr double max_sliding = 2.;
    /// Maximum number of trial states that slide too far. Iterations with more of them do not
    /// return.
    static constexpr unsigned int max_refused = 12;
  };
  struct Sliding {
    double facets = 0.;      ///< maximum over all pairs, beyond the prescribed motion [facet sizes]
    std::size_t contact = 0; ///< pair with the maximum
  };
  bool has_fixed_steps() const;
  /// Counts a state that slides too far. Returns the reason.
  std::string refuse(const Sliding &sliding);
  bool has_loads() const;
  /// Whether a force moves something in the step: a driven tool with a load, or a load on a body.
  bool has_forces() const;
  /// Measures the trial state. Collective.
  Sliding measure() const;
  Explanation describe(std::size_t contact, double t, const Explanation &cause) const;

  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();
  std::vector<FrictionUse> friction_; ///< of the contacts in the last converged step
  unsigned int n_refused_ = 0;        ///< states of this attempt that slid too far
  std::size_t refused_ = 0;           ///< contact pair of the last one
  unsigned int n_attempts_ = 0;       ///< since the last accepted step
  Explanation cause_;                 ///< why bodies slide, since the last accepted step
  bool slides_too_far_ = false;       ///< whether any state did since then
};

} // namespace billet

#endif
