// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facing_gaps.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

// Directions are those of the middles of squares on the six sides of a cube. An odd number of
// squares gives each axis a direction of its own.
constexpr unsigned int n_squares = 9;

// Facets at right angles share an edge, whose normal is at 45 degrees to both, or a corner, at 54.7
// degrees.
constexpr double same_way = 0.55; // cosine of the angle

unsigned int square_of(const double part) {
  const double square = std::floor(0.5 * (part + 1.) * n_squares);
  return static_cast<unsigned int>(std::clamp(square, 0., n_squares - 1.));
}

std::size_t index_of(const Tensor<1, 3> &direction) {
  unsigned int axis = 0;
  for (unsigned int i = 1; i < 3; ++i)
    if (std::abs(direction[i]) > std::abs(direction[axis]))
      axis = i;
  const double length = std::abs(direction[axis]);
  const unsigned int side = 2 * axis + (direction[axis] > 0. ? 1 : 0),
                     row = square_of(direction[(axis + 1) % 3] / length),
                     column = square_of(direction[(axis + 2) % 3] / length);
  return (std::size_t{side} * n_squares + row) * n_squares + column;
}

std::vector<Tensor<1, 3>> make_directions() {
  std::vector<Tensor<1, 3>> directions;
  const auto middle = [](const unsigned int square) { return (2. * square + 1.) / n_squares - 1.; };
  for (unsigned int side = 0; side < 6; ++side)
    for (unsigned int row = 0; row < n_squares; ++row)
      for (unsigned int column = 0; column < n_squares; ++column) {
        Tensor<1, 3> direction;
        const unsigned int axis = side / 2;
        direction[axis] = side % 2 == 1 ? 1. : -1.;
        direction[(axis + 1) % 3] = middle(row);
        direction[(axis + 2) % 3] = middle(column);
        directions.push_back(direction / direction.norm());
      }
  return directions;
}

} // namespace

FacingGaps::FacingGaps() : gaps_(6 * n_squares * n_squares, unknown) {}

void FacingGaps::add(const Tensor<1, 3> &outward, const double gap) {
  double &least = gaps_[index_of(outward)];
  least = std::min(least, gap);
}

void FacingGaps::reduce(const MPI_Comm communicator) {
  MPI_Allreduce(MPI_IN_PLACE, gaps_.data(), static_cast<int>(gaps_.size()), MPI_DOUBLE, MPI_MIN,
                communicator);
}

std::optional<double> FacingGaps::find(const Tensor<1, 3> &outward) const {
  static const std::vector<Tensor<1, 3>> directions = make_directions();
  const double length = outward.norm();
  double least = unknown;
  for (std::size_t i = 0; i < gaps_.size(); ++i)
    if (gaps_[i] < least && directions[i] * outward >= same_way * length)
      least = gaps_[i];
  return least < unknown ? std::optional<double>(least) : std::nullopt;
}

double FacingGaps::carried_penetration(const Tensor<1, 3> &outward, const double gap) const {
  const double least = find(outward).value_or(0.);
  // Small gaps between overlapping parts of a face remain, since they belong to the contact.
  return least > 0. ? -least : std::clamp(gap + least, 0., -least);
}

} // namespace billet
