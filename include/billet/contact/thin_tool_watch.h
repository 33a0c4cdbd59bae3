// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_THIN_TOOL_WATCH_H
#define BILLET_CONTACT_THIN_TOOL_WATCH_H

#include "billet/geometry/rigid_surface.h"

#include <deal.II/base/tensor.h>

#include <optional>
#include <vector>

namespace billet {

/// Detects nodes that pass through a tool thinner than two facets, from the start of a step to its
/// end. All positions are in the tool's coordinates.
class ThinToolWatch {
public:
  /// Returns a watch if the surface is thin compared with facets up to this size [length]. Keeps a
  /// reference to the surface.
  static std::optional<ThinToolWatch> make(const RigidSurface &surface, double max_facet_size);

  /// Returns the smallest extent of the tool [length].
  double thickness() const { return thickness_; }
  /// Sets the positions of nodes at the start of the step.
  void remember(std::vector<dealii::Tensor<1, 3>> positions) { positions_n_ = std::move(positions); }
  /// Clears these positions: no passage is found until new ones are set.
  void forget() { positions_n_.clear(); }
  bool knows_positions() const { return !positions_n_.empty(); }

  /// A node at the end of the step.
  struct Node {
    dealii::Tensor<1, 3> position;
    unsigned int patch;      ///< of the surface, where the search for its nearest point starts
    double distance;         ///< to the surface; < 0 behind it [length]
    double penetration = 0.; ///< of a node that touches [length]
  };
  /// Whether node i has passed through the tool, or is about as near to its other side. Requires
  /// knows_positions().
  bool passes(std::size_t i, const Node &node) const;

private:
  ThinToolWatch(const RigidSurface &surface, const double thickness)
      : surface_(&surface), thickness_(thickness) {}

  const RigidSurface *surface_;
  double thickness_;
  std::vector<dealii::Tensor<1, 3>> positions_n_;
};

} // namespace billet

#endif
