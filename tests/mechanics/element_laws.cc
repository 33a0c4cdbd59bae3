// SPDX-License-Identifier: LGPL-2.1-or-later
// Every element with every kinematics: the element matrix against differences of the forces, virgin and with
// a history, and with points that yield beside others that do not; symmetry where it is promised, and the
// symmetrised one as the symmetric part of the exact one; rigid body motions; six zero eigenvalues and no
// other; the patch test; balance.

#include "elements.h"

#include "billet/material/hypoelastic.h"
#include "billet/material/law_adapter.h"

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/vector.h>

using namespace billet;
using namespace billet::testing;

/// A history, and displacements that go on from it.
struct Case {
  std::string name;
  MaterialLaw material;
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

void test_tangent(const LawFormulation &formulation, const Case &test, Errors &errors) {
  const std::string name = name_of(formulation) + ", " + test.name;
  const NodalTensor X = distorted_cube();
  const auto make = [&](const bool is_symmetrised) {
    LawFormulation chosen = formulation;
    chosen.is_symmetrised = is_symmetrised;
    auto block = make_block(test.material, X, chosen);
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
  const bool is_plastic = test.material.is_plastic();
  if (has_symmetric_tangent(formulation, is_plastic))
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
    if (formulation.kinematics == LawFormulation::Kinematics::hypoelastic)
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
void test_modes(const LawFormulation &formulation, const std::string &shape, const NodalTensor &X) {
  ElementMatrix K;
  compute_force(*make_block({steel, linear}, X, formulation), NodalTensor(), &K);
  dealii::LAPACKFullMatrix<double> matrix(n_element_dofs);
  dealii::FullMatrix<double> eigenvectors;
  dealii::Vector<double> eigenvalues;
  for (unsigned int r = 0; r < n_element_dofs; ++r)
    for (unsigned int c = 0; c < n_element_dofs; ++c)
      matrix(r, c) = K[r * n_element_dofs + c];
  const double size = to_tensor(K).norm();
  matrix.compute_eigenvalues_symmetric(-size, 2. * size, 0., eigenvalues, eigenvectors);
  std::sort(eigenvalues.begin(), eigenvalues.end());
  check(name_of(formulation) + ", " + shape + ", six rigid body modes",
        eigenvalues.size() == n_element_dofs && std::abs(eigenvalues[0]) < 1e-14 * size &&
            std::abs(eigenvalues[5]) < 1e-14 * size);
  check(name_of(formulation) + ", " + shape + ", no other soft mode", eigenvalues[6] > 1e-3 * size);
}

/// A cube of eight elements, distorted inside, under uniform F: the forces on the middle node cancel, and
/// each element reports the same stress.
void test_patch(const LawFormulation &formulation) {
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
    const auto block = make_block({steel, linear}, X, formulation);
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
  check(name_of(formulation) + ", patch of eight elements, middle node in balance", sum.norm() / scale,
        1e-11);
  check(name_of(formulation) + ", patch of eight elements, uniform stress", stress_error.value(), 1e-11);
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

int main() {
  for_each_formulation([](const LawFormulation &formulation) {
    if (formulation.kinematics == LawFormulation::Kinematics::hypoelastic)
      test_own_pressure(formulation, name_of(formulation));
  });
  for_each_formulation([](const LawFormulation &formulation) {
    Random random;
    const NodalTensor X = distorted_cube();
    Errors errors;
    const auto deform = [&](const double uniform, const double nodal) {
      return displace(unit + random.tensor(uniform), X) + random_nodal(random, nodal);
    };
    const NodalTensor small = deform(0.05, 0.02), large = deform(0.1, 0.05);
    const Tensor<2, 3> Q = random.rotation();
    const NodalTensor turned = transform(Q, X + large) - X;
    const auto run = [&](const Case &test) { test_tangent(formulation, test, errors); };
    const MaterialLaw elastic{steel, {}};
    run({"elastic, undeformed", elastic, {}, NodalTensor(), 1e-5, 1e-9});
    run({"elastic, first step", elastic, {}, large, 1e-5, 1e-9});
    run({"elastic, second step", elastic, {small}, large, 1e-5, 1e-9});
    run({"Poisson's ratio 0.4999",
         {ElasticModuli::from_young_poisson(2e5, 0.4999), linear},
         {},
         large,
         1e-5,
         1e-8});
    for_each_hardening([&](const std::string &name, const auto &hardening) {
      const MaterialLaw material{steel, hardening};
      run({name + ", first step", material, {}, large, 1e-5, 1e-8});
      run({name + ", second step", material, {small}, large, 1e-5, 1e-8});
      run({name + ", third step, turned", material, {small, large}, 1.02 * turned, 1e-5, 1e-8});
    });
    // Smaller steps, lest a point crosses yield.
    run({"some points yield", {steel, linear}, {}, deform(0., 0.0025), 1e-7, 1e-7});
    run({"unloading", {steel, linear}, {small}, 0.99 * small, 1e-7, 1e-7});
    // The mean gradient of a one-point element stays as it is: all flow is by the stabilisation.
    NodalTensor bending;
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      bending[3 * a] = (a == 0 || a == 3 || a == 4 || a == 7) ? 0.02 : -0.02;
    run({"bending", {steel, linear}, {}, bending, 1e-5, 1e-8});
    run({"bending, second step", {steel, linear}, {bending}, 1.3 * bending, 1e-5, 1e-8});
    errors.check_all(name_of(formulation));
    test_modes(formulation, "cube", cube());
    test_modes(formulation, "distorted element", X);
    test_patch(formulation);
  });
  return exit_code();
}
