// SPDX-License-Identifier: LGPL-2.1-or-later
// Explicit scenes whose elements compute in float: a small Taylor bar has the history that it has in double;
// a brick that flies, turns and rings for 10,000 steps keeps its energy and its momenta.
#include "explicit_run.h"
#include "materials.h"

#include <deal.II/base/mpi.h>

#include <map>
#include <vector>

namespace explicit_float_test {

using namespace billet;
using billet::testing::check;
using billet::testing::WorstError;

namespace {

using History = std::map<std::string, std::vector<double>>;

/// Extents, forces, energies and momenta at every interval.
History run(parameters::Scene scene, const NumberType number_type, const double interval) {
  scene.explicit_dynamics.number_type = number_type;
  testing::ExplicitRun problem(scene);
  History history;
  problem.finish(interval, [&] {
    const SolutionState &state = problem.state();
    double highest = 0., widest = 0.;
    for (const auto &element : problem.discretization.elements(0))
      for (unsigned int a = 0; a < n_element_nodes; ++a) {
        const auto x = element.cell->vertex(a);
        widest = std::max(widest, x[0] + state.displacements(element.dofs[std::size_t{3} * a]));
        highest = std::max(highest, x[2] + state.displacements(element.dofs[3 * a + 2]));
      }
    history["height"].push_back(highest);
    history["width"].push_back(widest);
    if (!state.tool_loads.empty())
      history["force"].push_back(state.tool_loads[0].force[2]);
    history["kinetic energy"].push_back(state.energies.kinetic);
    history["elastic energy"].push_back(state.energies.elastic);
    history["plastic work"].push_back(state.energies.plastic);
    history["viscosity"].push_back(state.energies.viscous);
    history["hourglass energy"].push_back(state.energies.hourglass);
    history["energy"].push_back(state.energies.total());
    history["momentum"].push_back(state.momentum.norm());
    history["angular momentum"].push_back(state.angular_momentum.norm());
    history["drift"].push_back(problem.problem.relative_drift());
  });
  return history;
}

double maximum(const std::vector<double> &values) {
  double result = 0.;
  for (const double value : values)
    result = std::max(result, std::abs(value));
  return result;
}

void test_taylor_bar(const BrickElement element) {
  parameters::Scene scene = parameters::Scene::read(std::string(SOURCE_DIR) + "/../../prm/taylor_bar.prm");
  scene.bodies[0].mesh.refinements = 1;
  scene.bodies[0].mesh.n_layers = 16;
  scene.bodies[0].element.value.type = element;
  const History exact = run(scene, NumberType::double_precision, 4e-6),
                rounded = run(scene, NumberType::float_precision, 4e-6);
  const std::string name = element == BrickElement::one_point ? "one point" : "mean dilatation";
  const double energy = exact.at("energy").front();
  for (const auto &[column, values] : exact) {
    if (column == "momentum" || column == "angular momentum" || column == "energy")
      continue;
    const bool is_energy = column != "height" && column != "width" && column != "force" && column != "drift";
    const double scale = is_energy ? energy : column == "drift" ? 1. : maximum(values);
    WorstError error;
    for (std::size_t k = 0; k < values.size(); ++k)
      error.add(std::abs(values[k] - rounded.at(column)[k]) / scale);
    check("Taylor bar, " + name + ", " + column, error.value(), column == "force" ? 1e-4 : 2e-6);
  }
}

/// It turns by a fifth of a circle, in strains of 1e-3 and some 10,000 steps.
void test_flight(const BrickElement element, const std::string &elasticity) {
  parameters::Scene scene = testing::read_test_scene("explicit_float.prm");
  scene.bodies[0].element.value.type = element;
  testing::set_elasticity(scene.bodies[0].material, elasticity);
  const double interval = scene.time_stepping.end_time / 100.;
  const History exact = run(scene, NumberType::double_precision, interval),
                rounded = run(scene, NumberType::float_precision, interval);
  const std::string name = std::string("flight, ") +
                           (element == BrickElement::one_point ? "one point, " : "mean dilatation, ") +
                           elasticity + ", ";
  for (const auto &[column, tolerance] :
       {std::make_pair("momentum", 1e-12), std::make_pair("angular momentum", 1e-6)}) {
    WorstError error;
    for (const double value : rounded.at(column))
      error.add(std::abs(value / rounded.at(column).front() - 1.));
    check(name + column, error.value(), tolerance);
  }
  WorstError drift;
  for (std::size_t k = 0; k < exact.at("drift").size(); ++k)
    drift.add(std::abs(exact.at("drift")[k] - rounded.at("drift")[k]));
  check(name + "drift of the energy, beyond that in double", drift.value(), 1e-5);
}

} // namespace

BILLET_MPI_TEST(explicit_float) {
  for (const auto element : {BrickElement::mean_dilatation, BrickElement::one_point}) {
    test_taylor_bar(element);
    test_flight(element, "Hencky");
    test_flight(element, "neo-Hookean");
    test_flight(element, "hypoelastic");
  }
}

} // namespace explicit_float_test
