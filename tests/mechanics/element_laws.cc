// SPDX-License-Identifier: LGPL-2.1-or-later
// Every element with every registered elasticity: the element matrix against differences of the forces,
// virgin and with a history, and with points that yield beside others that do not; symmetry where it is
// promised, and the symmetrised one as the symmetric part of the exact one; rigid body motions; six zero
// eigenvalues and no other; the patch test; balance.

#include "elements.h"

#include "billet/material/hypoelastic.h"
#include "billet/material/law_adapter.h"

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/vector.h>

namespace element_laws_test {

using namespace billet;
using namespace billet::testing;

/// A history, and displacements that go on from it.
struct Case {
  std::string name;
  SharedLaw law;
  std::vector<NodalTensor> history;
  NodalTensor u;
  double step, tolerance;
};

/// Of all cases of a formulation.
struct Errors {
  WorstError matrix_changes_force, symmetry, rigid_body_motions, balance;

  void check_all(const std::string &name) const {
    check(name + ", force is the same with and without matrix", matrix_changes_force.value(), 0.);
    check(name + ", symmetry where it is promised, symmetric part of the rest", symmetry.value(), 1e-13);
    check(name + ", rigid body motions", rigid_body_motions.value(), 1e-13);
    check(name + ", forces and moments balance", balance.value(), 1e-13);
  }
};

void test_tangent(const std::string &formulation_name, const ElementFormulation &formulation,
                  const Case &test, Errors &errors) {
  const std::string name = formulation_name + ", " + test.name;
  const NodalTensor X = distorted_cube();
  const auto make = [&](const bool is_symmetrised) {
    ElementFormulation chosen = formulation;
    chosen.is_symmetrised = is_symmetrised;
    auto block = make_block(test.law, X, chosen);
    for (const NodalTensor &u : test.history) {
      compute_force(*block, u);
      block->commit();
    }
    return block;
  };
  const auto block = make(false);
  ElementMatrix K;
  const NodalTensor force = compute_force(*block, test.u, &K);
  errors.matrix_changes_force.add((force - compute_force(*block, test.u)).norm());
  const MatrixTensor matrix = to_tensor(K);
  check(name + ", differences",
        (matrix - compute_difference(*block, test.u, test.step)).norm() / matrix.norm(), test.tolerance);

  const double asymmetry = (matrix - transpose(matrix)).norm() / matrix.norm();
  if (test.law->has_symmetric_moduli())
    errors.symmetry.add(asymmetry);
  else {
    ElementMatrix symmetrised;
    compute_force(*make(true), test.u, &symmetrised);
    errors.symmetry.add((to_tensor(symmetrised) - 0.5 * (matrix + transpose(matrix))).norm() / matrix.norm());
  }
  WorstError &rigid = errors.rigid_body_motions;
  for (unsigned int i = 0; i < 3; ++i) {
    NodalTensor translation;
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      translation[3 * a + i] = 1.;
    rigid.add(multiply(K, translation).norm() / matrix.norm());
    if (test.law->is_rate_form())
      continue; // a rotation on top of another deformation turns its stress but for the error of the step
    Tensor<2, 3> spin;
    spin[i][(i + 1) % 3] = -1.;
    spin[(i + 1) % 3][i] = 1.;
    rigid.add((multiply(K, transform(spin, X + test.u)) - transform(spin, force)).norm() / matrix.norm());
  }
  const Tensor<2, 3> dyad = virial(force, X + test.u);
  const double scale = force.norm() + 1e-3 * matrix.norm();
  errors.balance.add(resultant(force).norm() / scale);
  errors.balance.add((dyad - transpose(dyad)).norm() / scale);
}

/// Undeformed: six rigid body modes, no hourglass mode.
void test_modes(const std::string &name, const ElementFormulation &formulation, const SharedLaw &law,
                const NodalTensor &X) {
  ElementMatrix K;
  compute_force(*make_block(law, X, formulation), NodalTensor(), &K);
  dealii::LAPACKFullMatrix<double> matrix(n_element_dofs);
  dealii::FullMatrix<double> eigenvectors;
  dealii::Vector<double> eigenvalues;
  for (unsigned int r = 0; r < n_element_dofs; ++r)
    for (unsigned int c = 0; c < n_element_dofs; ++c)
      matrix(r, c) = K[r * n_element_dofs + c];
  const double size = to_tensor(K).norm();
  matrix.compute_eigenvalues_symmetric(-size, 2. * size, 0., eigenvalues, eigenvectors);
  std::sort(eigenvalues.begin(), eigenvalues.end());
  check(name + ", six rigid body modes", eigenvalues.size() == n_element_dofs &&
                                             std::abs(eigenvalues[0]) < 1e-14 * size &&
                                             std::abs(eigenvalues[5]) < 1e-14 * size);
  check(name + ", no other soft mode", eigenvalues[6] > 1e-3 * size);
}

/// A cube of eight elements, distorted inside, under uniform F: the forces on the middle node cancel, and
/// each element reports the same stress.
void test_patch(const std::string &name, const ElementFormulation &formulation, const SharedLaw &law) {
  Random random;
  std::array<Tensor<1, 3>, 27> points;
  for (unsigned int p = 0; p < 27; ++p) {
    const std::array<unsigned int, 3> index = {p % 3, p / 3 % 3, p / 9};
    for (unsigned int i = 0; i < 3; ++i)
      points[p][i] = index[i] + (index[i] == 1 ? random(-0.3, 0.3) : 0.);
  }
  const Tensor<2, 3> F = unit + random.tensor(0.3);
  Tensor<1, 3> sum;
  SymmetricTensor<2, 3> first;
  double scale = 0.;
  WorstError stress_error;
  for (unsigned int cell = 0; cell < 8; ++cell) {
    NodalTensor X;
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const unsigned int p =
          ((cell & 1U) + (a & 1U)) + 3 * ((cell >> 1 & 1U) + (a >> 1 & 1U)) + 9 * ((cell >> 2) + (a >> 2));
      for (unsigned int i = 0; i < 3; ++i)
        X[3 * a + i] = points[p][i];
    }
    const auto block = make_block(law, X, formulation);
    const NodalTensor u = displace(F, X);
    const Tensor<1, 3> force = node(compute_force(*block, u), 7 - cell);
    block->commit();
    const SymmetricTensor<2, 3> stress = block->summarize(0, to_array(u)).cauchy_stress;
    if (cell == 0)
      first = stress;
    stress_error.add((stress - first).norm() / first.norm());
    sum += force;
    scale = std::max(scale, force.norm());
  }
  check(name + ", patch of eight elements, middle node in balance", sum.norm() / scale, 1e-11);
  check(name + ", patch of eight elements, uniform stress", stress_error.value(), 1e-11);
}

/// A law in rate form with a pressure of its own, p = κ (J − 1) in place of κ ln J.
class LinearPressure {
public:
  using History = HypoelasticElasticity::History;
  using Moduli = GradientModuli;
  static constexpr bool has_plasticity = false, is_rate_form = true, has_symmetric_moduli = false,
                        has_exact_dissipation = false;

  explicit LinearPressure(const ElasticModuli &elastic) : law_(elastic) {}

  bool update(const Tensor<2, 3> &F, const double J, const History &history_n, History &history,
              SymmetricTensor<2, 3> &tau, GradientModuli *moduli, const PointStep &step = {}) const {
    if (!law_.update(F, J, history_n, history, tau, moduli, step))
      return false;
    tau = history.deviator + elastic().bulk * (J - 1.) * dealii::unit_symmetric_tensor<3>();
    if (moduli != nullptr)
      moduli->volumetric = elastic().bulk * J;
    return true;
  }
  double elastic_energy(const double J, const History &history) const {
    return history.deviator * history.deviator / (4. * elastic().shear) +
           elastic().bulk * (J - 1. - std::log(J));
  }
  static History find_history(const Tensor<2, 3> &F, const SymmetricTensor<2, 3> &deviator,
                              const double alpha) {
    return HypoelasticElasticity::find_history(F, deviator, alpha);
  }
  static std::vector<StateField> fields() { return HypoelasticElasticity::fields(); }
  static void store(const History &history, double *numbers) {
    HypoelasticElasticity::store(history, numbers);
  }
  static History restore(const double *numbers) { return HypoelasticElasticity::restore(numbers); }
  static double plastic_work(const History &) { return 0.; }
  static double equivalent_plastic_strain(const History &) { return 0.; }
  const ElasticModuli &elastic() const { return law_.elastic(); }
  double min_wave_stiffness(const Stretches &stretches) const { return law_.min_wave_stiffness(stretches); }

private:
  HypoelasticElasticity law_;
};

/// The volumetric part is the law's: elements take its derivative from the moduli. Volumes change by a fifth,
/// where κ in place of κ J would be off by that.
void test_own_pressure(const ElementFormulation &formulation, const std::string &name) {
  Random random;
  const NodalTensor X = distorted_cube(), u = displace(1.07 * unit + random.tensor(0.02), X);
  const auto block = make_element_block(
      std::make_shared<const LawAdapter<LinearPressure>>("linear pressure", LinearPressure(steel)),
      formulation);
  std::size_t offender = 0;
  AssertThrow(block->initialize({to_array(X)}, offender), dealii::ExcInternalError());
  ElementMatrix K;
  compute_force(*block, u, &K);
  const MatrixTensor matrix = to_tensor(K);
  check(name + ", a pressure of the law's own, differences",
        (matrix - compute_difference(*block, u, 1e-5)).norm() / matrix.norm(), 1e-8);
}

struct Deformations {
  Random random;
  NodalTensor X = distorted_cube();

  NodalTensor deform(const double uniform, const double nodal) {
    return displace(unit + random.tensor(uniform), X) + random_nodal(random, nodal);
  }
};

/// Rigid body modes and the patch test.
void test_modes_and_patch(const std::string &name, const ElementFormulation &formulation,
                          const SharedLaw &law) {
  test_modes(name + ", cube", formulation, law, cube());
  test_modes(name + ", distorted element", formulation, law, distorted_cube());
  test_patch(name, formulation, law);
}

void test_metal(const LawFormulation &formulation) {
  Deformations deformations;
  const NodalTensor &X = deformations.X;
  const std::string name = name_of(formulation);
  Errors errors;
  const NodalTensor small = deformations.deform(0.05, 0.02), large = deformations.deform(0.1, 0.05);
  const Tensor<2, 3> Q = deformations.random.rotation();
  const NodalTensor turned = transform(Q, X + large) - X;
  const auto run = [&](const Case &test) { test_tangent(name, formulation, test, errors); };
  const auto law = [&](const MaterialLaw &material) { return make_law(material, formulation.elasticity); };
  const SharedLaw elastic = law({steel, {}}), plastic = law({steel, linear});
  run({"elastic, undeformed", elastic, {}, NodalTensor(), 1e-5, 1e-9});
  run({"elastic, first step", elastic, {}, large, 1e-5, 1e-9});
  run({"elastic, second step", elastic, {small}, large, 1e-5, 1e-9});
  run({"Poisson's ratio 0.4999",
       law({ElasticModuli::from_young_poisson(2e5, 0.4999), linear}),
       {},
       large,
       1e-5,
       1e-8});
  const auto run_hardening = [&](const std::string &hardening_name, const auto &hardening) {
    const SharedLaw hardens = law({steel, hardening});
    run({hardening_name + ", first step", hardens, {}, large, 1e-5, 1e-8});
    run({hardening_name + ", second step", hardens, {small}, large, 1e-5, 1e-8});
    run({hardening_name + ", third step, turned", hardens, {small, large}, 1.02 * turned, 1e-5, 1e-8});
  };
  for_each_hardening(run_hardening, /*with_ludwik=*/true);
  // Smaller steps, lest a point crosses yield.
  run({"some points yield", plastic, {}, deformations.deform(0., 0.0025), 1e-7, 1e-7});
  run({"unloading", plastic, {small}, 0.99 * small, 1e-7, 1e-7});
  // The mean gradient of a one-point element stays as it is: all flow is by the stabilisation.
  NodalTensor bending;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    bending[3 * a] = (a == 0 || a == 3 || a == 4 || a == 7) ? 0.02 : -0.02;
  run({"bending", plastic, {}, bending, 1e-5, 1e-8});
  run({"bending, second step", plastic, {bending}, 1.3 * bending, 1e-5, 1e-8});
  errors.check_all(name);
  test_modes_and_patch(name, formulation, plastic);
}

/// An elasticity that does not support plasticity.
void test_rubber(const std::string &name, const ElementFormulation &formulation, const SharedLaw &law) {
  Deformations deformations;
  Errors errors;
  const NodalTensor large = deformations.deform(0.1, 0.05), larger = deformations.deform(0.2, 0.1);
  const NodalTensor turned =
      transform(deformations.random.rotation(), deformations.X + larger) - deformations.X;
  const auto run = [&](const Case &test) { test_tangent(name, formulation, test, errors); };
  run({"undeformed", law, {}, NodalTensor(), 1e-5, 1e-9});
  run({"first step", law, {}, large, 1e-5, 1e-9});
  run({"second step, turned", law, {large}, turned, 1e-5, 1e-9});
  errors.check_all(name);
  test_modes_and_patch(name, formulation, law);
}

BILLET_TEST(element_laws) {
  for_each_formulation([](const LawFormulation &formulation) {
    if (formulation.elasticity == hypoelastic)
      test_own_pressure(formulation, name_of(formulation));
  });
  for_each_formulation(&test_metal);
  const auto laws = rubber_laws();
  for (const auto element : all_elements())
    for (const auto &[name, law] : laws) {
      ElementFormulation formulation;
      formulation.element = element;
      test_rubber(std::string(element.name()) + ", " + name, formulation, law);
    }
}

} // namespace element_laws_test
