// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_EXPLICIT_REACTIONS_H
#define BILLET_SOLVE_EXPLICIT_EXPLICIT_REACTIONS_H

#include "billet/solve/explicit/explicit_parts.h"
#include "billet/solve/reactions.h"

namespace billet {

/// Reactions of an explicit scene at t_n, after the kick: M a − F at constrained nodes, with
/// a = (v_{n+½} − v_{n−½})/(½ (Δt_{n−1} + Δt_n)). Supports that have ended and removed tools have
/// the forces that fade.
class ExplicitReactions {
public:
  explicit ExplicitReactions(const ExplicitParts &parts);

  const Reactions &values() const { return values_; }
  /// Collective.
  void update();

private:
  void sum_forces();
  /// Count what is left of removed tools' forces as contact, and of supports' forces as their
  /// reactions. Collective.
  void add_fading_tools();
  void add_fading_supports();

  const ExplicitParts &parts_;
  SupportReactions supports_;
  double round_off_; ///< force by round-off of positions
  Reactions values_;
};

} // namespace billet

#endif
