// SPDX-License-Identifier: LGPL-2.1-or-later
// The history of an explicit scene on 1, 3 and 4 ranks, and with restarts on 2 in restart.cc: each number as
// on one, but for round-off.
#include "explicit_run.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <vector>

namespace explicit_ranks_test {

using namespace billet;
using billet::testing::check;

namespace {

/// Named columns over time.
using History = std::vector<std::pair<std::string, std::vector<double>>>;

/// Rigid motion, forces and energies at every 10 µs, on the first `n` ranks.
History run(const unsigned int n) {
  History history;
  testing::on_ranks(n, [&](MPI_Comm some) {
    testing::ExplicitRun scene(testing::read_test_scene("explicit_ranks.prm"), some);
    scene.finish(10e-6, [&] {
      const SolutionState &state = scene.state();
      std::size_t column = 0;
      const auto add = [&](const std::string &name, const double value) {
        if (column == history.size())
          history.push_back({name, {}});
        history[column++].second.push_back(value);
      };
      for (unsigned int i = 0; i < 3; ++i) {
        const std::string axis(1, static_cast<char>('x' + i));
        add("momentum " + axis, state.momentum[i]);
        add("angular momentum " + axis, state.angular_momentum[i]);
        add("force of the tool, " + axis, state.tool_loads[0].force[i]);
        add("force between the bodies, " + axis, state.body_pair_loads[0].force[i]);
      }
      add("way of the tool", state.placements[0].translation[2]);
      add("area on the tool", state.tool_loads[0].area);
      add("area between the bodies", state.body_pair_loads[0].area);
      add("kinetic energy", state.energies.kinetic);
      add("elastic energy", state.energies.elastic);
      add("plastic work", state.energies.plastic);
      add("contact energy", state.energies.contact);
      add("friction", state.energies.friction);
      add("viscosity", state.energies.viscous);
      add("work", state.energies.external);
    });
  });
  return history;
}

} // namespace

BILLET_MPI_TEST(explicit_ranks) {
  const History one = run(1);
  for (unsigned int n = 3; n <= dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD); ++n) {
    const History several = run(n);
    if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
      continue; // one rank compares
    std::cout << n << " ranks:" << std::endl;
    for (std::size_t c = 0; c < one.size(); ++c) {
      double maximum = 0.;
      testing::WorstError error;
      for (std::size_t i = 0; i < one[c].second.size(); ++i) {
        maximum = std::max(maximum, std::abs(one[c].second[i]));
        error.add(std::abs(several[c].second[i] - one[c].second[i]));
      }
      check("  " + one[c].first, maximum > 0. ? error.value() / maximum : 1., 1e-10);
    }
  }
}

} // namespace explicit_ranks_test
