// SPDX-License-Identifier: LGPL-2.1-or-later
// Flow rules in scenes: backstress, Hill's anisotropy, thermal softening with adiabatic heating, and all of
// them with a rate factor. A cube is pulled and pushed with every element, statically, in implicit dynamics
// and explicitly; energies are those of a point under uniaxial stress. States go to the files and survive a
// restart bit by bit. Parameters that make no sense are refused.

#include "restart_run.h"

#include "../extension/pulled_cube.h"
#include "../extension/read_field.h"

namespace flow_rules_test {

using namespace billet;
using billet::testing::check;
using billet::testing::has;
using billet::testing::refusal;

namespace {

constexpr double stretch = 1.1, quick = 1.5e-5;

const std::string elastic = "set Young modulus = 200e3\nset Poisson ratio = 0.3\n",
                  hardening =
                      "set Hardening = Voce\nset Yield stress = 300\nset Saturation stress = 400\nset "
                      "Saturation rate = 20\nset Hardening modulus = 100\n",
                  backstress = "set Backstress moduli = 20000, 2000\nset Backstress rates = 200, 0\n",
                  anisotropy =
                      "set Anisotropy = Hill\nset r-values = 1.79, 1.51, 2.27\nset Axes = local\nset "
                      "First axis = 0, 1, 0\nset Second axis = 0, 0, 1\n",
                  thermal =
                      "set Thermal factor = Johnson-Cook\nset Melting temperature = 1793\nset "
                      "Taylor-Quinney fraction = 0.9\nset Specific heat = 477e6\nset Temperature = 400\n",
                  rate =
                      "set Rate factor = Cowper-Symonds\nset Reference rate = 400\nset Rate exponent = 5\n";

const std::vector<std::pair<std::string, std::string>> materials = {
    {"backstress", elastic + hardening + backstress},
    {"anisotropy", elastic + hardening + anisotropy},
    {"thermal", elastic + hardening + thermal},
    {"all", elastic + hardening + backstress + anisotropy + thermal + rate}};

struct Outcome {
  double elastic = 0., plastic = 0.;
  std::vector<double> state;
};

/// A point under uniaxial stress along z, whose strain goes as the cube's.
Outcome follow_point(const PointLaw &some, const double duration, const unsigned int n,
                     const double temperature) {
  const auto &law = dynamic_cast<const SpatialLaw &>(some);
  std::vector<double> state_n(law.n_state()), state(law.n_state());
  law.initialize(state_n.data());
  std::array<double, 2> lateral{};
  dealii::Tensor<2, 3> F;
  for (unsigned int i = 1; i <= n; ++i) {
    PointStep step;
    step.dt = duration / n;
    step.temperature = temperature;
    F[2][2] = 1. + 0.5 * (stretch - 1.) * (1. - std::cos(dealii::numbers::PI * i / n));
    const auto respond = [&](const std::array<double, 2> &at) -> std::array<double, 2> {
      F[0][0] = std::exp(at[0]);
      F[1][1] = std::exp(at[1]);
      dealii::SymmetricTensor<2, 3> tau;
      if (!law.update(F, dealii::determinant(F), step, state_n.data(), state.data(), tau, nullptr))
        throw SolutionFailure("the point fails");
      return {tau[0][0], tau[1][1]};
    };
    for (unsigned int iteration = 0; iteration < 30; ++iteration) {
      constexpr double small = 1e-6;
      const auto residual = respond(lateral);
      if (std::abs(residual[0]) + std::abs(residual[1]) < 1e-8)
        break;
      std::array<std::array<double, 2>, 2> slopes{}; // [column][row]
      for (unsigned int k = 0; k < 2; ++k) {
        auto high = lateral, low = lateral;
        high[k] += small;
        low[k] -= small;
        const auto up = respond(high), down = respond(low);
        for (unsigned int j = 0; j < 2; ++j)
          slopes[k][j] = (up[j] - down[j]) / (2. * small);
      }
      const double det = slopes[0][0] * slopes[1][1] - slopes[0][1] * slopes[1][0];
      lateral[0] -= (slopes[1][1] * residual[0] - slopes[1][0] * residual[1]) / det;
      lateral[1] -= (slopes[0][0] * residual[1] - slopes[0][1] * residual[0]) / det;
    }
    respond(lateral);
    state_n = state;
  }
  return {law.stored_energy(F, dealii::determinant(F), state_n.data()), law.dissipated_energy(state_n.data()),
          state_n};
}

/// The largest difference of the states of all elements from those of the point, over the largest number.
double compare_states(const Solution &solution, const std::vector<double> &state) {
  double error = 0., size = 0.;
  for (const auto &averages : solution.average_states(0))
    for (std::size_t k = 0; k < state.size(); ++k) {
      // Metrics are numbers of order 1, stresses and energies of order 100.
      error = std::max(error, std::abs(averages[0][k] - state[k]));
      size = std::max(size, std::abs(state[k]));
    }
  return error / size;
}

void test_static(const std::string &element, const std::string &name, const std::string &material) {
  constexpr unsigned int n = 8;
  testing::SceneRun run(testing::read_pulled_cube(element, material, stretch, 1., false, n));
  run.finish();
  const Outcome exact = follow_point(*run.scene.bodies()[0].law, 1., n, 400.);
  const std::string what = element + ", " + name;
  check(what + ", stored energy", std::abs(run.problem.state().energies.elastic / exact.elastic - 1.), 1e-7);
  check(what + ", dissipation", std::abs(run.problem.state().energies.plastic / exact.plastic - 1.), 1e-7);
  check(what + ", states", compare_states(run.problem, exact.state), 1e-7);
  check(what + ", iterations", static_cast<double>(run.n_iterations) / n, 8.);
  check(what + ", balance",
        std::abs(run.problem.state().energies.drift()) / run.problem.state().energies.plastic, 0.1);
}

void test_explicit(const std::string &element, const std::string &name, const std::string &material) {
  const auto scene = testing::read_pulled_cube(element, material, stretch, quick, true, 0);
  testing::ExplicitRun run(scene);
  run.finish(quick, [] {});
  const Outcome exact = follow_point(*run.scene.bodies()[0].law, quick, 200, 400.);
  const std::string what = element + ", " + name + ", explicit";
  check(what + ", dissipation", std::abs(run.state().energies.plastic / exact.plastic - 1.), 1e-2);
  check(what + ", balance", std::abs(run.state().energies.drift()) / exact.plastic, 1e-3);
}

void test_dynamics(const std::string &name, const std::string &material) {
  testing::read_pulled_cube("assumed strain", material, stretch, quick, false, 40);
  std::ifstream from("static.prm");
  std::string text((std::istreambuf_iterator<char>(from)), {});
  text.replace(text.find("quasi-static"), std::string("quasi-static").size(), "implicit dynamics");
  std::ofstream("dynamics.prm") << text;
  testing::SceneRun run(parameters::Scene::read("dynamics.prm"));
  run.finish();
  const Outcome exact = follow_point(*run.scene.bodies()[0].law, quick, 200, 400.);
  check("implicit dynamics, " + name + ", dissipation",
        std::abs(run.problem.state().energies.plastic / exact.plastic - 1.), 2e-2);
}

/// Stops in the middle and goes on; all numbers are those of one run.
template <class Run> void test_restart(const std::string &name, const bool is_explicit) {
  const double end = is_explicit ? quick : 1.;
  const auto go = [](Run &some, const double until, testing::History &history) {
    if constexpr (std::is_same_v<Run, testing::ExplicitStops>)
      some.run(until, 10, history);
    else
      some.run(until, history);
  };
  for (const auto &[label, material] : materials) {
    const auto scene = testing::read_pulled_cube("one point", material, stretch, end, is_explicit, 8);
    testing::History before, whole, rest;
    Run first(scene, MPI_COMM_WORLD);
    go(first, 0.5 * end, before);
    first.save("middle.h5");
    go(first, end, whole);
    Run second(scene, MPI_COMM_WORLD);
    second.load("middle.h5");
    go(second, end, rest);
    check(name + ", " + label + ", a resumed run", testing::are_same_bits(whole, rest));
  }
}

/// The backstress of tension is that of the closed form, in the files.
void test_output() {
  auto scene = testing::read_pulled_cube("one point", elastic + "set Yield stress = 300\n" + backstress,
                                         stretch, 1., false, 8);
  scene.output.format = parameters::Output::Format::hdf5;
  scene.output.state_fields = {{"backstress"}, "test"};
  testing::SceneRun run(scene);
  run.finish();
  const std::string file = testing::write_fields(run.scene, run.problem);
  const double alpha = testing::read_field(file, "equivalent_plastic_strain")[0],
               exact = -100. * std::expm1(-200. * alpha) + 2000. * alpha;
  check("backstress in the files, along",
        testing::max_difference(testing::read_field(file, "state_backstress_zz"), 2. / 3. * exact) / exact,
        1e-5);
  check("backstress in the files, across",
        testing::max_difference(testing::read_field(file, "state_backstress_xx"), -exact / 3.) / exact, 1e-5);
}

void test_refusals() {
  const auto refuse = [](const std::string &material) {
    return refusal(
        [&] { testing::read_pulled_cube("one point", elastic + material, stretch, 1., false, 8); });
  };
  const std::string yield = "set Yield stress = 300\n";
  const std::vector<std::array<std::string, 3>> cases = {
      {"an elasticity without backstress", yield + "set Elasticity = neo-Hookean\n" + backstress,
       "choose 'Elasticity = Hencky'"},
      {"an elasticity without anisotropy", yield + "set Elasticity = hypoelastic\n" + anisotropy,
       "choose 'Elasticity = Hencky'"},
      {"an elasticity without thermal factors", yield + "set Elasticity = neo-Hookean\n" + thermal,
       "choose 'Elasticity = Hencky'"},
      {"an elastic law", "set Law = elastic\n" + backstress, "the law is elastic"},
      {"an elastic law with anisotropy", "set Law = elastic\n" + anisotropy, "the law is elastic"},
      {"rates without moduli", yield + "set Backstress rates = 3\n", "as many numbers"},
      {"fewer rates than moduli", yield + "set Backstress moduli = 3, 4\nset Backstress rates = 3\n",
       "as many numbers"},
      {"negative moduli", yield + "set Backstress moduli = -3\n", "numbers >= 0"},
      {"negative rates", yield + "set Backstress moduli = 3\nset Backstress rates = -3\n", "numbers >= 0"},
      {"nine terms", yield + "set Backstress moduli = 1, 1, 1, 1, 1, 1, 1, 1, 1\n", "at most 8"},
      {"two r-values", yield + "set Anisotropy = Hill\nset r-values = 1, 1\n", "three numbers"},
      {"no ratios", yield + "set Anisotropy = Hill\n", "three numbers"},
      {"both kinds of ratios",
       yield + "set Anisotropy = Hill\nset r-values = 1, 1, 1\nset Stress ratios = 1, 1, 1, 1, 1, 1\n",
       "one of them"},
      {"an open yield surface", yield + "set Anisotropy = Hill\nset Stress ratios = 0.4, 1, 1, 1, 1, 1\n",
       "closed"},
      {"cylindrical axes without a line",
       yield + "set Anisotropy = Hill\nset r-values = 1, 1, 1\nset Axes = cylindrical\n", "along the line"},
      {"r-values of no anisotropy", yield + "set r-values = 1, 1, 1\n", "does not use it"},
      {"no melting temperature", yield + "set Thermal factor = Johnson-Cook\nset Temperature = 20\n",
       "above 'Reference temperature'"},
      {"no temperature", yield + "set Thermal factor = Johnson-Cook\nset Melting temperature = 1000\n",
       "depends on it"},
      {"heat without a factor", yield + "set Taylor-Quinney fraction = 0.9\n", "does not use it"},
      {"no specific heat",
       yield + "set Thermal factor = table\nset Thermal table = 0 : 1\nset Temperature = 20\nset "
               "Taylor-Quinney fraction = 0.9\n",
       "a number > 0"}};
  for (const auto &[name, material, reason] : cases) {
    const std::string message = refuse(material);
    check("refuses " + name, has(message, reason));
    if (!has(message, reason))
      std::cout << message << std::endl;
  }
}

} // namespace

BILLET_MPI_TEST(flow_rules) {
  for (const std::string element : testing::all_element_names)
    for (const auto &[name, material] : materials) {
      test_static(element, name, material);
      if (element == "one point" || name == "all")
        test_explicit(element, name, material);
    }
  test_dynamics(materials.back().first, materials.back().second); // of all rules
  test_restart<testing::ImplicitSolutionRun>("static", false);
  test_restart<testing::ExplicitStops>("explicit", true);
  test_output();
  test_refusals();
}

} // namespace flow_rules_test
