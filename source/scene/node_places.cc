// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/node_places.h"

#include <algorithm>

namespace billet {

NodePlaces::NodePlaces(const std::vector<dealii::Point<3>> &points) {
  places_.reserve(points.size());
  for (const auto &point : points)
    places_.push_back({point[0], point[1], point[2]});
  std::sort(places_.begin(), places_.end());
  places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
}

bool NodePlaces::contains(const dealii::Point<3> &position) const {
  return std::binary_search(places_.begin(), places_.end(),
                            std::array<double, 3>{position[0], position[1], position[2]});
}

std::vector<dealii::Point<3>> NodePlaces::points() const {
  std::vector<dealii::Point<3>> points;
  for (const auto &[x, y, z] : places_)
    points.emplace_back(x, y, z);
  return points;
}

} // namespace billet
