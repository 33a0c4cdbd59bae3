// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISJOINT_SETS_H
#define BILLET_DISJOINT_SETS_H

#include <cstddef>
#include <numeric>
#include <vector>

namespace billet {

/// Disjoint sets of numbers from 0, which can be joined. A set is known by one of its numbers.
class DisjointSets {
public:
  explicit DisjointSets(const std::size_t n = 0) : parents_(n) {
    std::iota(parents_.begin(), parents_.end(), std::size_t{0});
  }
  std::size_t add() {
    parents_.push_back(parents_.size());
    return parents_.size() - 1;
  }
  std::size_t find(std::size_t i) {
    while (parents_[i] != i)
      i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(const std::size_t a, const std::size_t b) { parents_[find(a)] = find(b); }
  std::size_t size() const { return parents_.size(); }
  std::size_t count() const {
    std::size_t n = 0;
    for (std::size_t i = 0; i < parents_.size(); ++i)
      n += parents_[i] == i ? 1 : 0;
    return n;
  }

private:
  std::vector<std::size_t> parents_;
};

} // namespace billet

#endif
