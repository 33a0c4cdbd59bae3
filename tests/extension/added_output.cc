// SPDX-License-Identifier: LGPL-2.1-or-later
// Output that the library does not know, registered here and read back from the files that are written: the
// largest principal stress and the triaxiality of the elements of a pulled cube, twice the displacements of
// its nodes, and a column of the history with the sum of all energies.

#include "pulled_cube.h"
#include "read_field.h"

#include "billet/output/field_quantity.h"
#include "billet/output/history_file.h"

namespace added_output_test {

using namespace billet;
using billet::testing::check;
using billet::testing::max_difference;

namespace {

ElementQuantity stress_state() {
  return {"state of stress",
          "",
          {"largest_principal_stress", "triaxiality"},
          true,
          [](const Scene &scene) { return scene.parameters().output.stress; },
          [](const ElementAverage &average) -> std::vector<double> {
            const auto &sigma = average.cauchy_stress;
            const double mises = std::sqrt(1.5) * dealii::deviator(sigma).norm();
            return {dealii::eigenvalues(sigma)[0], dealii::trace(sigma) / 3. / mises};
          }};
}

NodalQuantity doubled_displacement() {
  return {"doubled displacement", "length",
          [](const Scene &, const Discretization &discretization,
             const Solution &solution) -> std::vector<NodalField> {
            Vector owned = discretization.make_owned_vector(), values = discretization.make_ghosted_vector();
            owned = solution.state().displacements;
            owned *= 2.;
            values = owned;
            return {{{"doubled_x", "doubled_y", "doubled_z"}, false, values}};
          }};
}

HistoryQuantity total_energy() {
  return {"total energy",
          {{"total_energy", "Sum of all energies. [energy]"}},
          [](const Scene &) -> std::vector<std::string> { return {"total_energy"}; },
          [](const HistorySample &sample) -> std::vector<double> { return {sample.state.energies.total()}; }};
}

} // namespace

BILLET_MPI_TEST(added_output) {
  field_quantities().add(stress_state());
  field_quantities().add(doubled_displacement());
  bool is_refused = false;
  try {
    field_quantities().add(stress_state());
  } catch (const std::logic_error &) {
    is_refused = true;
  }
  check("a second one of the same name is refused", is_refused);

  history_quantities().add(total_energy());

  constexpr double stretch = 1.05;
  parameters::Scene scene = testing::read_pulled_cube(
      "mean dilatation", "set Law = elastic\nset Young modulus = 200e3\nset Poisson ratio = 0.3", stretch, 1.,
      false, 1);
  scene.output.format = parameters::Output::Format::hdf5;
  testing::SceneRun run(scene);
  run.finish();

  // Uniaxial Hencky tension: E ln λ = J σ, J = λ^(1 - 2 ν).
  const double strain = std::log(stretch), sigma = testing::cube_young * strain * std::exp(-0.4 * strain);
  const std::string file = testing::write_fields(run.scene, run.problem);
  const auto principal = testing::read_field(file, "largest_principal_stress", 0),
             triaxiality = testing::read_field(file, "triaxiality", 0);
  check("elements", principal.size() == 64 && triaxiality.size() == 64);
  check("largest principal stress", max_difference(principal, std::vector<double>(64, sigma)) / sigma, 1e-6);
  check("triaxiality", max_difference(triaxiality, std::vector<double>(64, 1. / 3.)), 1e-6);
  check("stresses are what they were",
        max_difference(testing::read_field(file, "stress_zz", 0), principal) / sigma, 1e-6);
  std::vector<double> twice = testing::read_field(file, "displacement", 2);
  for (double &value : twice)
    value *= 2.;
  check("nodes", max_difference(testing::read_field(file, "doubled_z", 0), twice), 1e-8);

  HistoryFile(run.scene, "fields").write({}, run.problem);
  std::ifstream history("fields/history.csv");
  std::string columns, values;
  std::getline(history, columns);
  std::getline(history, values);
  check("column", columns.substr(columns.rfind(',') + 1) == "total_energy");
  const double energy = run.problem.state().energies.total();
  check("its value", std::abs(std::stod(values.substr(values.rfind(',') + 1)) / energy - 1.), 1e-12);
}

} // namespace added_output_test
