// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_PENALTY_WATCH_H
#define BILLET_SOLVE_PENALTY_WATCH_H

#include "billet/contact/contact_load.h"
#include "billet/diagnostics.h"
#include "billet/geometry/placement.h"
#include "billet/state.h"

#include <map>
#include <optional>
#include <string>

namespace billet {

/// Says which contact pairs have penalties that are too soft for what presses them, by three signs: nodes a
/// tenth of a facet deep; or deeper than a fifth of the largest displacement so far, of bodies or of the
/// pair's tool; or more than a fifth of all work in the pair's springs, as where what is pressed is flat and
/// moves aside: then the penalty gives way in place of the body. In an impact nodes come in before bodies
/// deform: there only the first sign counts, if springs hold 1 % of all energy or nodes stay that deep until
/// the next check.
class PenaltyWatch {
public:
  enum class Motion { slow, sudden };

  explicit PenaltyWatch(const Motion motion) : motion_(motion) {}

  /// The deepest node of the pair, the largest displacement [length], and what part of all work the pair's
  /// springs hold, of all ranks. A message, or none.
  DiagnosticList check(const std::string &pair, double time, const Penetration &deepest, double displacement,
                       double part_of_work = 0.);
  /// Whether a pair has shown either sign.
  bool has_soft_pairs() const { return has_soft_pairs_; }

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  Motion motion_;
  bool has_soft_pairs_ = false;
  std::map<std::string, bool> are_deep_;        ///< by pair, at the last check
  std::map<std::string, double> displacements_; ///< by pair, the largest so far [length]
};

/// How far a tool's motion takes a point that is `radius` from its moved centre, at most [length].
double largest_motion(const Placement &from, const Placement &to, double radius);

} // namespace billet

#endif
