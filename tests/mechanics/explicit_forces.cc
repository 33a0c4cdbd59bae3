// SPDX-License-Identifier: LGPL-2.1-or-later
// Forces of the explicit kernels: patch test, balance, rotation, the gradient of the stored energy, and the
// stabilisation of the one-point element.

#include "explicit_blocks.h"

namespace explicit_forces_test {

using namespace billet;
using namespace billet::testing;

using Element = Formulation::Element;

/// Uniform deformation of distorted elements: inner nodes in balance, the same stress everywhere, no
/// hourglass energy.
void test_patch(const Formulation &formulation, const std::string &law, const MaterialLaw &material) {
  Random random;
  const Mesh mesh = make_mesh({3, 3, 3}, 0.25, random);
  Body body(mesh, material, formulation);
  const Tensor<2, 3> gradient = random.tensor(0.2);
  WorstError balance, stress;
  NodalArray u(mesh.positions.size());
  for (const double t : {0.02, 0.5, 1.}) {
    for (std::size_t a = 0; a < mesh.n_nodes(); ++a)
      set_node(u, a, t * (gradient * mesh.node(mesh.positions, a)));
    const NodalArray &forces = body.advance(u, 0.);
    double scale = 0.;
    for (const double f : forces)
      scale = std::max(scale, std::abs(f));
    for (std::size_t a = 0; a < mesh.n_nodes(); ++a) {
      bool is_inside = true;
      for (unsigned int i = 0; i < 3; ++i)
        is_inside = is_inside && mesh.positions[4 * a + i] > 1e-9 && mesh.positions[4 * a + i] < 3. - 1e-9;
      if (is_inside)
        balance.add(mesh.node(forces, a).norm() / scale);
    }
    const auto first = body.summarize(0).cauchy_stress;
    for (std::size_t e = 1; e < mesh.elements.size(); ++e)
      stress.add((body.summarize(e).cauchy_stress - first).norm() / first.norm());
    stress.add(body.result().hourglass_energy / scale);
  }
  check(name_of(formulation) + ", " + law + ", patch, inner nodes in balance", balance.value(), 1e-12);
  check(name_of(formulation) + ", " + law + ", patch, uniform stress", stress.value(), 1e-11);
}

/// A uniform state with a random part on top.
NodalTensor random_displacement(Random &random, const NodalTensor &X, const double size) {
  return displace(unit + random.tensor(size), X) + random_nodal(random, 0.5 * size);
}

void test_balance(Formulation formulation) {
  formulation.linear_viscosity = 0.06;
  formulation.quadratic_viscosity = 1.2;
  Random random;
  const NodalTensor X = distorted_cube();
  WorstError sum, moment;
  for (unsigned int i = 0; i < 20; ++i) {
    const NodalTensor u = random_displacement(random, X, 0.15);
    Body body(make_mesh(X), {steel, linear}, formulation);
    body.advance(NodalTensor(0.3 * u), 1e-6);
    const NodalTensor force = body.advance(u, 1e-6);
    const Tensor<2, 3> dyad = virial(force, X + u);
    sum.add(resultant(force).norm() / force.norm());
    moment.add((dyad - transpose(dyad)).norm() / force.norm());
  }
  check(name_of(formulation) + ", forces balance", sum.value(), 1e-13);
  check(name_of(formulation) + ", moments balance", moment.value(), 1e-13);
}

/// A stressed element turned about a skew axis in steps of 10 degrees and shifted.
void test_rotation(const Formulation &formulation, const MaterialLaw &material, const std::string &law) {
  Random random;
  const NodalTensor X = distorted_cube(), x = X + random_displacement(random, X, 0.1);
  Body body(make_mesh(X), material, formulation);
  const NodalTensor force = body.advance(x - X, 1e-6);
  const ElementSummary start = body.summarize();
  WorstError turned, added;
  const Tensor<1, 3> axis({2. / 7., 3. / 7., 6. / 7.});
  NodalTensor shift;
  for (unsigned int k = 0; k < 24; ++k)
    shift[k] = 0.1 * (k % 3);
  for (unsigned int degrees = 10; degrees <= 360; degrees += 10) {
    const Tensor<2, 3> R =
        dealii::Physics::Transformations::Rotations::rotation_matrix_3d(axis, degrees * M_PI / 180.);
    turned.add((body.advance(transform(R, x) - X + shift, 1e-6) - transform(R, force)).norm() / force.norm());
    const ElementSummary summary = body.summarize();
    added.add(std::abs(summary.cauchy_stress.norm() / start.cauchy_stress.norm() - 1.));
    added.add(std::abs(summary.equivalent_plastic_strain - start.equivalent_plastic_strain));
  }
  check(name_of(formulation) + ", " + law + ", rotation turns the forces", turned.value(), 1e-12);
  check(name_of(formulation) + ", " + law + ", rotation adds no stress or strain", added.value(), 1e-12);

  Body virgin(make_mesh(X), material, formulation);
  WorstError from_rest;
  for (unsigned int degrees = 0; degrees <= 90; degrees += 15) {
    const Tensor<2, 3> R =
        dealii::Physics::Transformations::Rotations::rotation_matrix_3d(axis, degrees * M_PI / 180.);
    from_rest.add(virgin.advance(transform(R, X) - X + shift, 1e-6).norm() / steel.shear);
  }
  check(name_of(formulation) + ", " + law + ", rotation alone makes no forces", from_rest.value(), 1e-13);
}

/// f = ∂E/∂u with E elastic and hourglass energy: each from a body of its own, at large strain.
void test_energy(const Formulation &formulation) {
  const MaterialLaw material{steel, {}};
  Random random;
  const NodalTensor X = distorted_cube(), u = random_displacement(random, X, 0.2);
  const NodalTensor force = Body(make_mesh(X), material, formulation).advance(u, 0.);
  NodalTensor gradient;
  for (unsigned int k = 0; k < n_element_dofs; ++k)
    gradient[k] = central_difference(
        [&](const double e) {
          NodalTensor moved = u;
          moved[k] += e;
          Body body(make_mesh(X), material, formulation);
          body.advance(moved, 0.);
          return body.summarize().elastic_energy + body.result().hourglass_energy;
        },
        1e-4);
  check(name_of(formulation) + ", force is the gradient of the energy",
        (gradient - force).norm() / force.norm(), 1e-9);
}

/// The twelve fields ηζ, ζξ, ξη, ξηζ on a brick l_1 × l_2 × l_3.
NodalTensor hourglass_field(const unsigned int mode, const unsigned int direction) {
  NodalTensor field;
  constexpr unsigned int bits[4] = {6, 5, 3, 7};
  for (unsigned int a = 0; a < 8; ++a) {
    double value = 1.;
    for (unsigned int i = 0; i < 3; ++i)
      if ((bits[mode] >> i & 1U) != 0U)
        value *= (a >> i & 1U) != 0U ? 1. : -1.;
    field[3 * a + direction] = value;
  }
  return field;
}

/// Work of small fields on a thin brick against closed forms: bending of a beam and a plate, torsion.
void test_hourglass() {
  Formulation formulation = make_formulation(Element::one_point, hencky);
  const double l[3] = {2., 1., 0.2}, volume = l[0] * l[1] * l[2], size = 1e-6;
  NodalTensor X = cube();
  for (unsigned int k = 0; k < 24; ++k)
    X[k] *= l[k % 3];
  const auto energy_of = [&](const NodalTensor &field) {
    Body body(make_mesh(X), {steel, {}}, formulation);
    const NodalTensor force = body.advance(size * field, 0.);
    return 0.5 * (force * field) / size;
  };
  WorstError positive;
  for (unsigned int mode = 0; mode < 4; ++mode)
    for (unsigned int direction = 0; direction < 3; ++direction)
      positive.add(energy_of(hourglass_field(mode, direction)) > 1e-3 * young * volume ? 0. : 1.);
  check("one point, every hourglass mode has a stiffness", positive.value(), 0.);

  // u_1 = ξη: strain (2/l_1) η; plane strain in between
  const double plane = young / (1. - poisson * poisson);
  const double strain = 2. / l[0];
  check("one point, bending, the stiffness of a beam",
        std::abs(energy_of(hourglass_field(2, 0)) / (plane / 6. * volume * strain * strain) - 1.), 1e-6);
  // Torsion of a plate: w = ξη, u = −z ∂w/∂x, v = −z ∂w/∂y; shear γ_xy = −2 z ∂²w/∂x∂y
  NodalTensor torsion = hourglass_field(2, 2);
  torsion -= (l[2] / l[0]) * hourglass_field(0, 0) + (l[2] / l[1]) * hourglass_field(1, 1);
  const double twist = 4. / (l[0] * l[1]);
  check("one point, torsion, the stiffness of a plate",
        std::abs(energy_of(torsion) / (steel.shear / 6. * volume * l[2] * l[2] * twist * twist) - 1.), 1e-6);
}

/// Bending by the stabilisation alone, to and fro: one yield condition for both, (X7). With e the strain at
/// the faces and E' = E/(1 − ν²): q = √(G E') |e|, moment and plastic strain of the first way in closed form.
void test_plastic_bending(const std::string &elasticity) {
  const Formulation formulation = make_formulation(Element::one_point, elasticity);
  Body body(make_mesh(cube()), {steel, perfect}, formulation);
  const NodalTensor field = hourglass_field(2, 0); // e = 2 of a unit
  const double yield = 700., G = steel.shear, plane = young / (1. - poisson * poisson);
  const double limit = yield * yield / (6. * G);
  double work = 0., dissipated = 0., amplitude = 0.;
  WorstError above, negative, moment, strain;
  NodalTensor last;
  for (unsigned int step = 1; step <= 2000; ++step) {
    const double change = step <= 1000 ? 2e-5 : -2e-5;
    amplitude += change;
    const NodalTensor force = body.advance(amplitude * field, 0.);
    work += 0.5 * ((force + last) * field) * change;
    last = force;
    dissipated += body.result().plastic_work;
    above.add(body.result().hourglass_energy / limit - 1.);
    negative.add(-body.result().plastic_work);
    const double q = std::sqrt(G * plane) * 2. * amplitude;
    if (step <= 1000 && q > yield) {
      moment.add(std::abs(force * field / (2. / 3. * yield * std::sqrt(plane / G)) - 1.));
      strain.add(std::abs(body.summarize().equivalent_plastic_strain / ((q - yield) / (3. * G)) - 1.));
    }
  }
  const std::string name = name_of(formulation) + ", bending beyond yield, ";
  check(name + "stored energy is limited", above.value(), 1e-12);
  check(name + "moment", moment.value(), 1e-12);
  check(name + "plastic strain", strain.value(), 1e-10);
  check(name + "dissipation is positive", negative.value(), 0.);
  check(name + "it dissipates", dissipated > limit);
  check(name + "work is stored or dissipated",
        std::abs(work - dissipated - body.result().hourglass_energy - body.summarize().elastic_energy) /
            dissipated,
        5e-3);
}

/// Simple shear that flows, and bending beside it: the stabilisation is as stiff as flow is, σ_y/3 α̇ for G;
/// of bending by Δe in each step σ_y/(3 G Δα) Δe stays elastic.
void test_hourglass_flow(const std::string &elasticity) {
  const Formulation formulation = make_formulation(Element::one_point, elasticity);
  const double yield = 7., change = 2e-5, part = 0.1;
  Body body(make_mesh(cube()), {steel, LinearHardening{yield, 0.}}, formulation);
  Tensor<2, 3> shear;
  shear[0][1] = 1.;
  const NodalTensor field = displace(unit + shear, cube()) + part * hourglass_field(2, 0);
  NodalTensor force;
  double before = 0., now = 0.;
  for (unsigned int step = 1; step <= 200; ++step) {
    force = body.advance(step * change * field, 1.);
    before = now;
    now = body.summarize().equivalent_plastic_strain;
  }
  const double rate = now - before, e = 2. * part * change, plane = young / (1. - poisson * poisson);
  const std::string name = name_of(formulation) + ", bending in flow, ";
  check(name + "plastic strain",
        std::abs(rate / std::sqrt(change * change / 3. + plane * e * e / (9. * steel.shear)) - 1.), 1e-2);
  check(name + "moment",
        std::abs(force * hourglass_field(2, 0) / (2. / 3. * plane * e * yield / (3. * steel.shear * rate)) -
                 1.),
        1e-2);
}

BILLET_TEST(explicit_forces) {
  for_each_kernel([](const Formulation &formulation) {
    test_patch(formulation, "elastic", {steel, {}});
    test_patch(formulation, "plastic", {steel, linear});
    test_balance(formulation);
    test_rotation(formulation, {steel, {}}, "elastic");
    test_rotation(formulation, {steel, linear}, "plastic");
    if (formulation.elasticity != hypoelastic)
      test_energy(formulation);
  });
  test_hourglass();
  for (const auto &elasticity : metal_elasticities()) {
    test_plastic_bending(elasticity);
    test_hourglass_flow(elasticity);
  }
}

} // namespace explicit_forces_test
