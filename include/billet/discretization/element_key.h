// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_ELEMENT_KEY_H
#define BILLET_DISCRETIZATION_ELEMENT_KEY_H

#include <deal.II/grid/cell_id.h>

#include <cstdint>

namespace billet {

/// Unique number of an element, refined or not, the same on any number of ranks. It is the number
/// of the coarse cell plus 2^32 times the element's place in the octree of that cell. The place is
/// 0 for the cell itself, 1 to 8 for its children, 9 to 72 for theirs, and so on. In a mesh without
/// refinement, keys equal cell numbers.
using ElementKey = std::uint64_t;

/// Maximum refinement level that keys can represent. Keys of nodes, facets and points inside facets
/// multiply element keys, for which 14 of the 64 bits are reserved.
constexpr unsigned int max_refinement_level = 5;

/// Returns the key of a cell of at most max_refinement_level refinements.
ElementKey element_key(const dealii::CellId &id);

/// Returns the number of refinements from the coarse cell to the element.
unsigned int refinement_level(ElementKey key);

/// Returns the key of the parent of an element above level 0.
ElementKey parent_key(ElementKey key);

/// Returns the key of a child, 0 to 7 in deal.II's order, of an element below max_refinement_level.
ElementKey child_key(ElementKey key, unsigned int child);

/// Returns the number of the coarse cell.
constexpr std::uint64_t coarse_cell_of(const ElementKey key) { return key & 0xffffffffU; }

} // namespace billet

#endif
