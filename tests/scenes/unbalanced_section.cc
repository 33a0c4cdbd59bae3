// SPDX-License-Identifier: LGPL-2.1-or-later
// What residuals leave out of balance in an axisymmetric section: the part is that of the wedge, and the
// figures along the axis are those of the full circle, as on the console.
#include "given_solution.h"
#include "implicit_run.h"

#include "billet/solve/unbalanced_bodies.h"

#include <deal.II/base/mpi.h>

namespace unbalanced_section_test {

using namespace billet;
using billet::testing::check;
using dealii::Tensor;

namespace {

/// Forces on the wedge of one body between a tool and a symmetry plane, of which a part is missing.
class UnbalancedSolution final : public billet::testing::GivenSolution {
public:
  UnbalancedSolution(const Scene &scene, const Discretization &discretization, const Tensor<1, 3> &force,
                     const double missing)
      : GivenSolution(discretization) {
    reactions_.of_supports.resize(named_supports(scene).size());
    reactions_.of_supports[0].force = (1. - missing) * force;
    reactions_.of_tool_pairs.resize(1);
    reactions_.of_tool_pairs[0].force = -force;
    reactions_.of_bodies = {{missing * force, 10.}};
  }
};

/// Returns the message as text; empty without one.
std::string inspect(const Scene &scene, const Tensor<1, 3> &force, const double missing) {
  const Discretization discretization(scene, MPI_COMM_WORLD);
  UnbalancedBodies bodies(scene, discretization);
  bodies.add(UnbalancedSolution(scene, discretization, force, missing));
  const DiagnosticList messages = bodies.judge();
  return messages.empty() ? "" : messages.front().text();
}

bool contains(const std::string &text, const std::string &what) {
  return text.find(what) != std::string::npos;
}

} // namespace

BILLET_MPI_TEST(unbalanced_section) {
  const Scene scene(parameters::Scene::read(std::string(SOURCE_DIR) + "/../cli/doubtful/axial.prm"));
  const Tensor<1, 3> along({0., 0., 1.}), across({1., 0., 0.});
  check("the whole circle is 72 wedges", std::abs(scene.whole_section().factor - 72.09) < 0.01);
  check("2 % are not told", inspect(scene, along, 0.019).empty());
  const std::string axial = inspect(scene, along, 0.05);
  check("along the axis: the full circle",
        contains(axial, "leave up to 3.6 along z out of balance, 5 % of the largest force") &&
            contains(axial, "along z, 72.1, which is small beside all nodal forces, 721:") &&
            contains(axial, "(forces of the full circle)"));
  const std::string radial = inspect(scene, across, 0.05);
  check("across it: the wedge",
        contains(radial, "leave up to 0.05 along x out of balance, 5 % of the largest force") &&
            contains(radial, "(forces of the wedge)"));
}

} // namespace unbalanced_section_test
