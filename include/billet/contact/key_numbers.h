// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_KEY_NUMBERS_H
#define BILLET_CONTACT_KEY_NUMBERS_H

#include "billet/state.h"

#include <cstdint>

namespace billet {

/// Appends the key of a facet, which has more bits than a double keeps, as two numbers.
inline void write_key(RowWriter &row, const std::uint64_t key) {
  constexpr std::uint64_t half = 0xffffffffU;
  row.number(static_cast<double>(key >> 32U)).number(static_cast<double>(key & half));
}

/// Reads a key that write_key() has written.
inline std::uint64_t read_key(RowReader &row) {
  const std::uint64_t high = to_count(row.number());
  return (high << 32U) | to_count(row.number());
}

} // namespace billet

#endif
