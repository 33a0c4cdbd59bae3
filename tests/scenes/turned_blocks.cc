// SPDX-License-Identifier: LGPL-2.1-or-later
// Two blocks that are pressed and pushed on each other are turned by 60 degrees, 10 in each step, their
// contact with them: in the frame that turns, the tractions of every node, friction's among them, stay as
// they are. Pulled apart, nothing is left of them.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

#include <map>

namespace turned_blocks_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using billet::testing::WorstError;
using dealii::Tensor;

namespace {

using Facets = FacetMethod;
using Passes = parameters::ContactPair::Passes;

struct NodeState {
  Tensor<1, 3> traction;
  double gap;
  ContactStatus status;
};

std::map<DofIndex, NodeState> node_states(const SceneRun &run) {
  std::map<DofIndex, NodeState> states;
  const auto reports = run.problem.report_contacts();
  for (const auto &node : reports[0])
    states[node.dofs[0]] = {node.traction, node.gap, node.status};
  return states;
}

/// About the y axis, as the scene turns the ends.
Tensor<1, 3> turn_back(const Tensor<1, 3> &v, const double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return Tensor<1, 3>({c * v[0] - s * v[2], v[1], s * v[0] + c * v[2]});
}

void test(const std::string &name, const Facets facets, const Passes passes) {
  parameters::Scene parameters = testing::read_shipped_scene("turned_blocks.prm");
  parameters.pairs[0].facets.method.value = facets;
  parameters.pairs[0].facets.passes = passes;
  parameters.time_stepping.initial_step = 1.; // twice the scene's: 10 degrees
  // A sixth of the scene's turn, then half of its way apart, over which they part.
  for (auto &amplitude : parameters.amplitudes)
    if (amplitude.name == "press") {
      amplitude.times = {0., 1., 7., 10.};
      amplitude.values = {0., 1., 1., -0.3};
    } else {
      amplitude.times = {1., 7.};
      amplitude.values = {0., M_PI / 3.};
    }
  parameters.time_stepping.end_time = 10.;
  SceneRun blocks(parameters);
  blocks.advance();
  const auto pressed = node_states(blocks);
  const double stored = blocks.problem.state().energies.elastic;
  double traction = 0., depth = 0.;
  bool sticks = false, slips = false;
  for (const auto &[dof, node] : pressed) {
    traction = std::max(traction, node.traction.norm());
    depth = std::max(depth, -node.gap);
    sticks = sticks || node.status == ContactStatus::stick;
    slips = slips || node.status == ContactStatus::slip;
  }
  check(name + ": some nodes stick, others have slipped", sticks && slips);

  WorstError tractions, gaps, energy;
  while (blocks.control.time() < 7. - 1e-9) {
    blocks.advance();
    const double angle = M_PI / 18. * (blocks.control.time() - 1.);
    for (const auto &[dof, node] : node_states(blocks)) {
      tractions.add((turn_back(node.traction, angle) - pressed.at(dof).traction).norm() / traction);
      if (pressed.at(dof).status != ContactStatus::open)
        gaps.add(std::abs(node.gap - pressed.at(dof).gap) / depth);
    }
    energy.add(std::abs(blocks.problem.state().energies.elastic / stored - 1.));
  }
  check(name + ": tractions turn along", tractions.value(), 1e-9);
  check(name + ": gaps stay", gaps.value(), 1e-9);
  check(name + ": elastic energy stays", energy.value(), 1e-9);

  blocks.finish();
  WorstError left;
  for (const auto &[dof, node] : node_states(blocks))
    left.add(node.status == ContactStatus::open ? node.traction.norm() : 1.);
  check(name + ": apart, there are no tractions", left.value(), 0.);
  check(name + ": apart, there is no stress", blocks.problem.state().energies.elastic / stored, 1e-15);
}

} // namespace

BILLET_MPI_TEST(turned_blocks) {
  test("overlap", Facets::overlap, Passes::one);
  test("planed, one pass", Facets::planed, Passes::one);
  test("planed, two passes", Facets::planed, Passes::two);
}

} // namespace turned_blocks_test
