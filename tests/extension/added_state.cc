// SPDX-License-Identifier: LGPL-2.1-or-later
// A law with a state that the library does not know: the largest strain of the past and the range of volumes.
// A cube is pulled and released; the fields are requested by name and read back from the files, in implicit
// and explicit scenes, against the closed form. A checkpoint is read by the names of the fields, and refused
// if they are others. The state that kernels do not store as the law has it: the plastic metric of tension.

#include "../scenes/restart_run.h"
#include "pulled_cube.h"
#include "read_field.h"

#include "billet/material/elastic.h"
#include "billet/material/elasticity.h"
#include "billet/material/law_adapter.h"
#include "billet/output/field_quantity.h"

namespace added_state_test {

using namespace billet;
using billet::testing::check;
using billet::testing::has;
using billet::testing::max_difference;
using billet::testing::read_field;
using billet::testing::refusal;

namespace {

/// How the law names and orders its fields.
enum class Naming { usual, turned, renamed, widened };
Naming naming = Naming::usual;

/// Hencky's law, with a memory that does not change the stress.
class RememberingElasticity {
public:
  struct History {
    double peak = 0.;                 ///< largest |ln λ| so far
    double lowest = 0., highest = 0.; ///< ln J so far
  };
  using Moduli = SpatialModuli;
  static constexpr bool has_plasticity = false, is_rate_form = false, has_symmetric_moduli = true,
                        has_exact_dissipation = true;

  explicit RememberingElasticity(const ElasticModuli &elastic) : naming_(naming), law_(elastic) {}

  bool update(const dealii::Tensor<2, 3> &F, const History &history_n, History &history,
              dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli, const PointStep &step = {}) const {
    history = history_n;
    for (const double square : dealii::eigenvalues(dealii::symmetrize(F * dealii::transpose(F))))
      history.peak = std::max(history.peak, std::abs(0.5 * std::log(square)));
    const double log_J = std::log(dealii::determinant(F));
    history.lowest = std::min(history.lowest, log_J);
    history.highest = std::max(history.highest, log_J);
    HenckyElasticity::History none;
    return law_.update(F, none, none, tau, moduli, step);
  }
  double elastic_energy(const dealii::Tensor<2, 3> &F, const History &) const {
    return law_.elastic_energy(F, {});
  }
  static History find_history(const dealii::Tensor<2, 3> &, const dealii::SymmetricTensor<2, 3> &, double) {
    return {};
  }

  std::vector<StateField> fields() const {
    const StateField peak{naming_ == Naming::renamed ? "greatest strain" : "peak strain", 1, {}},
        range{"range of ln J", naming_ == Naming::widened ? 3U : 2U, {"lowest", "highest"}};
    return naming_ == Naming::turned ? std::vector<StateField>{range, peak}
                                     : std::vector<StateField>{peak, range};
  }
  void store(const History &history, double *numbers) const {
    const bool is_turned = naming_ == Naming::turned;
    numbers[is_turned ? 2 : 0] = history.peak;
    numbers[is_turned ? 0 : 1] = history.lowest;
    numbers[is_turned ? 1 : 2] = history.highest;
    if (naming_ == Naming::widened)
      numbers[3] = 0.;
  }
  History restore(const double *numbers) const {
    const bool is_turned = naming_ == Naming::turned;
    return {numbers[is_turned ? 2 : 0], numbers[is_turned ? 0 : 1], numbers[is_turned ? 1 : 2]};
  }

  static double plastic_work(const History &) { return 0.; }
  static double equivalent_plastic_strain(const History &) { return 0.; }
  const ElasticModuli &elastic() const { return law_.elastic(); }
  double min_wave_stiffness(const Stretches &stretches) const { return law_.min_wave_stiffness(stretches); }

private:
  Naming naming_;
  HenckyElasticity law_;
};

SharedLaw make_law(const ElasticModuli &moduli, SharedFlow flow) {
  if (flow != nullptr)
    return nullptr;
  return std::make_shared<const LawAdapter<RememberingElasticity>>("remembering",
                                                                   RememberingElasticity(moduli));
}

constexpr double stretch = 1.05, explicit_duration = 5e-5;
const std::string remembering = "set Law = elastic\nset Elasticity = remembering\nset Young modulus = "
                                "200e3\nset Poisson ratio = 0.3";

/// The cube is back at the start at the end, twice `duration`.
parameters::Scene read_scene(const std::string &element, const bool is_explicit) {
  const double duration = is_explicit ? explicit_duration : 1.;
  auto scene = testing::read_pulled_cube(element, remembering, stretch, duration, is_explicit, 2);
  scene.time_stepping.end_time = 2. * duration;
  scene.output.format = parameters::Output::Format::hdf5;
  scene.output.state_fields = {{"peak strain", "range of ln J"}, "test"};
  return scene;
}

/// A cube of Hencky's law, which has no state.
parameters::Body plain_body(const parameters::Body &other) {
  parameters::Body body = other;
  body.name = "plain";
  body.material.law = make_hencky_law(other.material.law->elastic());
  return body;
}

template <class Run> void check_memory(const std::string &name, const Run &run, const double allowed) {
  const std::string file = testing::write_fields(run.scene, run.problem);
  // Hencky's law in uniaxial tension: ln J = (1 − 2 ν) ln λ.
  const double peak = std::log(stretch), highest = (1. - 2. * testing::cube_poisson) * peak;
  const auto first_body = [](std::vector<double> values) {
    values.resize(64);
    return values;
  };
  const auto peaks = read_field(file, "state_peak_strain", 0, run.scene.bodies().size());
  check(name + ", peak strain", max_difference(first_body(peaks), peak) / peak, allowed);
  check(name + ", largest volume",
        max_difference(first_body(read_field(file, "state_range_of_ln_J_highest")), highest) / highest,
        allowed);
  check(name + ", smallest volume",
        max_difference(first_body(read_field(file, "state_range_of_ln_J_lowest")), 0.) / highest, allowed);
  check(name + ", the strain itself is gone",
        max_difference(first_body(read_field(file, "stress_zz")), 0.) / (peak * testing::cube_young),
        allowed);
  if (run.scene.bodies().size() > 1) {
    check(name + ", elements of both bodies", peaks.size() == 128);
    check(name + ", 0 without the field",
          max_difference(std::vector<double>(peaks.begin() + 64, peaks.end()), 0.), 0.);
  }
}

void test_fields() {
  for (const std::string element : testing::all_element_names) {
    auto scene = read_scene(element, false);
    scene.bodies.push_back(plain_body(scene.bodies[0]));
    testing::SceneRun run(scene);
    run.finish();
    check_memory(element, run, 1e-6); // of HDF5 output in single precision

    testing::ExplicitRun moving(read_scene(element, true));
    moving.finish(2. * explicit_duration, [] {});
    check_memory(element + ", explicit", moving, 1e-2);
  }
}

void test_names() {
  auto scene = read_scene("assumed strain", false);
  scene.output.state_fields.value = {"damage"};
  const std::string unknown = refusal([&] { const Scene made(scene); });
  check("an unknown field is refused, with the names there are",
        has(unknown, "test names 'damage'") &&
            has(unknown, "allowed are those of the scene's materials: peak "
                         "strain, range of ln J"));
  scene.bodies[0] = plain_body(scene.bodies[0]);
  check("so is any field without a state",
        has(refusal([&] { const Scene made(scene); }), "the materials of this scene have no state"));

  scene = read_scene("assumed strain", false);
  scene.output.state_fields.value.clear();
  testing::SceneRun run(scene);
  const auto lists_state = [](const Scene &made, const Solution &solution) {
    testing::write_fields(made, solution);
    std::ifstream index("fields/fields.xdmf");
    const std::string text((std::istreambuf_iterator<char>(index)), {});
    return has(text, "state_");
  };
  check("fields that are not requested are not written", !lists_state(run.scene, run.problem));
  testing::SceneRun asking(read_scene("assumed strain", false));
  check("those that are requested are", lists_state(asking.scene, asking.problem));
}

/// Mean of a field over the elements of the first body.
double mean_of(const Solution &solution, const std::vector<StateField> &fields, const std::string &name) {
  double sum = 0.;
  const auto averages = solution.average_states(0);
  for (const StateAverages &average : averages)
    sum += StateAverage{fields, average[0]}.find(name).back();
  return sum / static_cast<double>(averages.size());
}

/// Resumes in the middle, under other names of the fields, from a checkpoint under the usual ones.
template <class Run> void test_restart(const std::string &scheme, const bool is_explicit) {
  const auto read = [&](const Naming how) {
    naming = how;
    return read_scene("mean dilatation", is_explicit);
  };
  const double middle = is_explicit ? explicit_duration : 1.;
  testing::History history;
  Run first(read(Naming::usual), MPI_COMM_WORLD);
  if constexpr (std::is_same_v<Run, testing::ExplicitStops>)
    first.run(middle, 100, history);
  else
    first.run(middle, history);
  first.save("middle.h5");
  const auto values = [](const Run &run) -> std::array<double, 2> {
    const auto fields = run.scene.bodies()[0].law->fields();
    return {mean_of(run.problem, fields, "peak strain"), mean_of(run.problem, fields, "range of ln J")};
  };
  const auto expected = values(first);
  check(scheme + ", there is something to remember", expected[0] > 0.04 && expected[1] > 0.015);
  for (const Naming how : {Naming::usual, Naming::turned}) {
    Run second(read(how), MPI_COMM_WORLD);
    second.load("middle.h5");
    check(scheme + (how == Naming::usual ? ", same names" : ", another order"), values(second) == expected);
  }
  for (const Naming how : {Naming::renamed, Naming::widened}) {
    auto scene = read(how);
    scene.output.state_fields.value.clear();
    Run second(scene, MPI_COMM_WORLD);
    const std::string why = refusal([&] { second.load("middle.h5"); });
    check(scheme + (how == Naming::renamed ? ", a renamed field is refused" : ", a wider field is refused"),
          has(why, "the law 'remembering' of its body 'cube' has the fields 'peak strain' (1), 'range of ln "
                   "J' (2), but here it has ") &&
              has(why, how == Naming::renamed ? "'greatest strain' (1), 'range of ln J' (2)"
                                              : "'peak strain' (1), 'range of ln J' (3)"));
  }
  naming = Naming::usual;
}

/// Uniaxial flow is isochoric: C_p⁻¹ = diag(exp α, exp α, exp −2α).
template <class Run> void check_metric(const std::string &name, const Run &run, const double allowed) {
  const std::string file = testing::write_fields(run.scene, run.problem),
                    metric = "state_inverse_plastic_metric_";
  const auto alphas = read_field(file, "equivalent_plastic_strain");
  std::vector<double> across, along;
  for (const double alpha : alphas) {
    across.push_back(std::exp(alpha));
    along.push_back(std::exp(-2. * alpha));
  }
  check(name + ", there is flow", *std::min_element(alphas.begin(), alphas.end()) > 0.2);
  check(name + ", along", max_difference(read_field(file, metric + "zz"), along), allowed);
  check(name + ", across", max_difference(read_field(file, metric + "xx"), across), allowed);
  check(name + ", shear", max_difference(read_field(file, metric + "yz"), 0.), allowed);
}

void test_plastic_metric() {
  for (const std::string element : testing::all_element_names)
    for (const std::string elasticity : {"Hencky", "neo-Hookean"})
      for (const bool is_explicit : {false, true}) {
        auto scene = testing::read_pulled_cube(
            element,
            "set Young modulus = 200e3\nset Poisson ratio = 0.3\nset Yield stress = 300\nset Hardening "
            "modulus = 500\nset Elasticity = " +
                elasticity,
            1.3, is_explicit ? explicit_duration : 1., is_explicit, 20);
        scene.output.format = parameters::Output::Format::hdf5;
        scene.output.state_fields = {{"inverse plastic metric"}, "test"};
        const std::string name = element + ", " + elasticity;
        if (is_explicit) {
          testing::ExplicitRun run(scene);
          run.finish(explicit_duration, [] {});
          check_metric(name + ", explicit", run, 5e-3);
        } else {
          testing::SceneRun run(scene);
          run.finish();
          check_metric(name, run, elasticity == "Hencky" ? 1e-6 : 5e-3);
        }
      }
}

} // namespace

BILLET_MPI_TEST(added_state) {
  elasticity_types().add(isotropic_elasticity_type("remembering", "Hencky's, with a memory", &make_law));
  test_fields();
  test_names();
  test_restart<testing::ImplicitSolutionRun>("static", false);
  test_restart<testing::ExplicitStops>("explicit", true);
  test_plastic_metric();
}

} // namespace added_state_test
