// SPDX-License-Identifier: LGPL-2.1-or-later
// Where Newton's method fails with stiff penalties softer ones lead to them, and nothing of those is left in
// the solution; where it fails with another tangent the exact one takes over.
#include "billet/diagnostic_kinds.h"
#include "scene_run.h"

#include <deal.II/base/mpi.h>

#include <map>

namespace stiff_penalties_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

struct Drawn {
  unsigned int n_reported = 0;
  dealii::Tensor<1, 3> force;
  std::map<DofIndex, double> springs; ///< pressure over depth of nodes that press
};

parameters::Scene make_scene(const double penalty, const double tangential) {
  parameters::Scene scene = parameters::Scene::read(std::string(SOURCE_DIR) + "/drawn_block.prm");
  scene.pairs[0].friction = make_coulomb(0.25);
  scene.pairs[0].penalty.normal = penalty;
  scene.pairs[0].penalty.tangential = tangential;
  return scene;
}

bool contains(const NewtonReport &report) {
  return find(report.diagnostics, diagnostic::penalty_too_high) != nullptr;
}

Drawn draw(const double penalty, const double tangential) {
  SceneRun run(make_scene(penalty, tangential));
  Drawn drawn;
  run.finish([&](const NewtonReport &report) { drawn.n_reported += contains(report) ? 1 : 0; });
  const ContactLoad &load = run.problem.state().body_pair_loads[0];
  drawn.force = load.force;
  for (const auto &reports : run.problem.report_contacts())
    for (const auto &node : reports)
      if (node.pressure > 0.)
        drawn.springs[node.dofs[0]] = -node.pressure / node.gap;
  return drawn;
}

double difference(const dealii::Tensor<1, 3> &a, const dealii::Tensor<1, 3> &b) {
  return (a - b).norm() / b.norm();
}

} // namespace

BILLET_MPI_TEST(stiff_penalties) {
  const Drawn usual = draw(10., 10.), sticky = draw(10., 1e5), stiff = draw(1e5, 1e5), less = draw(1e3, 1e3);
  check("the usual penalty needs no other ones", usual.n_reported == 0 && less.n_reported == 0);
  check("the stiff one does, which is reported", stiff.n_reported >= 1);
  check("with stiff tangential ones only, too", sticky.n_reported >= 1);
  check("stick that is stiffer changes no force here", difference(sticky.force, usual.force), 1e-4);
  check("the force is about that of a penalty less stiff", difference(stiff.force, less.force), 0.05);
  testing::WorstError penalty;
  for (const auto &[dof, spring] : stiff.springs)
    if (less.springs.count(dof) > 0)
      penalty.add(std::abs(spring / (100. * less.springs.at(dof)) - 1.));
  check("nodes press in both", stiff.springs.size() > 2 && less.springs.size() > 2);
  check("at the end penalties are those of the scene", penalty.value(), 1e-6);

  parameters::Scene symmetrised = make_scene(10., 10.);
  symmetrised.solver.contact_tangent = parameters::ContactTangent::symmetrised_upper;
  symmetrised.solver.linear_solver.value = DirectMethod::mumps_symmetric;
  symmetrised.time_stepping.min_step = 5e-3; // so that it fails soon
  SceneRun rescued(symmetrised);
  bool has_failed = false;
  try {
    rescued.finish();
  } catch (const SolutionFailure &) {
    has_failed = true;
  }
  check("a symmetrised tangent fails", has_failed);
  check("the exact one takes over", rescued.problem.equation().parts().tangent().take_exact());
  rescued.finish();
  check("and ends the run with its solution",
        difference(rescued.problem.state().body_pair_loads[0].force, usual.force), 0.01);
  check("it can be taken once", !rescued.problem.equation().parts().tangent().take_exact());
}

} // namespace stiff_penalties_test
