// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_SOFTENING_WATCH_H
#define BILLET_SOLVE_SOFTENING_WATCH_H

#include "billet/diagnostics.h"
#include "billet/scene/scene.h"
#include "billet/solve/solution.h"

#include <cstddef>
#include <vector>

namespace billet {

/// Warns once for each body that flows while heat softens its material by more than it hardens,
/// (H20) of doc/theory. Strains then localise in one layer of elements, and results depend on the
/// mesh.
class SofteningWatch {
public:
  explicit SofteningWatch(const Scene &scene);

  /// Returns messages at this state, one for each body that newly softens. An element counts if it
  /// has flowed since the last call; so the first call finds none. Collective.
  DiagnosticList check(const Solution &solution);
  /// Whether a body has softened so far.
  bool has_softened() const { return has_softened_; }

private:
  /// Body whose law may soften.
  struct Heated {
    std::size_t body;
    std::vector<double> strains; ///< plastic, of its own elements and layers at the last call
  };
  /// Slope of the flow stress over the flow stress, and the plastic strain there.
  struct Weakest {
    double slope, strain;
  };
  /// Finds the weakest element of all ranks that has flowed.
  Weakest find_weakest(Heated &heated, const Solution &solution) const;

  const Scene &scene_;
  std::vector<Heated> bodies_; ///< without those that are reported
  bool has_softened_ = false;
};

} // namespace billet

#endif
