// SPDX-License-Identifier: LGPL-2.1-or-later
// Probes of runs, in history.csv and on the console: a bar that is pulled, a block that flies, a cube under a
// die.
#include "implicit_run.h"

#include "billet/run/simulation.h"

#include <fstream>
#include <map>
#include <sstream>

namespace probes_runs_test {

using namespace billet;
using billet::testing::check;
using billet::testing::WorstError;

namespace {

std::vector<std::string> split(const std::string &line) {
  std::vector<std::string> parts;
  std::istringstream stream(line);
  for (std::string part; std::getline(stream, part, ',');)
    parts.push_back(part);
  return parts;
}

/// What a run wrote; on the first rank.
struct Written {
  std::vector<std::string> names;
  std::vector<std::map<std::string, double>> rows;
  std::string console;

  bool shows(const std::string &text) const { return console.find(text) != std::string::npos; }
};

Written run(const parameters::Scene &parameters) {
  Written written;
  std::ostringstream console;
  std::streambuf *const standard_output = std::cout.rdbuf(console.rdbuf());
  run_simulation(parameters, MPI_COMM_WORLD);
  std::cout.rdbuf(standard_output);
  written.console = console.str();
  if (!testing::is_first_rank())
    return written;
  std::ifstream file(parameters.output.folder.value + "/history.csv");
  std::string line;
  std::getline(file, line);
  written.names = split(line);
  while (std::getline(file, line)) {
    written.rows.emplace_back();
    const std::vector<std::string> numbers = split(line);
    for (std::size_t i = 0; i < written.names.size(); ++i)
      written.rows.back()[written.names[i]] = std::strtod(numbers.at(i).c_str(), nullptr);
  }
  return written;
}

void pull_bar() {
  const Written written = run(testing::read_test_scene("probes_bar.prm"));
  if (!testing::is_first_rank())
    return;
  WorstError displacement, stress, strain, mean, width, window;
  bool window_is_empty = false;
  for (const auto &row : written.rows) {
    const double stretch = 1. + 0.1 * row.at("time"), sigma = 2. * std::log(stretch) / stretch;
    displacement.add(std::abs(row.at("inside.displacement_x") - 0.25 * row.at("time")));
    stress.add(std::abs(row.at("inside.stress_xx") - sigma) + std::abs(row.at("inside.stress_xy")));
    stress.add(std::abs(row.at("inside.von_mises_stress") - sigma));
    strain.add(std::abs(row.at("inside.logarithmic_strain_xx") - std::log(stretch)));
    mean.add(std::abs(row.at("free end.mean_stress_xx") - sigma));
    width.add(std::abs(row.at("width.least_thickness") - 1.));
    if (row.at("time") < 0.4)
      window_is_empty = std::isnan(row.at("window.displacement_x"));
    else if (row.at("time") > 0.6) // the end has come to 8.4
      window.add(std::abs(row.at("window.displacement_x") - (8.4 - 8.4 / stretch)));
  }
  check("bar: rows", written.rows.size() == 4);
  check("bar: displacement", displacement.value(), 1e-10);
  check("bar: stress", stress.value(), 1e-10);
  check("bar: logarithmic strain", strain.value(), 1e-10);
  check("bar: mean of a set", mean.value(), 1e-10);
  check("bar: thickness", width.value(), 1e-10);
  check("bar: nothing is at a point in space at first", window_is_empty);
  check("bar: then the material that is there", window.value(), 1e-10);
  check("bar: columns of the console", written.shows("inside.displacement_x") &&
                                           written.shows("inside.von_mises_stress") &&
                                           written.shows("free end.mean_stress_xx"));
  check("bar: values on the console", written.shows("0.1875"));
  check("bar: no others", !written.shows("window.displacement_x"));
  const auto ratio = std::find(written.names.begin(), written.names.end(), "inside.displacement_x");
  check("bar: columns stand behind those of reactions",
        std::find(written.names.begin(), ratio, "force_balance_defect") != ratio &&
            std::find(ratio, written.names.end(), "width.least_thickness") != written.names.end());
}

void fly() {
  const Written written = run(testing::read_test_scene("probes_flight.prm"));
  if (!testing::is_first_rank())
    return;
  WorstError displacement, velocity, position, stress, faces, ratio, window;
  bool comes_later = false;
  for (const auto &row : written.rows) {
    const double t = row.at("time");
    displacement.add(std::abs(row.at("corner.displacement_x") - 3. * t) +
                     std::abs(row.at("corner.displacement_magnitude") - 5. * t));
    position.add(std::abs(row.at("corner.position_y") - 1. - 4. * t) +
                 std::abs(row.at("corner.position_z") - 1.));
    velocity.add(std::abs(row.at("corner.velocity_x") - 3.) +
                 std::abs(row.at("corner.velocity_magnitude") - 5.));
    stress.add(std::abs(row.at("corner.von_mises_stress")));
    for (const std::string name : {"least", "largest", "mean"})
      faces.add(std::abs(row.at("all sides." + name + "_velocity_y") - 4.));
    ratio.add(std::abs(row.at("motion.ratio") - 1.));
    if (t < 0.16) {
      comes_later = comes_later || t > 0.;
      window.add(std::isnan(row.at("window.velocity_x")) ? 0. : 1.);
    } else if (t > 0.19)
      window.add(std::abs(row.at("window.velocity_x") - 3.));
  }
  check("flight: rows", written.rows.size() > 4 && comes_later);
  check("flight: displacement", displacement.value(), 1e-12);
  check("flight: position", position.value(), 1e-12);
  check("flight: velocity", velocity.value(), 1e-12);
  check("flight: no stress", stress.value(), 1e-11);
  check("flight: velocities of the faces", faces.value(), 1e-12);
  check("flight: ratio of energies", ratio.value(), 1e-12);
  check("flight: a point in space", window.value(), 1e-12);
  check("flight: console", written.shows("corner.position_x"));
}

parameters::Probe make_set(const std::string &name, const unsigned int id, const ProbeQuantity::Kind kind) {
  parameters::Probe probe;
  probe.name = name;
  probe.probe.where = ProbedFaces{};
  for (const ProbeQuantity &quantity : probe_quantities())
    if (quantity.kind == kind)
      probe.probe.quantities = {quantity};
  probe.probe.statistics = {ProbeStatistic::mean, ProbeStatistic::largest};
  probe.boundary_ids.value = {id};
  return probe;
}

/// A cube under a frictionless die: the pressure is that of its uniform stress, and the force over the area.
void press_cube() {
  parameters::Scene parameters = testing::read_test_scene("upset_cube.prm");
  parameters.output.folder.value = "probes_cube";
  parameters.probes = {make_set("pressure", 5, ProbeQuantity::Kind::contact_pressure),
                       make_set("stress", 5, ProbeQuantity::Kind::stress),
                       make_set("plastic", 5, ProbeQuantity::Kind::plastic_strain)};
  const Written written = run(parameters);
  if (!testing::is_first_rank())
    return;
  const auto &last = written.rows.back();
  const double pressure = last.at("pressure.mean_contact_pressure");
  check("cube: contact pressure", std::abs(pressure / 975.324 - 1.), 1e-4);
  check("cube: it is uniform", std::abs(last.at("pressure.largest_contact_pressure") / pressure - 1.), 1e-4);
  check("cube: it is that of the elements", std::abs(last.at("stress.mean_stress_zz") / pressure + 1.), 1e-4);
  check("cube: plastic strain", std::abs(last.at("plastic.mean_equivalent_plastic_strain") / 0.911424 - 1.),
        1e-4);
}

} // namespace

BILLET_MPI_TEST(probes_runs) {
  pull_bar();
  fly();
  press_cube();
}

} // namespace probes_runs_test
