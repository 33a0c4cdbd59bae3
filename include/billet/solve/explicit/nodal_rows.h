// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_NODAL_ROWS_H
#define BILLET_SOLVE_EXPLICIT_NODAL_ROWS_H

#include "billet/discretization/local_nodes.h"
#include "billet/discretization/node_keys.h"
#include "billet/state.h"

#include <cstdint>
#include <string>
#include <vector>

namespace billet {

/// Nodal vectors in a checkpoint: rows of three numbers under keys that do not depend on the
/// partition.
class NodalRows {
public:
  explicit NodalRows(const LocalNodes &nodes);

  const NodeKeys &keys() const { return keys_; }
  /// Returns the keys of all nodes of this rank.
  const std::vector<std::uint64_t> &of_nodes() const { return of_nodes_; }

  /// Writes value_of(node), which has three components, for each node that this rank owns.
  template <class ValueOf>
  void save(StateWriter &writer, const std::string &name, const ValueOf &value_of) const {
    std::vector<std::uint64_t> owned;
    std::vector<double> rows;
    RowWriter row(rows);
    for (unsigned int node = 0; node < nodes_.size(); ++node)
      if (nodes_.is_owned(node)) {
        owned.push_back(of_nodes_[node]);
        row.vector(value_of(node));
      }
    writer.write_rows(name, 3, owned, rows);
  }
  /// Reads the vectors of all nodes of this rank.
  void load(const StateReader &reader, const std::string &name, NodalVectors &values) const;

private:
  const LocalNodes &nodes_;
  NodeKeys keys_;
  std::vector<std::uint64_t> of_nodes_;
};

} // namespace billet

#endif
