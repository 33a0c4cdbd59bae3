// SPDX-License-Identifier: LGPL-2.1-or-later
// The program of a folder's tests: runs the one that its first argument names.
#include "checks.h"

#include "billet/run/launch.h"
#include "billet/run/serve.h"
#include "billet/usage.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace {

using billet::Capability;
using billet::Usage;
using billet::testing::Test;
using billet::testing::tests;

/// Number of collective calls of this process.
std::uint64_t n_collective_calls = 0;

/// Prints the numbers that numbers.txt must have, on the first rank.
void print_numbers(const bool uses_mpi) {
  const unsigned int n_ranks = uses_mpi ? dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) : 1;
  if (n_ranks > 1 && dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    return;
  const auto print = [](const char *name, const std::uint64_t value) {
    if (value > 0)
      billet::testing::record(name, static_cast<double>(value));
  };
  print("checks", billet::testing::n_checks());
  print("force loops", billet::ElementLoops::of_forces);
  print("tangent loops", billet::ElementLoops::of_tangents);
  print("contact loops", Usage::of(Capability::contact).calls);
  print("factorisations", Usage::of(Capability::matrix).calls);
  print("linear iterations", Usage::of(Capability::iterative_solver).items);
  if (n_ranks > 1)
    print("collective calls", n_collective_calls);
}

} // namespace

// Collective calls are counted on their way to MPI, by its profiling interface.
#define BILLET_COUNT_CALLS(name, parameters, arguments)                                                      \
  extern "C" int MPI_##name parameters {                                                                     \
    ++n_collective_calls;                                                                                    \
    return PMPI_##name arguments;                                                                            \
  }

BILLET_COUNT_CALLS(Allreduce,
                   (const void *from, void *to, int n, MPI_Datatype type, MPI_Op op, MPI_Comm communicator),
                   (from, to, n, type, op, communicator))
BILLET_COUNT_CALLS(Bcast, (void *data, int n, MPI_Datatype type, int root, MPI_Comm communicator),
                   (data, n, type, root, communicator))
BILLET_COUNT_CALLS(Barrier, (MPI_Comm communicator), (communicator))
BILLET_COUNT_CALLS(Allgather,
                   (const void *from, int n, MPI_Datatype type, void *to, int n_to, MPI_Datatype type_to,
                    MPI_Comm communicator),
                   (from, n, type, to, n_to, type_to, communicator))

BILLET_COUNT_CALLS(Allgatherv,
                   (const void *from, int n, MPI_Datatype type, void *to, const int *n_to, const int *places,
                    MPI_Datatype type_to, MPI_Comm communicator),
                   (from, n, type, to, n_to, places, type_to, communicator))
BILLET_COUNT_CALLS(Gather,
                   (const void *from, int n, MPI_Datatype type, void *to, int n_to, MPI_Datatype type_to,
                    int root, MPI_Comm communicator),
                   (from, n, type, to, n_to, type_to, root, communicator))
BILLET_COUNT_CALLS(Gatherv,
                   (const void *from, int n, MPI_Datatype type, void *to, const int *n_to, const int *places,
                    MPI_Datatype type_to, int root, MPI_Comm communicator),
                   (from, n, type, to, n_to, places, type_to, root, communicator))
BILLET_COUNT_CALLS(Reduce,
                   (const void *from, void *to, int n, MPI_Datatype type, MPI_Op op, int root,
                    MPI_Comm communicator),
                   (from, to, n, type, op, root, communicator))
BILLET_COUNT_CALLS(Exscan,
                   (const void *from, void *to, int n, MPI_Datatype type, MPI_Op op, MPI_Comm communicator),
                   (from, to, n, type, op, communicator))
BILLET_COUNT_CALLS(Alltoall,
                   (const void *from, int n, MPI_Datatype type, void *to, int n_to, MPI_Datatype type_to,
                    MPI_Comm communicator),
                   (from, n, type, to, n_to, type_to, communicator))

int main(int argc, char *argv[]) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words == std::vector<std::string>{"--serve"}) {
    const auto run = billet::serve_runs();
    if (!run)
      return 0;
    words = *run;
  }
  const auto chosen = std::find_if(tests().begin(), tests().end(), [&](const Test &test) {
    return !words.empty() && test.name == words.front();
  });
  if (chosen == tests().end()) {
    std::cerr << "Usage: " << argv[0] << " NAME [ARGUMENT...], one of" << std::endl;
    for (const Test &test : tests())
      std::cerr << "  " << test.name << std::endl;
    return 2;
  }
  billet::testing::arguments().assign(words.begin() + 1, words.end());
  std::optional<billet::ProcessAlone> alone;
  std::optional<dealii::Utilities::MPI::MPI_InitFinalize> mpi;
  if (chosen->uses_mpi) {
    alone.emplace();
    mpi.emplace(argc, argv, 1);
  }
  chosen->run();
  print_numbers(chosen->uses_mpi);
  return billet::testing::exit_code();
}
