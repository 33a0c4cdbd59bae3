// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/guarded_arrays.h"

#include <algorithm>
#include <cstring>

namespace billet {

namespace {

constexpr double guard = -7.2341890356e183; // no subroutine computes it

} // namespace

GuardedArrays::GuardedArrays(const std::vector<std::size_t> &sizes, const std::size_t n_behind)
    : sizes_(sizes), guards_(std::max(n_guards, n_behind), guard) {
  std::size_t n = n_guards;
  for (const std::size_t size : sizes_) {
    starts_.push_back(n);
    n += size + n_guards;
  }
  numbers_.assign(n - n_guards + guards_.size(), guard);
  for (std::size_t i = 0; i < sizes_.size(); ++i)
    std::fill_n((*this)[i], sizes_[i], 0.);
}

std::optional<std::size_t> GuardedArrays::find_overrun() {
  std::optional<std::size_t> found;
  const auto inspect = [&](double *const begin, const std::size_t n, const std::size_t array) {
    if (std::memcmp(begin, guards_.data(), n * sizeof(double)) == 0)
      return;
    if (!found)
      found = array;
    std::copy_n(guards_.begin(), n, begin);
  };
  inspect(numbers_.data(), n_guards, 0);
  for (std::size_t i = 0; i < sizes_.size(); ++i)
    inspect((*this)[i] + sizes_[i], i + 1 < sizes_.size() ? n_guards : guards_.size(), i);
  return found;
}

} // namespace billet
