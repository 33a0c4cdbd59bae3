// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_PROBE_ROWS_H
#define BILLET_OUTPUT_PROBE_ROWS_H

#include <deal.II/base/mpi.h>

#include <cstdint>
#include <vector>

namespace billet {

/// Values of a probe at its sites. Several ranks may have the same site, from different elements.
class ProbeRows {
public:
  explicit ProbeRows(const std::size_t n_values) : n_values_(n_values) {}

  /// `owner`: key of the element or facet that the values come from; the least one counts.
  void add(std::uint64_t site, std::uint64_t owner, double weight, const std::vector<double> &values);

  struct Row {
    std::uint64_t site, owner;
    double weight;
    std::vector<double> values;
  };
  /// Treatment of the weights of rows of the same site.
  enum class Weights { of_owner, added };
  /// Returns one row for each site of all ranks, in the order of sites. All ranks get the same, to
  /// the last bit whatever the partition. Collective.
  std::vector<Row> gather(MPI_Comm communicator, Weights weights = Weights::of_owner) const;

private:
  std::size_t n_values_;
  std::vector<std::uint64_t> keys_; ///< site and owner of each row
  std::vector<double> numbers_;     ///< weight and values of each row
};

} // namespace billet

#endif
