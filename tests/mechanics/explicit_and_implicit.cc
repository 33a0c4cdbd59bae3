// SPDX-License-Identifier: LGPL-2.1-or-later
// The explicit kernels, with series, modes and convected history, give the forces and states of the implicit
// elements that have the same formulation, on the same motion.

#include "../sample_laws.h"
#include "explicit_blocks.h"

using namespace billet;
using namespace billet::testing;

LawFormulation implicit_twin(const Formulation &formulation) {
  LawFormulation twin;
  twin.kinematics = formulation.kinematics;
  twin.element = formulation.element;
  return twin;
}

ElementVectors gather(const Mesh &mesh, const std::size_t element, const NodalArray &v) {
  ElementVectors values;
  for (unsigned int k = 0; k < 24; ++k)
    values[k] = v[4 * mesh.elements[element][k / 3] + k % 3];
  return values;
}

/// Twelve elements that share nodes, along a path towards a random target of the given size, and back.
void test_path(const std::string &name, const Formulation &chosen, const MaterialLaw &material,
               const double size, const double scatter, const double tolerance) {
  WorstError force_error, summary_error, energy_error;
  bool yields = false, has_hourglass = false;
  for (const auto instructions : {InstructionSet::scalar, InstructionSet::automatic}) {
    Random random;
    Formulation formulation = chosen;
    formulation.instructions = instructions;
    Body body(make_mesh({3, 2, 2}, 0.2, random), material, formulation);
    const Mesh &mesh = body.mesh();
    const auto reference = make_element_block(material, implicit_twin(formulation));
    std::vector<ElementVectors> X;
    for (std::size_t e = 0; e < mesh.elements.size(); ++e)
      X.push_back(gather(mesh, e, mesh.positions));
    std::size_t offender = 0;
    AssertThrow(reference->initialize(X, offender), dealii::ExcInternalError());

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
      double scale = 5e-3 * material.elastic.shear; // forces of small strains
      for (std::size_t e = 0; e < X.size(); ++e) {
        ElementVectors force;
        AssertThrow(reference->evaluate(e, gather(mesh, e, u), force, nullptr), dealii::ExcInternalError());
        for (unsigned int k = 0; k < 24; ++k) {
          expected[4 * mesh.elements[e][k / 3] + k % 3] += force[k];
          scale = std::max(scale, std::abs(force[k]));
        }
      }
      reference->commit();
      const NodalArray &forces = body.advance(u, 1e-6);
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
        summary_error.add(std::abs(a.plastic_work - b.plastic_work) / (scale + a.plastic_work));
        yields = yields || a.equivalent_plastic_strain > 0.01;
      }
      has_hourglass = has_hourglass || hourglass > 1e-6 * elastic;
      energy_error.add(std::abs(body.result().elastic_energy - elastic) / scale);
      energy_error.add(std::abs(body.result().hourglass_energy - hourglass) / scale);
    }
  }
  const std::string full_name = name_of(chosen) + ", " + name;
  check(full_name + ", forces", force_error.value(), tolerance);
  check(full_name + ", summaries", summary_error.value(), tolerance);
  check(full_name + ", energies", energy_error.value(), tolerance);
  check(full_name + (!material.is_plastic() ? ", no plastic strain" : ", plastic strain"),
        yields == (material.is_plastic()));
  check(full_name + ", hourglass energy where there is one point",
        has_hourglass == (chosen.element == Formulation::Element::one_point));
}

int main() {
  for (const auto element : all_elements())
    for (const auto kinematics : all_kinematics) {
      const Formulation formulation = make_formulation(element, kinematics);
      for_each_hardening([&](const std::string &name, const auto &hardening) {
        test_path(name, formulation, {steel, hardening}, 0.3, 0.15, 1e-11);
      });
      test_path("Voce softening", formulation, {steel, VoceHardening{450., 400., 16.93, 20.}}, 0.3, 0.15,
                1e-11);
      test_path("power law, convex", formulation, {steel, PowerLawHardening{565.3, 1., 1.5}}, 0.3, 0.15,
                1e-11);
      test_path("elastic, small strain", formulation, {steel, {}}, 0.002, 0.0005, 1e-12);
      test_path("elastic, moderate strain", formulation, {steel, {}}, 0.05, 0.02, 1e-12);
      test_path("elastic, large strain", formulation, {steel, {}}, 0.4, 0.15, 1e-11);
      test_path("plastic after large elastic strain", formulation,
                {steel, LinearHardening{0.3 * young, 0.1 * young}}, 0.4, 0.15, 1e-11);
    }
  return exit_code();
}
