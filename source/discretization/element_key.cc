// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/element_key.h"

#include <deal.II/base/exceptions.h>
#include <deal.II/base/geometry_info.h>

namespace billet {

namespace {

constexpr unsigned int n_children = dealii::GeometryInfo<3>::max_children_per_cell;
constexpr unsigned int bits_of_coarse_cell = 32;

std::uint64_t place_in_octree(const ElementKey key) { return key >> bits_of_coarse_cell; }

ElementKey make_key(const std::uint64_t coarse_cell, const std::uint64_t place) {
  return (place << bits_of_coarse_cell) | coarse_cell;
}

} // namespace

ElementKey element_key(const dealii::CellId &id) {
  AssertThrow(std::uint64_t{id.get_coarse_cell_id()} >> bits_of_coarse_cell == 0,
              dealii::ExcMessage("A mesh has at most 2^32 coarse cells"));
  ElementKey key = id.get_coarse_cell_id();
  for (const std::uint8_t child : id.get_child_indices())
    key = child_key(key, child);
  return key;
}

unsigned int refinement_level(ElementKey key) {
  unsigned int level = 0;
  for (; place_in_octree(key) > 0; key = parent_key(key))
    ++level;
  return level;
}

ElementKey parent_key(const ElementKey key) {
  Assert(place_in_octree(key) > 0, dealii::ExcMessage("A coarse cell has no parent"));
  return make_key(coarse_cell_of(key), (place_in_octree(key) - 1) / n_children);
}

ElementKey child_key(const ElementKey key, const unsigned int child) {
  AssertThrow(refinement_level(key) < max_refinement_level,
              dealii::ExcMessage("An element is refined more often than its key can tell"));
  return make_key(coarse_cell_of(key), n_children * place_in_octree(key) + 1 + child);
}

} // namespace billet
