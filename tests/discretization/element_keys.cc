// SPDX-License-Identifier: LGPL-2.1-or-later
// Keys of elements on a mesh that is refined at random: no two elements share one, parents and children are
// those of deal.II, and a mesh that is not refined has the numbers of its cells.
#include "../testing.h"
#include "billet/discretization/element_key.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

#include <set>
#include <stdexcept>
#include <vector>

namespace element_keys_test {

using billet::testing::check;

namespace {

/// The element that has the key, from its number in each parent.
dealii::CellId cell_id_of(billet::ElementKey key) {
  std::vector<std::uint8_t> children;
  for (; billet::refinement_level(key) > 0; key = billet::parent_key(key))
    for (std::uint8_t child = 0; child < 8; ++child)
      if (billet::child_key(billet::parent_key(key), child) == key)
        children.insert(children.begin(), child);
  return dealii::CellId(billet::coarse_cell_of(key), children);
}

} // namespace

BILLET_TEST(element_keys) {
  dealii::Triangulation<3> mesh;
  dealii::GridGenerator::subdivided_hyper_cube(mesh, 3);
  bool are_numbers = true;
  for (const auto &cell : mesh.active_cell_iterators())
    are_numbers = are_numbers && billet::element_key(cell->id()) == cell->active_cell_index();
  check("Without refinement: the numbers of the cells", are_numbers);

  billet::testing::Random random;
  for (unsigned int level = 0; level < billet::max_refinement_level; ++level) {
    bool refines = false;
    for (const auto &cell : mesh.active_cell_iterators())
      if (static_cast<unsigned int>(cell->level()) == level && (!refines || random(0., 1.) < 0.05)) {
        cell->set_refine_flag();
        refines = true;
      }
    mesh.execute_coarsening_and_refinement();
  }
  check("The mesh has all levels", mesh.n_levels() == billet::max_refinement_level + 1);

  std::set<billet::ElementKey> keys;
  std::size_t n_cells = 0;
  bool fit = true, are_levels = true, are_parents = true, are_children = true, come_back = true;
  for (const auto &cell : mesh.cell_iterators()) {
    const billet::ElementKey key = billet::element_key(cell->id());
    keys.insert(key);
    ++n_cells;
    fit = fit && key >> 50U == 0;
    are_levels = are_levels && billet::refinement_level(key) == static_cast<unsigned int>(cell->level());
    come_back = come_back && cell_id_of(key) == cell->id();
    if (cell->level() > 0)
      are_parents = are_parents && billet::parent_key(key) == billet::element_key(cell->parent()->id());
    for (unsigned int c = 0; c < cell->n_children(); ++c)
      are_children = are_children && billet::child_key(key, c) == billet::element_key(cell->child(c)->id());
  }
  check("No two elements share a key", keys.size() == n_cells);
  check("Keys have 50 bits", fit);
  check("Levels", are_levels);
  check("Parents", are_parents);
  check("Children", are_children);
  check("Cells from keys", come_back);

  billet::ElementKey deepest = 26;
  for (unsigned int level = 0; level < billet::max_refinement_level; ++level)
    deepest = billet::child_key(deepest, 7);
  bool is_refused = false;
  try {
    billet::child_key(deepest, 0);
  } catch (const std::exception &) {
    is_refused = true;
  }
  check("One level more is refused", is_refused);
}

} // namespace element_keys_test
