// SPDX-License-Identifier: LGPL-2.1-or-later
// The explicit kernels, with series, modes and convected history, give the forces and states of the implicit
// elements that have the same formulation, on the same motion.

#include "../sample_laws.h"
#include "explicit_blocks.h"

namespace explicit_and_implicit_test {

using namespace billet;
using namespace billet::testing;

ElementFormulation implicit_twin(const ExplicitFormulation &formulation) {
  ElementFormulation twin;
  twin.element = formulation.element;
  return twin;
}

ElementVectors gather(const Mesh &mesh, const std::size_t element, const NodalArray &v) {
  ElementVectors values;
  for (unsigned int k = 0; k < 24; ++k)
    values[k] = v[4 * mesh.elements[element][k / 3] + k % 3];
  return values;
}

/// Twelve elements that share nodes, along a path towards a random target of the given size, and back, in
/// steps of dt. With a rate factor that kernels have, they integrate the plastic work of nonlinear hardening
/// by the trapezoidal rule; then it is not compared, since these steps are large.
void test_law_path(const std::string &full_name, const ExplicitFormulation &chosen, const SharedLaw &law,
                   const double size, const double scatter, const double tolerance, const double dt = 1e-6,
                   const bool compares_work = true) {
  const bool is_plastic = law->has_plasticity();
  WorstError force_error, summary_error, energy_error;
  bool yields = false, has_hourglass = false;
  for (const auto instructions : {InstructionSet::scalar, InstructionSet::automatic}) {
    Random random;
    ExplicitFormulation formulation = chosen;
    formulation.instructions = instructions;
    Body body(make_mesh({3, 2, 2}, 0.2, random), law, formulation);
    const Mesh &mesh = body.mesh();
    const auto reference = billet::make_element_block(law, implicit_twin(formulation));
    std::vector<ElementVectors> X;
    for (std::size_t e = 0; e < mesh.elements.size(); ++e)
      X.push_back(gather(mesh, e, mesh.positions));
    std::size_t offender = 0;
    AssertThrow(reference->initialize(X, offender), dealii::ExcInternalError());
    PointStep step;
    step.dt = dt;

    const Tensor<2, 3> gradient = random.tensor(size);
    NodalArray direction(mesh.positions.size());
    for (std::size_t a = 0; a < mesh.n_nodes(); ++a) {
      Tensor<1, 3> u = gradient * mesh.node(mesh.positions, a);
      for (unsigned int i = 0; i < 3; ++i)
        u[i] += random(-scatter, scatter);
      set_node(direction, a, u);
    }
    for (const double t : {0., 0.02, 0.2, 0.5, 0.9, 1., 0.97, 0.5, 0.1}) {
      NodalArray u = direction, expected(u.size());
      for (double &component : u)
        component *= t;
      double scale = 5e-3 * law->elastic().shear; // forces of small strains
      for (std::size_t e = 0; e < X.size(); ++e) {
        ElementVectors force;
        AssertThrow(reference->evaluate(e, gather(mesh, e, u), force, nullptr, step),
                    dealii::ExcInternalError());
        for (unsigned int k = 0; k < 24; ++k) {
          expected[4 * mesh.elements[e][k / 3] + k % 3] += force[k];
          scale = std::max(scale, std::abs(force[k]));
        }
      }
      reference->commit();
      const NodalArray &forces = body.advance(u, dt);
      for (std::size_t k = 0; k < forces.size(); ++k)
        force_error.add(std::abs(forces[k] - expected[k]) / scale);
      if (body.result().inverted != X.size())
        force_error.add(NAN);
      double elastic = 0., hourglass = 0.;
      for (std::size_t e = 0; e < X.size(); ++e) {
        const ElementSummary a = reference->summarize(e, gather(mesh, e, u)), b = body.summarize(e);
        elastic += a.elastic_energy;
        hourglass += a.hourglass_energy;
        summary_error.add((a.cauchy_stress - b.cauchy_stress).norm() / scale);
        summary_error.add(std::abs(a.equivalent_plastic_strain - b.equivalent_plastic_strain));
        if (compares_work)
          summary_error.add(std::abs(a.plastic_work - b.plastic_work) / (scale + a.plastic_work));
        yields = yields || a.equivalent_plastic_strain > 0.01;
      }
      has_hourglass = has_hourglass || hourglass > 1e-6 * elastic;
      energy_error.add(std::abs(body.result().elastic_energy - elastic) / scale);
      energy_error.add(std::abs(body.result().hourglass_energy - hourglass) / scale);
    }
  }
  check(full_name + ", forces", force_error.value(), tolerance);
  check(full_name + ", summaries", summary_error.value(), tolerance);
  check(full_name + ", energies", energy_error.value(), tolerance);
  check(full_name + (is_plastic ? ", plastic strain" : ", no plastic strain"), yields == is_plastic);
  check(full_name + ", hourglass energy where there is one point",
        has_hourglass == (chosen.element == Formulation::Element::one_point));
}

void test_path(const std::string &name, const Formulation &chosen, const MaterialLaw &material,
               const double size, const double scatter, const double tolerance, const double dt = 1e-6,
               const bool compares_work = true) {
  test_law_path(name_of(chosen) + ", " + name, chosen, make_law(material, chosen.elasticity), size, scatter,
                tolerance, dt, compares_work);
}

/// Plastic work of a stretched element in many steps, against the points'.
void test_plastic_work(const std::string &name, const Formulation &formulation, const MaterialLaw &material,
                       const double tolerance) {
  constexpr double dt = 1e-6;
  constexpr unsigned int n_steps = 1000;
  const NodalTensor X = distorted_cube();
  Body body(make_mesh(X), material, formulation);
  const auto reference =
      make_block(make_law(material, formulation.elasticity), X, implicit_twin(formulation));
  PointStep step;
  step.dt = dt;
  double sum = 0., volume = 0.;
  ElementSummary exact;
  for (unsigned int k = 0; k <= n_steps; ++k) {
    Tensor<2, 3> F = unit;
    F[0][0] += 0.3 * k / n_steps;
    const NodalTensor u = displace(F, X);
    ElementVectors force;
    AssertThrow(reference->evaluate(0, to_array(u), force, nullptr, step), dealii::ExcInternalError());
    reference->commit();
    body.advance(u, k == 0 ? 0. : dt);
    sum += body.result().plastic_work;
    exact = reference->summarize(0, to_array(u));
  }
  std::vector<double> masses(8);
  body.block().add_masses(masses.data());
  for (const double mass : masses)
    volume += mass / density;
  const std::string full_name = name_of(formulation) + ", " + name;
  const double work = body.summarize().plastic_work;
  check(full_name + ", plastic work", std::abs(work / exact.plastic_work - 1.), tolerance);
  check(full_name + ", plastic work, step by step", std::abs(sum / work - 1.), 1e-12);
  const NodalArray last = [&] {
    NodalArray u(32);
    Tensor<2, 3> F = unit;
    F[0][0] += 0.3;
    for (unsigned int a = 0; a < 8; ++a)
      set_node(u, a, node(displace(F, X), a));
    return u;
  }();
  const std::vector<double> state = body.block().average_states(0, last.data()).at(0);
  check(full_name + ", plastic work as a state", std::abs(volume * state.back() / work - 1.), 1e-12);
}

/// Flow stresses that depend on the rate: in the kernels' own form, and lane by lane.
void test_rates(const Formulation &formulation) {
  const auto power = cowper_symonds(40., 5.);
  const auto logarithm = std::make_shared<const LogarithmicFactor>(2., 0.1);
  for (const double dt : {1e-7, 1e-3, 10.}) { // factors of the rate up to 10, 2.5 and 1.2
    const std::string end = ", steps of " + std::to_string(dt);
    const auto test = [&](const std::string &name, const SharedFlow &flow, const bool compares_work) {
      test_path(name + end, formulation, {steel, flow}, 0.3, 0.15, 1e-11, dt, compares_work);
    };
    test("linear hardening, rate", at_rate(linear, power), true);
    test("perfect plasticity, linear rate", at_rate(perfect, cowper_symonds(1e3, 1.)), true);
    test("linear hardening, steep rate", at_rate(linear, cowper_symonds(1e-3, 60.)), true);
    test("Voce hardening, rate", at_rate(voce, power), false);
    test("steep power law, rate", at_rate(steep_power_law, power), false);
    test("table, rate", at_rate(table, power), false);
    test("Voce hardening, logarithm of the rate", at_rate(voce, logarithm), true);
  }
  test_plastic_work("linear hardening, rate", formulation, {steel, at_rate(linear, power)}, 1e-11);
  test_plastic_work("Voce hardening, rate", formulation, {steel, at_rate(voce, power)}, 2e-6);
  test_plastic_work("power law, rate", formulation, {steel, at_rate(power_law, power)}, 2e-6);
  test_plastic_work("table, rate", formulation, {steel, at_rate(table, power)}, 2e-6);
  test_plastic_work("table, logarithm of the rate", formulation, {steel, at_rate(table, logarithm)}, 1e-11);
}

BILLET_TEST(explicit_and_implicit) {
  for (const auto element : all_elements())
    for (const auto &elasticity : metal_elasticities()) {
      const Formulation formulation = make_formulation(element, elasticity);
      const auto run_hardening = [&](const std::string &name, const auto &hardening) {
        test_path(name, formulation, {steel, hardening}, 0.3, 0.15, 1e-11);
      };
      for_each_hardening(run_hardening, /*with_ludwik=*/true);
      test_path("Voce softening", formulation, {steel, VoceHardening{450., 400., 16.93, 20.}}, 0.3, 0.15,
                1e-11);
      test_path("power law, convex", formulation, {steel, PowerLawHardening{565.3, 1., 1.5}}, 0.3, 0.15,
                1e-11);
      test_path("elastic, small strain", formulation, {steel, {}}, 0.002, 0.0005, 1e-12);
      test_path("elastic, moderate strain", formulation, {steel, {}}, 0.05, 0.02, 1e-12);
      test_path("elastic, large strain", formulation, {steel, {}}, 0.4, 0.15, 1e-11);
      test_path("plastic after large elastic strain", formulation,
                {steel, LinearHardening{0.3 * young, 0.1 * young}}, 0.4, 0.15, 1e-11);
      test_rates(formulation);
    }
  // Laws without kernels, computed element by element.
  for (const auto element : all_elements())
    for (const auto &[name, law] : rubber_laws()) {
      const Formulation formulation = make_formulation(element, name);
      test_law_path(name_of(formulation), formulation, law, 0.3, 0.15, 1e-11);
    }
}

} // namespace explicit_and_implicit_test
