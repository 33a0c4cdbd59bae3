// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_UNLOADED_H
#define BILLET_TESTS_UNLOADED_H

#include "scene_run.h"

namespace billet::testing {

/// Whether no contact node of the scene touches anything, and none has a traction. On this rank.
inline bool is_open(const SceneRun &run) {
  std::size_t n_nodes = 0;
  for (const auto &pair : run.problem.report_contacts())
    for (const auto &node : pair) {
      ++n_nodes;
      if (node.status != ContactStatus::open || node.traction.norm() != 0. || node.pressure != 0.)
        return false;
    }
  return n_nodes > 0;
}

/// That contact is open without forces; and, in scenes that are elastic throughout, that no stress is left of
/// the elastic energy that was `stored`.
inline void check_unloaded(const std::string &name, const SceneRun &run, const double stored) {
  const SolutionState &state = run.problem.state();
  check(name + "unloaded, nothing touches", is_open(run));
  double force = state.energies.contact;
  for (const auto *loads : {&state.tool_loads, &state.body_pair_loads})
    for (const auto &load : *loads)
      force += load.force.norm() + load.moment.norm() + load.area;
  check(name + "unloaded, there are no contact forces", force == 0.);
  check(name + "unloaded, there is no stress", state.energies.elastic / stored, 1e-12);
  check(name + "no plastic work", state.energies.plastic == 0.);
}

} // namespace billet::testing

#endif
