// SPDX-License-Identifier: LGPL-2.1-or-later
// What a scene does not require is neither stored nor solved for: doubles of history, and the kind of matrix,
// of the billet with one thing after another taken away.
#include "materials.h"
#include "scene_run.h"

#include <deal.II/base/mpi.h>

namespace capabilities_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

struct Counts {
  std::size_t of_elements, of_contact, n_contact_nodes;
  bool has_symmetric_matrix;
  Capabilities capabilities;
};

Counts count(const parameters::Scene &parameters) {
  const SceneRun run(parameters);
  std::size_t n_nodes = 0;
  for (const auto &pair : run.problem.report_contacts())
    n_nodes += pair.size();
  const auto sizes = run.problem.history_sizes();
  return {sizes[0], sizes[1], n_nodes, run.problem.method().find("(symmetric") != std::string::npos,
          run.scene.capabilities()};
}

} // namespace

BILLET_MPI_TEST(capabilities) {
  const parameters::Scene full = testing::read_shipped_scene("billet_upsetting.prm");
  const Counts all = count(full);
  check("the whole scene has histories of elements and friction",
        all.of_elements > 0 && all.of_contact > all.n_contact_nodes && all.n_contact_nodes > 0);
  check("and an unsymmetric matrix", !all.has_symmetric_matrix);

  parameters::Scene elastic = full;
  testing::make_elastic(elastic.bodies[0].material);
  check("without plasticity: no history of elements",
        count(elastic).of_elements == 0 && !count(elastic).capabilities.plasticity);

  parameters::Scene frictionless = full;
  frictionless.pairs[0].friction = nullptr;
  const Counts smooth = count(frictionless);
  check("without friction: a gap for each node, and no more",
        smooth.of_contact == smooth.n_contact_nodes && !smooth.capabilities.friction);
  check("without friction: a symmetric matrix", smooth.has_symmetric_matrix);

  parameters::Scene alone = full;
  alone.pairs.clear();
  const Counts free = count(alone);
  check("without contact: no history of contact",
        free.of_contact == 0 && free.n_contact_nodes == 0 && !free.capabilities.contact);
  check("without contact: a symmetric matrix", free.has_symmetric_matrix);
}

} // namespace capabilities_test
