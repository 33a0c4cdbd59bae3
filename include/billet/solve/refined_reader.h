// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_REFINED_READER_H
#define BILLET_SOLVE_REFINED_READER_H

#include "billet/discretization/node_keys.h"
#include "billet/state.h"

#include <array>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace billet {

/// Saves the node keys of all elements, from which RefinedReader finds the nodes of elements of the
/// mesh before. Collective.
void save_mesh(StateWriter &writer, const Discretization &discretization);

/// State of a run, read on a mesh on which each element of some bodies is divided into eight. Rows
/// of nodes are interpolated between the nodes of the element before, (R3) of doc/theory. Nodal
/// forces of refined bodies are 0, for the mesh has others. An element of a refined body gets the
/// row of the element of which it is a part: set_parent_state() takes its own history from it.
///
/// Rows of contact at nodes are interpolated between those of the facet before; of friction, the
/// traction is. Everything else is read as it is. The entry "refined bodies", in each group, names
/// the refined bodies, see refined_bodies().
class RefinedReader final : public StateReader {
public:
  /// `before`: the state, with save_mesh() in its group "mesh". `discretization`: the new mesh;
  /// `is_refined`: which of its bodies have been refined once. Collective.
  RefinedReader(StateReader &before, const Discretization &discretization, std::vector<bool> is_refined);

  bool has(const std::string &name) const override;
  using StateReader::read;
  std::vector<double> read(const std::string &name) const override;
  std::string read_text(const std::string &name) const override { return before_.read_text(name); }
  std::vector<double> read_rows(const std::string &name, std::size_t width,
                                const std::vector<std::uint64_t> &keys,
                                std::vector<bool> *found) const override;
  std::size_t n_rows(const std::string &name) const override { return before_.n_rows(name); }
  unsigned int n_ranks() const override { return before_.n_ranks(); }

private:
  using NodesOfElement = std::array<std::uint64_t, n_element_nodes>;
  /// Nodes before, from which a node has its values, with their weights.
  using Sources = std::vector<std::pair<std::uint64_t, double>>;

  void enter(const std::string &name) override { enter_group(before_, name); }
  void leave() override { leave_group(before_); }

  /// Finds the first coarse cell of each body. Collective.
  void find_coarse_cells(const Discretization &discretization);
  /// Reads the nodes of the elements before around the nodes of this rank. Collective.
  void read_parents(const Discretization &discretization);
  bool is_refined(ElementKey key) const;
  Sources sources_of(std::uint64_t node) const;
  std::vector<double> interpolate(const std::string &name, std::size_t width,
                                  const std::vector<std::uint64_t> &keys) const;
  std::vector<double> read_parent_rows(const std::string &name, std::size_t width,
                                       const std::vector<std::uint64_t> &keys) const;
  std::vector<double> read_slaves(const std::string &name, std::size_t width,
                                  const std::vector<std::uint64_t> &keys, std::vector<bool> *found) const;
  std::vector<double> read_areas(const std::string &name, std::size_t width,
                                 const std::vector<std::uint64_t> &keys) const;
  std::vector<double> drop_forces(const std::string &name, std::size_t width,
                                  const std::vector<std::uint64_t> &keys) const;

  StateReader &before_;
  std::vector<bool> is_refined_;                           ///< by body
  std::vector<std::uint64_t> first_cells_;                 ///< coarse cell, by body
  std::unordered_map<ElementKey, NodesOfElement> parents_; ///< nodes of elements of the mesh before
};

/// Returns the weights of the eight nodes of an element at node `v` of its part `child`.
std::array<double, n_element_nodes> weights_in_parent(unsigned int child, unsigned int v);
/// Returns the number of an element among the eight parts of its parent, in deal.II's order.
unsigned int child_number(ElementKey key);

} // namespace billet

#endif
