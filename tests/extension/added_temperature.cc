// SPDX-License-Identifier: LGPL-2.1-or-later
// A law that depends on temperature, which the library does not know: Hencky's, with thermal expansion. A
// cube is held along one axis while it is heated, and pulled as fast as it expands; both have closed forms.
// Its energy is that of the stresses, with every element, in implicit and explicit scenes, and a run resumes
// exactly at the temperature of its time.

#include "../scenes/restart_run.h"
#include "pulled_cube.h"

#include "billet/material/elastic.h"
#include "billet/material/elasticity.h"
#include "billet/material/law_adapter.h"

namespace added_temperature_test {

using namespace billet;
using billet::testing::check;
using billet::testing::has;
using billet::testing::refusal;

namespace {

constexpr double expansion = 1e-4, warmest = 400.; // 1/K, K: ln θ = α T = 0.04
constexpr double explicit_duration = 5e-5;

/// W = W_Hencky(F/θ) per undeformed volume, ln θ = α T.
class ExpandingElasticity {
public:
  struct History {
    double log_theta = 0.;
    double trace = 0.; ///< of the stress [stress]
    double heat = 0.;  ///< energy that heat has brought per undeformed volume, −∫ tr τ d ln θ [stress]
  };
  using Moduli = SpatialModuli;
  static constexpr bool has_plasticity = false, is_rate_form = false, has_symmetric_moduli = true,
                        has_exact_dissipation = true, depends_on_temperature = true;

  explicit ExpandingElasticity(const ElasticModuli &elastic) : law_(elastic) {}

  bool update(const dealii::Tensor<2, 3> &F, const History &history_n, History &history,
              dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli, const PointStep &step = {}) const {
    const HenckyElasticity::History before;
    HenckyElasticity::History after;
    history.log_theta = expansion * step.temperature;
    if (!law_.update(F / std::exp(history.log_theta), before, after, tau, moduli, step))
      return false;
    history.trace = dealii::trace(tau);
    history.heat =
        history_n.heat - 0.5 * (history_n.trace + history.trace) * (history.log_theta - history_n.log_theta);
    return true;
  }
  double elastic_energy(const dealii::Tensor<2, 3> &F, const History &history) const {
    return law_.elastic_energy(F / std::exp(history.log_theta), {});
  }
  static double plastic_work(const History &history) { return -history.heat; }
  static double equivalent_plastic_strain(const History &) { return 0.; }
  static History find_history(const dealii::Tensor<2, 3> &, const dealii::SymmetricTensor<2, 3> &, double) {
    return {};
  }
  std::vector<StateField> fields() const { return {{"ln theta", 1}, {"mean stress", 1}, {"heat", 1}}; }
  void store(const History &history, double *numbers) const {
    numbers[0] = history.log_theta;
    numbers[1] = history.trace / 3.;
    numbers[2] = history.heat;
  }
  History restore(const double *numbers) const { return {numbers[0], 3. * numbers[1], numbers[2]}; }
  const ElasticModuli &elastic() const { return law_.elastic(); }
  double min_wave_stiffness(const Stretches &stretches) const { return law_.min_wave_stiffness(stretches); }

private:
  HenckyElasticity law_;
};

SharedLaw make_law(const ElasticModuli &moduli, SharedFlow flow) {
  if (flow != nullptr)
    return nullptr;
  return std::make_shared<const LawAdapter<ExpandingElasticity>>("expanding", ExpandingElasticity(moduli));
}

std::string duration_of(const bool is_explicit) { return is_explicit ? "5e-5" : "1"; }

parameters::Scene read_scene(const std::string &element, const std::string &temperature, const double stretch,
                             const bool is_explicit, const std::string &law = "expanding") {
  const std::string value = temperature.empty() ? "" : "\nset Temperature = " + temperature;
  return testing::read_pulled_cube(element,
                                   "set Law = elastic\nset Elasticity = " + law +
                                       "\nset Young modulus = 200e3\nset Poisson ratio = 0.3" + value,
                                   stretch, is_explicit ? explicit_duration : 1., is_explicit, 10);
}

/// Rises smoothly to `warmest`.
std::string heating(const bool is_explicit) {
  return std::to_string(warmest) + "*(1 - cos(pi*t/" + duration_of(is_explicit) + "))/2";
}

struct Outcome {
  EnergyLedger energies;
  double axial_stress;
};

Outcome run(const parameters::Scene &scene, const bool is_explicit) {
  const auto mean_stress = [](const Solution &solution) {
    double sum = 0.;
    const auto summaries = solution.summarize(0);
    for (const ElementSummary &summary : summaries)
      sum += summary.cauchy_stress[2][2];
    return sum / static_cast<double>(summaries.size());
  };
  if (is_explicit) {
    testing::ExplicitRun moving(scene);
    moving.finish(explicit_duration, [] {});
    return {moving.state().energies, mean_stress(moving.problem)};
  }
  testing::SceneRun still(scene);
  still.finish();
  return {still.problem.state().energies, mean_stress(still.problem)};
}

/// Held at its height: ln λ_z = 0, and sideways ln λ = (1 + ν) ln θ, so that τ_z = −E ln θ and
/// J = exp(2 (1 + ν) ln θ). Nothing does work on it but heat.
void test_held(const std::string &element, const bool is_explicit, const double allowed) {
  const std::string name = element + (is_explicit ? ", explicit" : "") + ", held";
  const Outcome outcome = run(read_scene(element, heating(is_explicit), 1., is_explicit), is_explicit);
  const double log_theta = expansion * warmest, E = testing::cube_young,
               stress = -E * log_theta / std::exp(2. * (1. + testing::cube_poisson) * log_theta),
               energy = 0.5 * E * log_theta * log_theta;
  check(name + ", stress", std::abs(outcome.axial_stress / stress - 1.), allowed);
  check(name + ", stored energy", std::abs(outcome.energies.elastic / energy - 1.), allowed);
  check(name + ", heat brings it", std::abs(outcome.energies.plastic / energy + 1.), allowed);
  check(name + ", energies balance", std::abs(outcome.energies.drift()) / energy, is_explicit ? 1e-3 : 1e-10);
}

/// Pulled as fast as it expands: there is no stress.
void test_followed(const std::string &element, const bool is_explicit) {
  const double stretch = std::exp(expansion * warmest);
  const std::string rise = std::to_string(1. / expansion) + "*log(1 + " + "(exp(" +
                           std::to_string(expansion * warmest) + ") - 1)*(1 - cos(pi*t/" +
                           duration_of(is_explicit) + "))/2)";
  const Outcome outcome = run(read_scene(element, rise, stretch, is_explicit), is_explicit);
  const double stress = testing::cube_young * expansion * warmest;
  check(element + (is_explicit ? ", explicit" : "") + ", pulled as it expands",
        std::abs(outcome.axial_stress) / stress, is_explicit ? 1e-3 : 1e-6);
}

void test_refusals() {
  check("a law that depends on temperature asks for it",
        has(refusal([] { read_scene("one point", "", 1., false); }), "depends on it"));
  check("a law that does not refuses it",
        has(refusal([] { read_scene("one point", "20", 1., false, "Hencky"); }), "does not depend on it"));
  bool is_named = false;
  try {
    testing::SceneRun run(read_scene("one point", "1/(t - 0.5)", 1., false));
    run.finish();
  } catch (const SolutionFailure &failure) {
    is_named = has(failure.what(), "Temperature");
  }
  check("a message names a temperature that is not finite", is_named);
}

/// Stops in the middle and goes on; all numbers are those of one run.
template <class Run> void test_restart(const std::string &name, const bool is_explicit) {
  const double end = is_explicit ? explicit_duration : 1.;
  const auto go = [](Run &some, const double until, testing::History &history) {
    if constexpr (std::is_same_v<Run, testing::ExplicitStops>)
      some.run(until, 10, history);
    else
      some.run(until, history);
  };
  const auto scene = read_scene("assumed strain", heating(is_explicit), 1., is_explicit);
  testing::History before, whole, rest;
  Run first(scene, MPI_COMM_WORLD);
  go(first, 0.5 * end, before);
  first.save("middle.h5");
  go(first, end, whole);
  Run second(scene, MPI_COMM_WORLD);
  second.load("middle.h5");
  go(second, end, rest);
  check(name + ", a resumed run", testing::are_same_bits(whole, rest));
}

} // namespace

BILLET_MPI_TEST(added_temperature) {
  elasticity_types().add(
      isotropic_elasticity_type("expanding", "Hencky's, with thermal expansion", &make_law));
  for (const std::string element : testing::all_element_names) {
    test_held(element, false, 1e-8);
    test_held(element, true, 1e-2);
    test_followed(element, false);
    test_followed(element, true);
  }
  test_refusals();
  test_restart<testing::ImplicitSolutionRun>("static", false);
  test_restart<testing::ExplicitStops>("explicit", true);
}

} // namespace added_temperature_test
