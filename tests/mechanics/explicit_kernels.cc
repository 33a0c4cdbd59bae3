// SPDX-License-Identifier: LGPL-2.1-or-later
// What all kernels have in common: every instruction set gives the same numbers, whatever number of elements
// the last batch has; masses; what is refused.

#include "billet/without_traps.h"

#include "explicit_blocks.h"

#include <limits>
#include <stdexcept>

namespace explicit_kernels_test {

using namespace billet;
using namespace billet::testing;

/// Forces, results and summaries after three steps, the last large.
struct Answer {
  NodalArray forces;
  std::vector<double> numbers;
};

Answer run(const Mesh &mesh, const MaterialLaw &material, const Formulation &formulation) {
  Random random;
  Body body(mesh, material, formulation);
  NodalArray u(mesh.positions.size());
  Answer answer;
  for (const double size : {0.001, 0.02, 0.1}) {
    const Tensor<2, 3> gradient = random.tensor(size);
    for (std::size_t a = 0; a < mesh.n_nodes(); ++a) {
      const Tensor<1, 3> change = gradient * mesh.node(mesh.positions, a);
      for (unsigned int i = 0; i < 3; ++i)
        u[4 * a + i] += change[i] + random(-size, size);
    }
    answer.forces = body.advance(u, 1e-4);
    const auto &result = body.result();
    // Of energies, parts of the largest: plastic strain that has just begun is a difference of stresses.
    const double energies[] = {result.elastic_energy, result.plastic_work, result.viscous_work,
                               result.hourglass_energy};
    const double maximum = *std::max_element(std::begin(energies), std::end(energies));
    for (const double energy : energies)
      answer.numbers.push_back(1. + energy / maximum);
    answer.numbers.insert(answer.numbers.end(),
                          {maximum, 1e3 * result.stable_step, static_cast<double>(result.inverted)});
  }
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const ElementSummary summary = body.summarize(e);
    answer.numbers.insert(answer.numbers.end(),
                          {summary.cauchy_stress.norm(), 100. * summary.equivalent_plastic_strain,
                           summary.elastic_energy, summary.plastic_work});
  }
  return answer;
}

void test_instruction_sets(Formulation formulation, const std::string &law, const MaterialLaw &material) {
  formulation.linear_viscosity = 0.06;
  formulation.quadratic_viscosity = 1.2;
  WorstError error;
  for (const std::array<unsigned int, 3> size :
       {std::array<unsigned int, 3>{1, 1, 1}, {3, 3, 2}, {7, 1, 1}, {4, 2, 2}}) {
    Random random;
    const Mesh mesh = make_mesh(size, 0.2, random);
    formulation.instructions = InstructionSet::scalar;
    const Answer expected = run(mesh, material, formulation);
    double scale = 0.;
    for (const double f : expected.forces)
      scale = std::max(scale, std::abs(f));
    for (const auto instructions :
         {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512, InstructionSet::automatic}) {
      if (!is_available(instructions))
        continue;
      formulation.instructions = instructions;
      const Answer answer = run(mesh, material, formulation);
      for (std::size_t k = 0; k < answer.forces.size(); ++k)
        error.add(std::abs(answer.forces[k] - expected.forces[k]) / scale);
      for (std::size_t k = 0; k < answer.numbers.size(); ++k)
        error.add(std::abs(answer.numbers[k] - expected.numbers[k]) / (std::abs(expected.numbers[k]) + 1e-3));
    }
  }
  check(name_of(formulation) + ", " + law + ", every instruction set", error.value(), 1e-12);
}

/// A brick of eight distorted elements between plane faces.
void test_masses(const Formulation &formulation) {
  Random random;
  Body body(make_mesh({2, 3, 2}, 0.3, random), {steel, {}}, formulation);
  std::vector<double> masses(body.mesh().n_nodes(), 0.);
  body.block().add_masses(masses.data());
  double sum = 0., minimum = 1e300;
  for (const double mass : masses) {
    sum += mass;
    minimum = std::min(minimum, mass);
  }
  check(name_of(formulation) + ", masses sum up", std::abs(sum / (12. * density) - 1.), 1e-13);
  check(name_of(formulation) + ", masses are positive", minimum > 0.);
}

void test_inverted(const Formulation &formulation) {
  const WithoutTraps quiet;
  Random random;
  const Mesh mesh = make_mesh({13, 1, 1}, 0., random);
  const auto find = [&](const std::size_t element, const Tensor<1, 3> &move) {
    Body body(mesh, {steel, linear}, formulation);
    NodalArray u(mesh.positions.size());
    for (unsigned int a = 0; a < 8; ++a) // pushed through the nodes before it
      if ((a & 1) != 0)
        set_node(u, mesh.elements[element][a], move);
    body.advance(u, 0.);
    return body.result().inverted;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinite = std::numeric_limits<double>::infinity();
  check(name_of(formulation) + ", all is well",
        find(4, Tensor<1, 3>({-0.1, 0., 0.})) == mesh.elements.size());
  check(name_of(formulation) + ", inverted", find(4, Tensor<1, 3>({-1.5, 0., 0.})) == 4);
  check(name_of(formulation) + ", inverted in the last batch", find(12, Tensor<1, 3>({-1.5, 0., 0.})) == 12);
  check(name_of(formulation) + ", not a number", find(4, Tensor<1, 3>({nan, 0., 0.})) == 4);
  check(name_of(formulation) + ", infinite", find(4, Tensor<1, 3>({infinite, 0., 0.})) == 4);
}

void test_initialize(const Formulation &formulation) {
  Random random;
  Mesh mesh = make_mesh({4, 1, 1}, 0., random);
  const auto block = make_explicit_block({steel, linear}, density, formulation);
  std::size_t offender = 99;
  std::swap(mesh.elements[2][0], mesh.elements[2][1]);
  check(name_of(formulation) + ", degenerate reference element",
        !block->initialize(mesh.elements, mesh.positions.data(), offender) && offender == 2);
  std::swap(mesh.elements[2][0], mesh.elements[2][1]);
  check(name_of(formulation) + ", initialized again",
        block->initialize(mesh.elements, mesh.positions.data(), offender) && block->size() == 4);
  check(name_of(formulation) + ", no elements",
        block->initialize({}, nullptr, offender) && block->size() == 0);
}

void test_refused() {
  const auto is_refused = [](const double bulk, const double rho, const Formulation &formulation) {
    try {
      make_explicit_block({{bulk, 1.}, {}}, rho, formulation);
      return false;
    } catch (const std::invalid_argument &) {
      return true;
    }
  };
  Formulation good, bad_linear, bad_quadratic;
  bad_linear.linear_viscosity = -1.;
  bad_quadratic.quadratic_viscosity = -1.;
  check("good numbers are accepted", !is_refused(1., 1., good));
  check("density zero is refused", is_refused(1., 0., good));
  check("bulk modulus zero is refused", is_refused(0., 1., good));
  check("negative linear viscosity is refused", is_refused(1., 1., bad_linear));
  check("negative quadratic viscosity is refused", is_refused(1., 1., bad_quadratic));
  check("scalar kernels are always there",
        is_available(InstructionSet::scalar) && is_available(best_instruction_set()));
}

BILLET_TEST(explicit_kernels) {
  for_each_kernel([](const Formulation &formulation) {
    test_instruction_sets(formulation, "elastic", {steel, {}});
    test_instruction_sets(formulation, "linear hardening", {steel, linear});
    test_instruction_sets(formulation, "Voce hardening", {steel, voce});
    test_instruction_sets(formulation, "rate factor", {steel, at_rate(voce, cowper_symonds(40., 5.))});
    test_instruction_sets(formulation, "rate factor, lane by lane",
                          {steel, at_rate(table, std::make_shared<const LogarithmicFactor>(2., 0.1))});
    test_instruction_sets(formulation, "rate factor of a table",
                          {steel, at_rate(table, cowper_symonds(40., 5.))});
    test_masses(formulation);
    test_inverted(formulation);
    test_initialize(formulation);
  });
  test_refused();
  check("history, elastic", Body(make_mesh(cube()), {steel, {}}, Formulation{}).block().history_size() == 51);
  check("history, linear hardening",
        Body(make_mesh(cube()), {steel, linear}, Formulation{}).block().history_size() == 59);
  check("history, Voce hardening",
        Body(make_mesh(cube()), {steel, voce}, Formulation{}).block().history_size() == 67);
  check("history, Voce hardening with a rate factor",
        Body(make_mesh(cube()), {steel, at_rate(voce, cowper_symonds(40., 5.))}, Formulation{})
                .block()
                .history_size() == 75);
}

} // namespace explicit_kernels_test
