// SPDX-License-Identifier: LGPL-2.1-or-later
// An elastic body that is strained farther than its law is stable is named, once, with the law that is; one
// that is not, or yields, is not.
#include "given_solution.h"
#include "materials.h"
#include "scene_run.h"

#include "billet/solve/stability_watch.h"

#include <deal.II/base/mpi.h>

namespace stability_watch_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

/// The message, as text, when the billet is pulled to this logarithmic strain along its axis, and to so much
/// of it across; empty if there is none.
std::string inspect(const double strain, const std::string &elasticity, const bool is_elastic = true,
                    const double across = -0.3) {
  auto parameters = testing::read_shipped_scene("billet_upsetting.prm");
  auto &material = parameters.bodies[0].material;
  if (is_elastic)
    testing::make_elastic(material);
  testing::set_elasticity(material, elasticity, testing::young_modulus(material), 0.3);
  const Scene scene(parameters);
  const Discretization discretization(scene, MPI_COMM_WORLD);
  testing::GivenSolution solution(discretization);
  solution.state().time = 0.5;
  solution.move(0, [&](const dealii::Tensor<1, 3> &X) {
    return dealii::Tensor<1, 3>(
        {X[0] * std::expm1(across * strain), X[1] * std::expm1(across * strain), X[2] * std::expm1(strain)});
  });
  StabilityWatch watch(scene, discretization);
  const DiagnosticList messages = watch.check(solution.state());
  check("reported once",
        watch.check(solution.state()).empty() && watch.has_unstable_bodies() == !messages.empty());
  return messages.empty() ? "" : messages.front().text();
}

bool contains(const std::string &text, const std::string &what) {
  return text.find(what) != std::string::npos;
}

} // namespace

BILLET_MPI_TEST(stability_watch) {
  if (!testing::is_first_rank())
    std::cout.setstate(std::ios::failbit);
  check("Hencky's law at ln -1.5", inspect(-1.5, "Hencky").empty());
  const std::string text = inspect(-2., "Hencky");
  check("at ln -2",
        contains(text, "warning[unstable-law]: The law loses its ellipticity at principal stretches of 0.14, "
                       "1.8 and 1.8") &&
            contains(text,
                     "(body 'billet', time 0.5). Choose 'Elasticity = neo-Hookean', which is stable there"));
  check("the neo-Hookean one", inspect(-2., "neo-Hookean").empty());
  const std::string large = inspect(1., "neo-Hookean", true, 1.);
  check("of a volume 20 times as large",
        contains(large, "loses its ellipticity") && !contains(large, "Elasticity"));
  check("rates of stress at ln -0.7 and -0.8",
        inspect(-0.7, "hypoelastic").empty() &&
            contains(inspect(-0.8, "hypoelastic"), "Elasticity = Hencky"));
  check("a body that yields", inspect(-2., "Hencky", false).empty());
}

} // namespace stability_watch_test
