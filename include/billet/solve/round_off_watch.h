// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_ROUND_OFF_WATCH_H
#define BILLET_SOLVE_ROUND_OFF_WATCH_H

#include "billet/diagnostics.h"

#include <vector>

namespace billet {

/// Part of the forces that round-off may take without a warning, whatever tolerance the scene asks for.
constexpr double notable_round_off = 1e-8;

/// Judges what round-off of positions makes of contact's forces, beside the largest forces of the run: a
/// first touch is light, and what is lost in it matters to nobody.
class RoundOffWatch {
public:
  /// Of an accepted step, both in any consistent unit of force. `round_off`: 0 where contact bears nothing.
  void add(double time, double round_off, double forces);
  /// At the end of the run. `tolerance`: 'Force tolerance'. `accepts_all`: whether steps may end however
  /// large that part is, as in dynamics, where inertia holds what forces leave.
  DiagnosticList finish(double tolerance, bool accepts_all) const;

  std::vector<double> save() const { return {time_, round_off_, forces_}; }
  void load(const std::vector<double> &numbers);

private:
  double time_ = 0.;                    ///< of the largest round-off
  double round_off_ = 0., forces_ = 0.; ///< largest of the run
};

} // namespace billet

#endif
