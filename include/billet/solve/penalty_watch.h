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

/// Warns of contact pairs whose penalties are too low, by three signs. The first is penetration of
/// a tenth of a facet. The second is penetration of a fifth of the largest displacement so far, of
/// bodies or of the pair's tool. The third is more than a fifth of all work in the pair's springs.
///
/// It finds flat contact on bodies that move aside, where the penalty yields in place of the body.
///
/// In an impact, penetration precedes deformation. There only the first sign counts, if springs
/// hold 1 % of all energy or the penetration persists until the next check.
class PenaltyWatch {
public:
  enum class Motion { slow, sudden };

  explicit PenaltyWatch(const Motion motion) : motion_(motion) {}

  /// Checks a pair by its deepest node, the largest displacement [length], and the part of all work
  /// in the pair's springs, over all ranks. Returns a warning, or none.
  DiagnosticList check(const std::string &pair, double time, const Penetration &deepest, double displacement,
                       double part_of_work = 0.);
  /// Whether a pair has shown any of the signs.
  bool has_low_penalties() const { return has_low_penalties_; }

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  Motion motion_;
  bool has_low_penalties_ = false;
  std::map<std::string, bool> are_deep_;        ///< by pair, at the last check
  std::map<std::string, double> displacements_; ///< by pair, the largest so far [length]
};

/// Returns an upper bound of a tool's motion at points up to `radius` from its moved centre
/// [length].
double max_motion(const Placement &from, const Placement &to, double radius);

} // namespace billet

#endif
