// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_GUARDED_ARRAYS_H
#define BILLET_MATERIAL_GUARDED_ARRAYS_H

#include <cstddef>
#include <optional>
#include <vector>

namespace billet {

/// Arrays for a subroutine, in one piece of memory: guard numbers before, between and behind them
/// show that it writes outside of an array.
class GuardedArrays {
public:
  /// Makes arrays of zeros. `sizes`: counts of their numbers; `n_behind`: count of guards behind
  /// the last.
  GuardedArrays(const std::vector<std::size_t> &sizes, std::size_t n_behind);

  double *operator[](const std::size_t array) { return numbers_.data() + starts_[array]; }
  const double *operator[](const std::size_t array) const { return numbers_.data() + starts_[array]; }
  std::size_t size(const std::size_t array) const { return sizes_[array]; }

  /// Returns the array beyond whose end the first change of a guard is, also array 0 for one before
  /// it. Returns nothing if all guards are unchanged. Restores the guards.
  std::optional<std::size_t> find_overrun();

  /// Guards before and between arrays.
  static constexpr std::size_t n_guards = 64;

private:
  std::vector<std::size_t> sizes_, starts_;
  std::vector<double> numbers_, guards_; ///< guards_: as many as the largest gap has
};

} // namespace billet

#endif
