// SPDX-License-Identifier: LGPL-2.1-or-later
// Internal forces of the mean-dilatation element: exact under uniform deformation, in balance under any, the
// gradient of the stored energy, and turned by a rotation.

#include "elements.h"

#include "billet/material/plastic.h"

namespace element_patch_test {

using namespace billet;
using namespace billet::testing;

const MaterialLaw elastic_material{steel, {}};
const MaterialLaw plastic_material{steel, linear};

/// Uniform F on a distorted element: F̄ = F at every point, Σ f_a ⊗ x_a = V τ(F), and the summary reports τ/J.
template <class Law>
void test_uniform_element(const std::string &name, const MaterialLaw &material, const Law &law) {
  Random random;
  const NodalTensor X = distorted_cube();
  WorstError kinematics_error, virial_error, summary_error;
  for (unsigned int i = 0; i < 20; ++i) {
    const Tensor<2, 3> F = unit + random.tensor(0.4);
    const NodalTensor u = displace(F, X);
    ReferenceElement element;
    MeanDilatationKinematics kinematics;
    if (!compute_reference_element(to_array(X), element) ||
        !compute_kinematics(element, to_array(u), kinematics))
      return check(name, false);
    double volume = 0.;
    for (unsigned int q = 0; q < n_element_points; ++q) {
      kinematics_error.add((kinematics.F_bar[q] - F).norm());
      volume += element.volumes[q];
    }
    SymmetricTensor<2, 3> tau;
    typename Law::History history;
    law.update(F, {}, history, tau, nullptr);
    const auto block = make_block(material, X);
    const NodalTensor force = compute_force(*block, u);
    virial_error.add((virial(force, X + u) - volume * static_cast<Tensor<2, 3>>(tau)).norm() /
                     (volume * tau.norm()));

    block->commit();
    const ElementSummary summary = block->summarize(0, to_array(u));
    summary_error.add((summary.cauchy_stress - tau / determinant(F)).norm() / tau.norm());
    const double alpha = law.equivalent_plastic_strain(history), work = law.plastic_work(history);
    summary_error.add(std::abs(summary.equivalent_plastic_strain - alpha) / (alpha + 1e-300));
    summary_error.add(std::abs(summary.elastic_energy / (volume * law.elastic_energy(F, history)) - 1.));
    summary_error.add(std::abs(summary.plastic_work - volume * work) / (volume * work + 1e-300));
  }
  check(name + ", uniform deformation, F_bar = F", kinematics_error.value(), 1e-13);
  check(name + ", uniform deformation, virial", virial_error.value(), 1e-11);
  check(name + ", uniform deformation, summary", summary_error.value(), 1e-11);
}

/// A cube of eight elements, distorted inside: its volume is exact, and under uniform F the forces on the
/// middle node cancel.
void test_patch(const std::string &name, const MaterialLaw &material) {
  Random random;
  std::array<Tensor<1, 3>, 27> points;
  for (unsigned int p = 0; p < 27; ++p) {
    const std::array<unsigned int, 3> index = {p % 3, p / 3 % 3, p / 9};
    for (unsigned int i = 0; i < 3; ++i) // points of a face stay in its plane
      points[p][i] = index[i] + (index[i] == 1 ? random(-0.3, 0.3) : 0.);
  }
  const Tensor<2, 3> F = unit + random.tensor(0.3);
  Tensor<1, 3> sum;
  double scale = 0., volume = 0.;
  for (unsigned int cell = 0; cell < 8; ++cell) {
    NodalTensor X;
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const unsigned int p =
          ((cell & 1U) + (a & 1U)) + 3 * ((cell >> 1 & 1U) + (a >> 1 & 1U)) + 9 * ((cell >> 2) + (a >> 2));
      for (unsigned int i = 0; i < 3; ++i)
        X[3 * a + i] = points[p][i];
    }
    const Tensor<1, 3> force = node(compute_force(*make_block(material, X), displace(F, X)), 7 - cell);
    sum += force;
    scale = std::max(scale, force.norm());
    ReferenceElement element;
    AssertThrow(compute_reference_element(to_array(X), element), dealii::ExcInternalError());
    for (const double w : element.volumes)
      volume += w;
  }
  check(name + ", patch of eight elements, volume", std::abs(volume - 8.), 1e-13);
  check(name + ", patch of eight elements, middle node in balance", sum.norm() / scale, 1e-11);
}

/// A uniform state with a random part on top.
NodalTensor random_displacement(Random &random, const NodalTensor &X, const double size) {
  return displace(unit + random.tensor(size), X) + random_nodal(random, 0.5 * size);
}

void test_balance(const std::string &name, const MaterialLaw &material) {
  Random random;
  const NodalTensor X = distorted_cube();
  WorstError sum, moment;
  for (unsigned int i = 0; i < 20; ++i) {
    const NodalTensor u = random_displacement(random, X, 0.2);
    const NodalTensor force = compute_force(*make_block(material, X), u);
    const Tensor<2, 3> dyad = virial(force, X + u);
    sum.add(resultant(force).norm() / force.norm());
    moment.add((dyad - transpose(dyad)).norm() / force.norm());
  }
  check(name + ", forces balance", sum.value(), 1e-14);
  check(name + ", moments balance", moment.value(), 1e-14);
}

/// f = ∂E/∂u with E elastic energy plus plastic work of one step from the virgin state: both the elastic law
/// and, for one step, the return map derive from a potential (Ortiz & Stainier 1999).
void test_energy(const std::string &name, const MaterialLaw &material) {
  Random random;
  const NodalTensor X = distorted_cube(), u = random_displacement(random, X, 0.2);
  const NodalTensor force = compute_force(*make_block(material, X), u);
  NodalTensor gradient;
  for (unsigned int k = 0; k < n_element_dofs; ++k)
    gradient[k] = central_difference(
        [&](const double e) {
          NodalTensor moved = u;
          moved[k] += e;
          const auto block = make_block(material, X);
          compute_force(*block, moved);
          block->commit();
          const ElementSummary summary = block->summarize(0, to_array(moved));
          return summary.elastic_energy + summary.plastic_work;
        },
        1e-4);
  check(name + ", force is the gradient of the energy", (gradient - force).norm() / force.norm(), 1e-9);
}

/// A stressed element turned through 360 degrees about a skew axis and shifted, the history committed at each
/// step.
void test_rotation(const std::string &name, const MaterialLaw &material, const double size) {
  Random random;
  const NodalTensor X = distorted_cube(), x = X + random_displacement(random, X, size);
  const auto block = make_block(material, X);
  const NodalTensor force = compute_force(*block, x - X);
  block->commit();
  const ElementSummary start = block->summarize(0, to_array(x - X));
  WorstError turned, added, strain;
  const Tensor<1, 3> axis({2. / 7., 3. / 7., 6. / 7.});
  for (unsigned int degrees = 0; degrees <= 360; degrees += 10) {
    const Tensor<2, 3> R =
        dealii::Physics::Transformations::Rotations::rotation_matrix_3d(axis, degrees * M_PI / 180.);
    const NodalTensor u = transform(R, x) - X;
    turned.add((compute_force(*block, u) - transform(R, force)).norm() / force.norm());
    block->commit();
    const ElementSummary summary = block->summarize(0, to_array(u));
    added.add(std::abs(summary.cauchy_stress.norm() / start.cauchy_stress.norm() - 1.));
    strain.add(std::abs(summary.equivalent_plastic_strain - start.equivalent_plastic_strain));
  }
  check(name + ", rotation turns the forces", turned.value(), 1e-12);
  check(name + ", rotation adds no stress", added.value(), 1e-12);
  check(name + ", rotation adds no plastic strain", strain.value(), 1e-14);
}

BILLET_TEST(element_patch) {
  test_uniform_element("elastic", elastic_material, HenckyElasticity(steel));
  test_uniform_element("plastic", plastic_material, HenckyPlasticity(steel, make_hardening(linear)));
  for (const auto &[name, material] :
       {std::pair("elastic", elastic_material), std::pair("plastic", plastic_material)}) {
    test_patch(name, material);
    test_balance(name, material);
    test_energy(name, material);
    test_rotation(name + std::string(", 10 %"), material, 0.1);
    test_rotation(name + std::string(", 1 %"), material, 0.01);
  }
}

} // namespace element_patch_test
