// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_RESTLESS_NODES_H
#define BILLET_CONTACT_RESTLESS_NODES_H

#include <algorithm>
#include <cstdint>
#include <vector>

namespace billet {

/// Counts the changes of touched facet or status of nodes (chatter) in the iterations of one step.
class RestlessNodes {
public:
  /// Changes in the iterations of an implicit step above which a node is restless.
  static constexpr unsigned int max_changes = 8;

  /// Constructs the counter. A node with more changes than `max_changes` is restless; 0 disables
  /// counting.
  explicit RestlessNodes(const unsigned int max_changes) : max_changes_(max_changes) {}

  bool is_counting() const { return max_changes_ > 0; }
  /// Restarts the step.
  void restart();
  /// Compares each node's state with the previous one, and stores it. The numbers that encode
  /// states are arbitrary.
  void count(std::vector<std::uint64_t> states);
  bool is_restless(const std::size_t i) const {
    return i < n_changes_.size() && n_changes_[i] > max_changes_;
  }
  bool has_any() const {
    return std::any_of(n_changes_.begin(), n_changes_.end(),
                       [this](const unsigned int n) { return n > max_changes_; });
  }
  /// Calls visit(node, number of changes) for each restless node.
  template <class Visit> void visit(const Visit &visit) const {
    for (std::size_t i = 0; i < n_changes_.size(); ++i)
      if (is_restless(i))
        visit(i, n_changes_[i]);
  }

private:
  unsigned int max_changes_;
  std::vector<unsigned int> n_changes_;
  std::vector<std::uint64_t> states_; ///< of the last count()
};

} // namespace billet

#endif
