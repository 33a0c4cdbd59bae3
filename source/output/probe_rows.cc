// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/probe_rows.h"

#include "billet/algebra/gather.h"

#include <algorithm>
#include <tuple>

namespace billet {

void ProbeRows::add(const std::uint64_t site, const std::uint64_t owner, const double weight,
                    const std::vector<double> &values) {
  keys_.push_back(site);
  keys_.push_back(owner);
  numbers_.push_back(weight);
  numbers_.insert(numbers_.end(), values.begin(), values.end());
}

std::vector<ProbeRows::Row> ProbeRows::gather(const MPI_Comm communicator, const Weights weights) const {
  const auto keys = all_gather(communicator, keys_);
  const auto numbers = all_gather(communicator, numbers_);
  std::vector<Row> all;
  for (std::size_t rank = 0; rank < keys.size(); ++rank)
    for (std::size_t i = 0; 2 * i < keys[rank].size(); ++i) {
      const auto first = numbers[rank].begin() + static_cast<std::ptrdiff_t>(i * (1 + n_values_));
      all.push_back({keys[rank][2 * i],
                     keys[rank][2 * i + 1],
                     *first,
                     {first + 1, first + 1 + static_cast<std::ptrdiff_t>(n_values_)}});
    }
  std::sort(all.begin(), all.end(),
            [](const Row &a, const Row &b) { return std::tie(a.site, a.owner) < std::tie(b.site, b.owner); });
  std::vector<Row> rows;
  for (Row &row : all) {
    if (rows.empty() || rows.back().site != row.site)
      rows.push_back(std::move(row));
    else if (weights == Weights::added)
      rows.back().weight += row.weight;
  }
  return rows;
}

} // namespace billet
