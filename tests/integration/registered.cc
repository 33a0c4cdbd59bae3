// SPDX-License-Identifier: LGPL-2.1-or-later
// A time integrator that is registered from outside the library: scenes name it, set its parameter, are
// refused those of others, and run with it.
#include "billet/errors.h"
#include "billet/integration/time_integrator_type.h"
#include "billet/parameters/scene.h"

#include "../scenes/scene_run.h"

#include <fstream>
#include <sstream>

namespace registered_test {

using namespace billet;
using billet::testing::check;

namespace {

/// Wood, Bossak & Zienkiewicz (1981): the weights of inertia alone.
TimeIntegratorType bossak_type() {
  return {"Bossak",
          "Wood, Bossak & Zienkiewicz (1981)",
          {{"Inertia weight", "-0.1", TypeParameter::Kind::number, "From -1/3 to 0."}},
          [](const TypeInput &input) {
            const double alpha = input.number("Inertia weight");
            if (!(alpha >= -1. / 3. && alpha <= 0.))
              input.reject("Inertia weight", "a number from -1/3 to 0");
            return TimeIntegrator(alpha, 0., 0.25 * (1. - alpha) * (1. - alpha), 0.5 - alpha);
          }};
}

/// The scene of tests/cli with these lines in place of its method.
parameters::Scene read_with(const std::string &lines) {
  std::ifstream file(std::string(SOURCE_DIR) + "/../cli/drop.prm");
  std::ostringstream all;
  all << file.rdbuf();
  std::string text = all.str();
  const std::size_t first = text.find("  set Method "), end = text.find("end", first);
  text.replace(first, end - first, lines);
  std::ofstream("scene.prm") << text;
  return parameters::Scene::read("scene.prm");
}

std::string refusal(const std::string &lines) {
  try {
    read_with(lines);
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

/// State of the scene after some steps of equal length.
EnergyLedger run_with(const std::string &lines) {
  parameters::Scene scene = read_with(lines);
  scene.time_stepping.control = parameters::TimeStepping::Control::fixed;
  scene.time_stepping.end_time = 2e-4;
  scene.implicit_dynamics.error_tolerance = 0.;
  testing::SceneRun run(scene);
  run.finish();
  return run.problem.state().energies;
}

void test_run() {
  const EnergyLedger newmark = run_with("  set Method = Newmark\n"),
                     same = run_with("  set Method = Bossak\n  set Inertia weight = 0\n"),
                     damped = run_with("  set Method = Bossak\n  set Inertia weight = -0.2\n");
  check("without weights it is the trapezoidal rule", same.kinetic == newmark.kinetic);
  check("with weights it is another, close to it",
        damped.kinetic != newmark.kinetic && std::abs(damped.kinetic / newmark.kinetic - 1.) < 0.05);
  check("the trapezoidal rule dissipates nothing, this one does",
        std::abs(newmark.numerical) < 1e-6 * newmark.external && damped.numerical > 0.01 * damped.external);
}

} // namespace

BILLET_MPI_TEST(registered) {
  time_integrator_types().add(bossak_type());
  const TimeIntegrator integrator =
      read_with("  set Method = Bossak\n  set Inertia weight = -0.2\n").implicit_dynamics.integrator;
  check("weights of the one that the scene names",
        integrator.alpha_m() == -0.2 && integrator.alpha_f() == 0. && integrator.gamma() == 0.7);
  check("its default", read_with("  set Method = Bossak\n").implicit_dynamics.integrator.alpha_m() == -0.1);
  check("its range", refusal("  set Method = Bossak\n  set Inertia weight = 1\n").find("from -1/3 to 0") !=
                         std::string::npos);
  check("parameters of others",
        refusal("  set Method = Bossak\n  set Alpha = -0.1\n").find("'Method = Bossak' does not use it") !=
            std::string::npos);
  bool is_refused = false;
  try {
    time_integrator_types().add(bossak_type());
  } catch (const std::logic_error &) {
    is_refused = true;
  }
  check("a name that is taken", is_refused);
  test_run();
}

} // namespace registered_test
