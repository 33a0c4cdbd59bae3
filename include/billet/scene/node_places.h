// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_NODE_PLACES_H
#define BILLET_SCENE_NODE_PLACES_H

#include <deal.II/base/point.h>

#include <array>
#include <vector>

namespace billet {

/// Undeformed positions of nodes of one body, without repetitions. Positions identify nodes over
/// all ranks: meshes have the same numbers wherever they are made.
class NodePlaces {
public:
  explicit NodePlaces(const std::vector<dealii::Point<3>> &points);

  bool contains(const dealii::Point<3> &position) const;
  std::vector<dealii::Point<3>> points() const;

private:
  std::vector<std::array<double, 3>> places_; ///< sorted
};

} // namespace billet

#endif
