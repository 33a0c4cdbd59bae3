// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_PROBLEM_CHECKPOINT_H
#define BILLET_SOLVE_IMPLICIT_PROBLEM_CHECKPOINT_H

#include "billet/solve/implicit/implicit_problem.h"
#include "billet/solve/restart.h"

namespace billet {

/// Bodies, tools and contacts of an implicit problem in checkpoints, each in its own group.
class ProblemCheckpoint {
public:
  explicit ProblemCheckpoint(ImplicitProblem &problem) : problem_(problem) {}

  void save_bodies(StateWriter &writer) const;
  void save_tools(StateWriter &writer, const OwnedNodes &nodes) const;
  void save_contacts(StateWriter &writer, const NodeKeys &keys) const;
  /// Loads histories at the displacements of the state. If a body had another formulation, it takes
  /// the stresses from that, and the report is no longer exact.
  void load_bodies(StateReader &reader, RestartReport &report);
  void load_tools(StateReader &reader, const OwnedNodes &nodes);
  void load_contacts(StateReader &reader, const NodeKeys &keys);
  /// Finds the contacts of the state, and builds a matrix for them.
  void update_contacts(StateReader &reader, bool is_exact);

private:
  void save_body(std::size_t body, StateWriter &writer) const;
  /// Returns false if the formulation was another one.
  bool load_body(std::size_t body, StateReader &reader);

  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();
};

} // namespace billet

#endif
