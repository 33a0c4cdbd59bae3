// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/capabilities_file.h"

#include "billet/diagnostic_kinds.h"
#include "billet/usage.h"

#include <fstream>
#include <vector>

namespace billet {

DiagnosticList write_capabilities(const std::string &folder, MPI_Comm communicator) {
  constexpr auto n = static_cast<std::size_t>(Capability::n);
  std::vector<std::uint64_t> calls, sums(2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const Usage::Entry &entry = Usage::of(static_cast<Capability>(i));
    calls.push_back(entry.calls);
    sums[2 * i] = entry.items;
    sums[2 * i + 1] = entry.peak;
  }
  MPI_Allreduce(MPI_IN_PLACE, calls.data(), static_cast<int>(n), MPI_UINT64_T, MPI_MAX, communicator);
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(2 * n), MPI_UINT64_T, MPI_SUM, communicator);
  if (dealii::Utilities::MPI::this_mpi_process(communicator) != 0)
    return {};
  std::ofstream file(folder + "/capabilities.csv");
  file << "capability,calls,items,bytes\n";
  for (std::size_t i = 0; i < n; ++i)
    file << name_of(static_cast<Capability>(i)) << "," << calls[i] << "," << sums[2 * i] << ","
         << sums[2 * i + 1] << "\n";
  if (!file.flush())
    return {Diagnostic(diagnostic::file_failed, "'" + folder + "/capabilities.csv' cannot be written")};
  return {};
}

} // namespace billet
