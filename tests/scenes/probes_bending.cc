// SPDX-License-Identifier: LGPL-2.1-or-later
// Stresses and strains that probes read at the faces of bricks that bend, one through the thickness, and in a
// wedge, against closed forms: a strip with a constant curvature, elastic and perfectly plastic, with two
// points and with layers; a cantilever; Lamé's pipe.
#include "implicit_run.h"
#include "materials.h"

#include "billet/output/probe_reader.h"

#include <map>

namespace probes_bending_test {

using namespace billet;
using billet::testing::check;

namespace {

using Columns = std::map<std::string, double>;

/// Returns the values of the probes at the end of a run.
Columns run_to_end(const parameters::Scene &parameters) {
  testing::SceneRun run(parameters);
  run.finish();
  const ProbeReader reader(run.scene, run.discretization);
  const std::vector<double> values = reader.read(run.problem);
  const std::vector<std::string> names = probe_columns(run.scene);
  Columns columns;
  for (std::size_t i = 0; i < names.size(); ++i)
    columns[names[i]] = values[i];
  return columns;
}

void check_near(const std::string &name, const double value, const double exact, const double tolerance) {
  check(name, std::abs(value / exact - 1.), tolerance);
}

parameters::Scene read_strip(const unsigned int n_points, const std::string &axis, const double curvature) {
  parameters::Scene scene = testing::read_test_scene("probes_bent.prm");
  scene.bodies[0].element.value.points_through = n_points;
  if (n_points > 2)
    scene.bodies[0].element.value.thickness_direction = {"0", "0", axis};
  scene.bodies[0].supports[1].displacement.value[0] = "4*t*z*" + std::to_string(curvature);
  return scene;
}

void bend_elastic(const unsigned int n_points, const std::string &axis) {
  constexpr double poisson = 0.3, curvature = 1e-4, strain = 0.5 * curvature,
                   stress = 1e5 / (1. - poisson * poisson) * strain;
  const std::string name = std::to_string(n_points) + " points" + (axis == "1" ? "" : ", downwards");
  const Columns at = run_to_end(read_strip(n_points, axis, curvature));
  constexpr double tolerance = 2e-3;
  for (const std::string value : {"least", "largest"}) {
    check_near(name + ", top, " + value, at.at("top." + value + "_stress_xx"), stress, tolerance);
    check_near(name + ", across, " + value, at.at("top." + value + "_stress_yy"), poisson * stress,
               tolerance);
    check(name + ", no normal stress, " + value, std::abs(at.at("top." + value + "_stress_zz")) / stress,
          tolerance);
    check_near(name + ", strain, " + value, at.at("top." + value + "_logarithmic_strain_xx"), strain,
               tolerance);
    check_near(name + ", thinning, " + value, at.at("top." + value + "_logarithmic_strain_zz"),
               -poisson / (1. - poisson) * strain, tolerance);
  }
  check_near(name + ", bottom", at.at("bottom.mean_stress_xx"), -stress, tolerance);
  check(name + ", mean over the end", std::abs(at.at("end.mean_stress_xx")) / stress, tolerance);
  check_near(name + ", point", at.at("at top.stress_xx"), stress, tolerance);
  for (int i = -2; i <= 2; ++i)
    check(name + ", path " + std::to_string(i),
          std::abs(at.at("through." + std::to_string(i + 3) + ".stress_xx") / stress - 0.5 * i), tolerance);
}

/// A strip that hardens by 1e-4 E, at 1.5 and three times the curvature of its elastic limit: no probe reads
/// more than the yield stress, and none less, since the strip flows at its face.
void bend_plastic(const unsigned int n_points, const double multiple) {
  constexpr double yield_stress = 10., poisson = 0.3;
  const double first_yield =
      2. * yield_stress * (1. - poisson * poisson) / (1e5 * std::sqrt(1. - poisson + poisson * poisson));
  parameters::Scene scene = read_strip(n_points, "1", multiple * first_yield);
  testing::set_hardening(scene.bodies[0].material, LinearHardening{yield_stress, 10.});
  scene.solver.force_tolerance = 1e-8;
  scene.solver.energy_tolerance = 1e-12;
  scene.time_stepping.initial_step = 0.05;
  const Columns at = run_to_end(scene);
  const std::string name =
      "plastic, " + std::to_string(n_points) + " points, " + std::to_string(static_cast<int>(10. * multiple));
  check_near(name + ", top", at.at("top.largest_von_mises_stress"), yield_stress, 1e-3);
  check_near(name + ", point", at.at("at top.von_mises_stress"), yield_stress, 1e-3);
  check(name + ", path", at.at("through.4.von_mises_stress") < yield_stress * (1. + 1e-6));
}

void bend_cantilever() {
  const Columns at = run_to_end(testing::read_test_scene("probes_cantilever.prm"));
  constexpr double force = 1.2, modulus = 1. / 6.;
  // Bricks have the bending stress of their middle; the first is clamped.
  check_near("cantilever, root", at.at("top.largest_stress_xx"), force * 39. / modulus, 0.03);
  check_near("cantilever, mean", at.at("top.mean_stress_xx"), force * 20. / modulus, 0.01);
  check_near("cantilever, middle, below", at.at("middle.stress_xx"), -force * 19. / modulus, 0.01);
}

void press_pipe() {
  const Columns at = run_to_end(testing::read_test_scene("probes_pipe.prm"));
  const auto mean = [](const double r) { return 100. * 100. / 96. * (196. / (r * r)); };
  const auto stress = [&](const double r, const double sign) { return 100. * 100. / 96. + sign * mean(r); };
  check("pipe, no shear at the bore", std::abs(at.at("bore.stress_xy")) / 100., 1e-6);
  check("pipe, no shear strain", std::abs(at.at("bore.logarithmic_strain_xy")), 1e-12);
  check_near("pipe, hoop at the bore", at.at("bore.stress_yy"), stress(10., 1.), 0.03);
  for (int i = 1; i <= 8; ++i) {
    const std::string name = "profile." + std::to_string(i);
    const double r = 9.75 + 0.5 * i;
    check(name + ", no shear", std::abs(at.at(name + ".stress_xy")) / 100., 1e-6);
    check_near(name + ", hoop", at.at(name + ".stress_yy"), stress(r, 1.), 0.01);
    check(name + ", radius", std::abs(at.at(name + ".stress_xx") - stress(r, -1.)) / 100., 0.01);
  }
}

} // namespace

BILLET_MPI_TEST(probes_bending) {
  for (const unsigned int n : all_points_through)
    for (const std::string axis : {"1", "-1"})
      if (n > 2 || axis == "1")
        bend_elastic(n, axis);
  for (const unsigned int n : {2U, 7U})
    for (const double multiple : {1.5, 3.})
      bend_plastic(n, multiple);
  bend_cantilever();
  press_pipe();
}

} // namespace probes_bending_test
