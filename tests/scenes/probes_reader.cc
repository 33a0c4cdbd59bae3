// SPDX-License-Identifier: LGPL-2.1-or-later
// What probes read of a sheet that formulas deform, against these formulas; and the same last bit on one, two
// and three ranks.
#include "billet/output/probe_reader.h"

#include "given_solution.h"
#include "restart_run.h"

#include <map>

namespace probes_reader_test {

using namespace billet;
using billet::testing::check;
using dealii::Tensor;

namespace {

/// Undeformed to deformed position: the thickness is 0.5 (1 + 0.025 X), the lower side stays plane.
Tensor<1, 3> deformed(const Tensor<1, 3> &X) {
  return Tensor<1, 3>({1.1 * X[0], 0.9 * X[1], X[2] * (1. + 0.025 * X[0])});
}

class FormulaSolution final : public billet::testing::GivenSolution {
public:
  explicit FormulaSolution(const Discretization &discretization) : GivenSolution(discretization) {
    move(0, [](const Tensor<1, 3> &X) { return deformed(X) - X; });
    state_.velocities = discretization.make_ghosted_vector();
    set(state_.velocities, 0, [](const Tensor<1, 3> &) { return Tensor<1, 3>({1., 2., 2.}); });
    state_.energies.kinetic = 1.;
    state_.energies.elastic = 3.;
  }

  std::vector<ElementSummary> summarize(const std::size_t body) const override {
    std::vector<ElementSummary> summaries;
    for (const Element &element : discretization_.elements(body)) {
      ElementSummary summary;
      summary.cauchy_stress[0][0] = element.cell->center()[0];
      summary.cauchy_stress[1][2] = 1.;
      summary.equivalent_plastic_strain = 0.25;
      summaries.push_back(summary);
    }
    return summaries;
  }
};

std::vector<double> read(const Scene &scene, const MPI_Comm communicator) {
  const Discretization discretization(scene, communicator);
  const ProbeReader reader(scene, discretization);
  return reader.read(FormulaSolution(discretization));
}

/// Values by the names of their columns.
class Columns {
public:
  Columns(const Scene &scene, const std::vector<double> &values) {
    const std::vector<std::string> names = probe_columns(scene);
    check("a value for each column", names.size() == values.size());
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i)
      values_[names[i]] = values[i];
    check("no column twice", values_.size() == names.size());
  }

  double operator[](const std::string &name) const { return values_.at(name); }
  void check_value(const std::string &name, const double value) const {
    check(name, std::abs(values_.at(name) - value), 1e-12);
  }
  void check_vector(const std::string &name, const Tensor<1, 3> &value) const {
    Tensor<1, 3> found;
    for (unsigned int i = 0; i < 3; ++i)
      found[i] = values_.at(name + "_" + std::string(1, "xyz"[i]));
    check(name, (found - value).norm(), 1e-12);
  }

private:
  std::map<std::string, double> values_;
};

void check_points(const Columns &columns) {
  const Tensor<1, 3> X({1.3, 0.2, 0.25}), u = deformed(X) - X;
  columns.check_vector("carried.displacement", u);
  columns.check_value("carried.displacement_magnitude", u.norm());
  columns.check_vector("carried.position", deformed(X));
  columns.check_vector("carried.velocity", Tensor<1, 3>({1., 2., 2.}));
  columns.check_value("carried.velocity_magnitude", 3.);
  columns.check_value("carried.stress_xx", 1.5); // at the centre of the element
  columns.check_value("carried.stress_yz", 1.);
  columns.check_value("carried.von_mises_stress", std::sqrt(1.5 * 1.5 + 3.));
  columns.check_value("carried.pressure", -0.5);
  columns.check_value("carried.logarithmic_strain_yy", std::log(0.9));
  columns.check_vector("node.position", deformed(Tensor<1, 3>({1., 0., 0.})));
  // Radial, circumferential and axial.
  columns.check_vector("turned.displacement", Tensor<1, 3>({-0.2, -0.05, 0.003125}));
  columns.check_value("turned.stress_yy", 0.5);
  columns.check_value("turned.stress_xz", 1.);
  columns.check_value("turned.logarithmic_strain_xx", std::log(0.9));
  const Tensor<1, 3> there({2.2, 0.9, 0.1}), material({2., 1., 0.1 / 1.05});
  columns.check_vector("fixed.displacement", there - material);
  check("a point in space outside of the body", std::isnan(columns["outside.position_x"]));
}

void check_paths(const Columns &columns) {
  for (int i = 0; i < 5; ++i)
    columns.check_value("line." + std::to_string(i + 1) + ".displacement_x", 0.1 * (-4. + 2. * i));
  columns.check_value("line.least_displacement_x", -0.4);
  columns.check_value("line.largest_displacement_x", 0.4);
  columns.check_value("line.mean_displacement_x", 0.);
  columns.check_value("line.sum_displacement_z", 0.);
  // Two of three points are in the body.
  columns.check_value("front.least_position_x", 3.3);
  columns.check_value("front.largest_position_x", 4.4);
  columns.check_value("front.mean_position_x", 3.85);
}

void check_sets(const Columns &columns) {
  columns.check_value("top.least_position_z", 0.45);
  columns.check_value("top.largest_position_z", 0.55);
  columns.check_value("top.mean_position_z", 0.5);
  columns.check_value("top.sum_position_z", 81 * 0.5);
  columns.check_value("top.largest_velocity_magnitude", 3.);
  columns.check_value("top.mean_velocity_y", 2.);
  // 64 faces of area 1 on top, 8 of area 0.5 at the rim.
  columns.check_value("elements.least_stress_xx", -3.5);
  columns.check_value("elements.largest_stress_xx", 3.5);
  columns.check_value("elements.mean_stress_xx", 3.5 * 4. / 68.);
  columns.check_value("elements.sum_stress_xx", 28.);
  columns.check_value("elements.mean_equivalent_plastic_strain", 0.25);
}

void check_sheet(const Columns &columns) {
  const auto thickness = [](const double X) { return 0.5 * (1. + 0.025 * X); };
  columns.check_value("gauge.least_thickness", thickness(-3.5));
  columns.check_value("gauge.largest_thickness", thickness(3.5));
  columns.check_value("gauge.mean_thickness", 0.5);
  columns.check_value("caliper.thickness", thickness(1.3));
  for (const std::string name : {"least", "largest", "mean"})
    columns.check_value("pull." + name + "_draw_in", 0.4);
  columns.check_value("pull.sum_draw_in", 18 * 0.4);
  columns.check_value("centre.least_draw_in", -0.4);
  columns.check_value("centre.largest_draw_in", std::hypot(4., 4.) - std::hypot(4.4, 3.6));
  columns.check_value("share.ratio", 0.25);
}

/// Returns the message of a scene whose probe cannot be placed.
std::string refusal(parameters::Scene parameters, const std::string &name, const Probe &probe) {
  for (auto &input : parameters.probes)
    if (input.name == name)
      input.probe.where = probe.where;
  try {
    read(Scene(parameters), MPI_COMM_WORLD);
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

} // namespace

BILLET_MPI_TEST(probes_reader) {
  if (!testing::is_first_rank())
    std::cout.setstate(std::ios::failbit); // one rank speaks
  const parameters::Scene parameters = testing::read_test_scene("probes_sheet.prm");
  const Scene scene(parameters);
  const std::vector<double> values = read(scene, MPI_COMM_WORLD);
  const Columns columns(scene, values);
  check_points(columns);
  check_paths(columns);
  check_sets(columns);
  check_sheet(columns);
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  for (unsigned int n = 1; n <= n_ranks; ++n)
    testing::on_ranks(n, [&](const MPI_Comm some) {
      const std::vector<double> others = read(scene, some);
      check("same bits on " + std::to_string(n), testing::are_same_bits({values}, {others}));
    });
  const ProbedPoints away{{dealii::Point<3>(9., 0., 0.)}, ProbedPoints::Place::material};
  check("a point outside is refused",
        refusal(parameters, "carried", Probe{away}).find("is not in the undeformed body 'sheet'") !=
            std::string::npos);
  check("a point far from the faces is refused",
        refusal(parameters, "caliper", Probe{ProbedThickness{dealii::Point<3>(0., 0., 9.)}})
                .find("from the faces of 'Boundary ids'") != std::string::npos);
}

} // namespace probes_reader_test
