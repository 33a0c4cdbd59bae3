// SPDX-License-Identifier: LGPL-2.1-or-later
// The Hencky kernel by series and convected history gives the forces and states of MeanDilatationBlock.

#include "../sample_laws.h"
#include "explicit_blocks.h"

using namespace billet;
using namespace billet::testing;

/// `n` elements that share nodes, along a path of `n_steps` towards a random target of the given size, and
/// back.
void test_path(const std::string &name, const MaterialLaw &material, const double size, const double scatter,
               const double tolerance) {
  WorstError force_error, summary_error;
  bool yields = false;
  for (const auto instructions : {InstructionSet::scalar, InstructionSet::automatic}) {
    Random random;
    Body body(make_mesh({3, 2, 2}, 0.2, random), material,
              make_formulation(Formulation::Element::mean_dilatation, Formulation::Kinematics::hencky,
                               instructions));
    const Mesh &mesh = body.mesh();
    const auto reference = make_element_block(material);
    std::vector<ElementVectors> X;
    for (const auto &element : mesh.elements) {
      ElementVectors x;
      for (unsigned int k = 0; k < 24; ++k)
        x[k] = mesh.positions[4 * element[k / 3] + k % 3];
      X.push_back(x);
    }
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
        ElementVectors values, force;
        for (unsigned int k = 0; k < 24; ++k)
          values[k] = u[4 * mesh.elements[e][k / 3] + k % 3];
        AssertThrow(reference->evaluate(e, values, force, nullptr), dealii::ExcInternalError());
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
      double elastic = 0.;
      for (std::size_t e = 0; e < X.size(); ++e) {
        ElementVectors values;
        for (unsigned int k = 0; k < 24; ++k)
          values[k] = u[4 * mesh.elements[e][k / 3] + k % 3];
        const ElementSummary a = reference->summarize(e, values), b = body.summarize(e);
        elastic += a.elastic_energy;
        summary_error.add((a.cauchy_stress - b.cauchy_stress).norm() / scale);
        summary_error.add(std::abs(a.equivalent_plastic_strain - b.equivalent_plastic_strain));
        summary_error.add(std::abs(a.elastic_energy - b.elastic_energy) / scale);
        summary_error.add(std::abs(a.plastic_work - b.plastic_work) / (scale + a.plastic_work));
        yields = yields || a.equivalent_plastic_strain > 0.01;
      }
      summary_error.add(std::abs(body.result().elastic_energy - elastic) / scale);
    }
  }
  check(name + ", forces", force_error.value(), tolerance);
  check(name + ", summaries", summary_error.value(), tolerance);
  check(name + (material.hardening.index() == 0 ? ", no plastic strain" : ", plastic strain"),
        yields == (material.hardening.index() != 0));
}

int main() {
  for_each_hardening([](const std::string &name, const auto &hardening) {
    test_path(name, {steel, hardening}, 0.3, 0.15, 1e-12);
  });
  test_path("Voce softening", {steel, VoceHardening{450., 400., 16.93, 20.}}, 0.3, 0.15, 1e-12);
  test_path("power law, convex", {steel, PowerLawHardening{565.3, 1., 1.5}}, 0.3, 0.15, 1e-12);
  test_path("elastic, small strain", {steel, {}}, 0.002, 0.0005, 1e-12);
  test_path("elastic, moderate strain", {steel, {}}, 0.05, 0.02, 1e-12);
  test_path("elastic, large strain", {steel, {}}, 0.4, 0.15, 1e-12);
  test_path("plastic after large elastic strain", {steel, LinearHardening{0.3 * young, 0.1 * young}}, 0.4,
            0.15, 1e-12);
  return exit_code();
}
