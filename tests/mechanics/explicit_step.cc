// SPDX-License-Identifier: LGPL-2.1-or-later
// The stable step against the eigenvalues of the element: with K the derivative of the forces, C that of the
// viscous ones by the velocities, M − Δt C/2 − Δt² K/4 must stay positive. And the viscosity itself.

#include "explicit_blocks.h"

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <numeric>

namespace explicit_step_test {

using namespace billet;
using namespace billet::testing;

using Matrix = dealii::LAPACKFullMatrix<double>;

/// A deformation in two steps: u_0, then u_0 + Δt v, the state that is looked at.
struct State {
  NodalTensor X, u, v;
  double dt;
};

Body reach(const State &state, const MaterialLaw &material, const Formulation &formulation,
           const NodalTensor &moved, NodalTensor &force) {
  Body body(make_mesh(state.X), material, formulation);
  body.advance(state.u, 0.);
  force = body.advance(state.u + state.dt * state.v + moved, state.dt);
  return body;
}

/// The largest eigenvalue of M⁻¹ᐟ² sym(K Δt²/4 + C Δt/2) M⁻¹ᐟ², where K and C are found by differences.
double max_eigenvalue(const State &state, const MaterialLaw &material, const Formulation &formulation,
                      const double dt) {
  Formulation inviscid = formulation;
  inviscid.linear_viscosity = inviscid.quadratic_viscosity = 0.;
  const double h = 1e-6;
  std::array<NodalTensor, 24> K, C;
  NodalTensor force;
  for (unsigned int k = 0; k < 24; ++k) {
    const auto differentiate = [&](const Formulation &which) {
      return central_difference(
          [&](const double e) {
            NodalTensor moved;
            moved[k] = e;
            reach(state, material, which, moved, force);
            return force;
          },
          h);
    };
    K[k] = differentiate(inviscid);
    C[k] = state.dt * (differentiate(formulation) - K[k]);
  }
  std::vector<double> masses(8);
  reach(state, material, formulation, NodalTensor(), force).block().add_masses(masses.data());
  Matrix matrix(24);
  for (unsigned int r = 0; r < 24; ++r)
    for (unsigned int c = 0; c < 24; ++c)
      matrix(r, c) = 0.5 * (0.25 * dt * dt * (K[r][c] + K[c][r]) + 0.5 * dt * (C[r][c] + C[c][r])) /
                     std::sqrt(masses[r / 3] * masses[c / 3]);
  dealii::FullMatrix<double> vectors;
  dealii::Vector<double> values;
  matrix.compute_eigenvalues_symmetric(-1e300, 1e300, 0., values, vectors);
  double maximum = 0.;
  for (const double value : values)
    maximum = std::max(maximum, value);
  return maximum;
}

/// At a stable step that is safe the eigenvalue is at most 1; 1 is sharp.
void test_bound(const std::string &name, const MaterialLaw &material, const Formulation &formulation,
                const std::vector<State> &states) {
  WorstError excess;
  for (const State &state : states) {
    NodalTensor force;
    const Body body = reach(state, material, formulation, NodalTensor(), force);
    if (body.result().inverted != 1)
      excess.add(NAN);
    excess.add(max_eigenvalue(state, material, formulation, body.result().stable_step));
  }
  check(name_of(formulation) + ", " + name + ", stable step is safe", excess.value(), 1. + 1e-6);
}

std::vector<State> random_states(Random &random, const unsigned int n, const double distortion,
                                 const double size, const double rate) {
  std::vector<State> states;
  while (states.size() < n) {
    NodalTensor stretched = cube() + random_nodal(random, distortion);
    for (unsigned int k = 0; k < 24; ++k)
      stretched[k] *= k % 3 == 0 ? 1. : k % 3 == 1 ? 0.5 : 2.;
    State state{stretched, displace(unit + random.tensor(size), stretched) + random_nodal(random, 0.2 * size),
                NodalTensor(), 1e-7};
    state.v = (rate / state.dt) * (displace(unit + random.tensor(1.), stretched) + random_nodal(random, 0.2));
    ReferenceElement reference;
    MeanDilatationKinematics ignored;
    if (compute_reference_element(to_array(state.X), reference) &&
        compute_kinematics(reference, to_array(state.u), ignored) &&
        compute_kinematics(reference, to_array(state.u + state.dt * state.v), ignored))
      states.push_back(state);
  }
  return states;
}

/// An undeformed cube, without viscosity and with much: how far below the exact step. The viscosity's and the
/// stiffness's largest eigenvalues belong to the same field, change of volume.
void test_sharpness(Formulation formulation) {
  WorstError pessimism, excess;
  for (const double viscosity : {0., 1.})
    for (const double nu : {0., 0.3, 0.45}) {
      if (viscosity > 0. && nu == 0.)
        continue; // there shear is as stiff
      formulation.linear_viscosity = viscosity;
      const MaterialLaw material{ElasticModuli::from_young_poisson(young, nu), {}};
      const State state{cube(), NodalTensor(), NodalTensor(), 1e-7};
      NodalTensor force;
      const double dt = reach(state, material, formulation, NodalTensor(), force).result().stable_step;
      const double eigenvalue = max_eigenvalue(state, material, formulation, dt);
      pessimism.add(1. - eigenvalue);
      excess.add(eigenvalue);
    }
  check(name_of(formulation) + ", stable step of a cube is safe", excess.value(), 1. + 1e-6);
  check(name_of(formulation) + ", stable step of a cube is not wasteful", pessimism.value(), 1e-6);
}

/// Volume change of a cube from rest at rate d, and again: pressure and work in closed form. The rate is a
/// little less the second time, in a volume that has changed.
void test_viscosity(Formulation formulation) {
  const double c = std::sqrt((steel.bulk + 4. / 3. * steel.shear) / density), dt = 1e-7;
  double second_work = 0.;
  const auto run = [&](const double linear, const double quadratic, const double strain) {
    formulation.linear_viscosity = linear;
    formulation.quadratic_viscosity = quadratic;
    Body body(make_mesh(cube()), {steel, {}}, formulation);
    body.advance(NodalTensor(), 0.);
    body.advance(displace((1. + strain) * unit, cube()), dt);
    const auto result = body.result();
    body.advance(displace((1. + 2. * strain) * unit, cube()), dt);
    second_work = body.result().viscous_work;
    return result;
  };
  WorstError error, size_error;
  for (const double strain : {-1e-3, 1e-3}) {
    const auto pressure = [&](const double c_1, const double c_2, const double J_0, const double J) {
      const double d = 2. * (J - J_0) / (J + J_0) / dt;
      return density * (c_1 * c * d - (strain < 0. ? c_2 * c_2 * d * d : 0.));
    };
    const double J = std::pow(1. + strain, 3), J_2 = std::pow(1. + 2. * strain, 3);
    const double scale = pressure(0.06, 0., 1., J) * (J - 1.);
    for (const auto &[c_1, c_2] : {std::pair{0.06, 0.}, std::pair{0., 1.2}}) {
      const double q = pressure(c_1, c_2, 1., J), q_2 = pressure(c_1, c_2, J, J_2);
      error.add(std::abs(run(c_1, c_2, strain).viscous_work - 0.5 * q * (J - 1.)) / scale);
      // The size of an element is that of the last step, by a bound of its shape functions' gradients.
      size_error.add(std::abs(second_work - 0.5 * (q + q_2) * (J_2 - J)) / scale);
    }
  }
  check(name_of(formulation) + ", viscous work of a cube", error.value(), 1e-9);
  check(name_of(formulation) + ", viscous work of the second step", size_error.value(), 5e-3);
  check(name_of(formulation) + ", viscosity shortens the step",
        run(0.06, 0., -1e-3).stable_step < 0.96 * run(0., 0., -1e-3).stable_step &&
            run(0.06, 1.2, -1e-3).stable_step < run(0.06, 0., -1e-3).stable_step);

  Random random;
  formulation.linear_viscosity = 0.06;
  formulation.quadratic_viscosity = 1.2;
  WorstError negative;
  for (const State &state : random_states(random, 50, 0.15, 0.1, 0.03)) {
    NodalTensor force;
    negative.add(-reach(state, {steel, linear}, formulation, NodalTensor(), force).result().viscous_work);
  }
  check(name_of(formulation) + ", viscous work from rest is not negative", negative.value(), 0.);

  // There and back: a step may give work back, the sum does not where viscosity is linear.
  formulation.quadratic_viscosity = 0.;
  Body body(make_mesh(cube()), {steel, {}}, formulation);
  double sum = 0.;
  WorstError sum_is_negative;
  for (unsigned int step = 0; step < 40; ++step) {
    body.advance(displace((1. + 1e-3 * std::sin(0.7 * step * step)) * unit, cube()), step == 0 ? 0. : dt);
    sum += body.result().viscous_work;
    sum_is_negative.add(-sum);
  }
  check(name_of(formulation) + ", the sum of viscous work is not negative", sum_is_negative.value(), 0.);
}

/// Free vibration of distorted elements at the stable step of each step: energy stays what it was.
void test_vibration(const Formulation &formulation) {
  Random random;
  const Mesh mesh = make_mesh({3, 3, 2}, 0.25, random);
  Body body(mesh, {steel, {}}, formulation);
  std::vector<double> masses(mesh.n_nodes());
  body.block().add_masses(masses.data());
  NodalArray u(mesh.positions.size()), v(u.size());
  for (double &component : v)
    component = random(-1., 1.);
  const auto kinetic = [&] {
    double energy = 0.;
    for (std::size_t a = 0; a < mesh.n_nodes(); ++a)
      energy += 0.5 * masses[a] * mesh.node(v, a).norm_square();
    return energy;
  };
  const double start = kinetic();
  body.advance(u, 0.);
  const double dt = body.result().stable_step;
  double maximum = 0.;
  for (unsigned int step = 0; step < 2000; ++step) {
    for (std::size_t k = 0; k < u.size(); ++k)
      u[k] += dt * v[k];
    const NodalArray forces = body.advance(u, dt);
    for (std::size_t k = 0; k < u.size(); ++k)
      v[k] -= k % 4 == 3 ? 0. : dt * forces[k] / masses[k / 4];
    maximum = std::max(maximum, kinetic());
  }
  check(name_of(formulation) + ", 2000 steps of free vibration",
        maximum < 2. * start && kinetic() > 0.1 * start);
}

/// The smallest step of `body`'s elements, at rest.
double step_at_rest(Body &body) {
  body.advance(NodalArray(body.mesh().positions.size()), 0.);
  return body.result().stable_step;
}

void test_mass_scaling(Formulation formulation) {
  formulation.linear_viscosity = 0.5;
  formulation.quadratic_viscosity = 1.2;
  const MaterialLaw material{steel, linear};
  const auto total = [](const std::vector<double> &masses) {
    return std::accumulate(masses.begin(), masses.end(), 0.);
  };
  const auto masses_of = [](Body &body) {
    std::vector<double> masses(body.mesh().n_nodes(), 0.);
    body.block().add_masses(masses.data());
    return masses;
  };
  Random random;
  // Equal elements: the factor is the same for all. Eleven of them leave lanes empty.
  const Mesh equal = make_mesh({11, 1, 1}, 0., random);
  Body plain(equal, material, formulation), scaled(equal, material, formulation);
  const double step = step_at_rest(plain), wanted = 1.7 * step;
  const double added = scaled.block().scale_mass(wanted);
  const auto before = masses_of(plain), after = masses_of(scaled);
  WorstError factor;
  for (std::size_t a = 0; a < after.size(); ++a)
    factor.add(std::abs(after[a] / before[a] - 1.7 * 1.7));
  check(name_of(formulation) + ", mass scaling, uniform factor", factor.value(), 1e-12);
  check(name_of(formulation) + ", mass scaling, mass added",
        std::abs(added / (total(after) - total(before)) - 1.), 1e-12);
  check(name_of(formulation) + ", mass scaling, step reached", std::abs(step_at_rest(scaled) / wanted - 1.),
        1e-12);

  // Viscosity knows the new density: so does the force, which at the same displacements is the viscous one's.
  NodalArray u(equal.positions.size());
  for (std::size_t a = 0; a < equal.n_nodes(); ++a)
    set_node(u, a, -1e-3 * equal.node(equal.positions, a));
  const auto pressure = [&](const double rho_factor, const bool is_quadratic) {
    Formulation viscous = formulation;
    viscous.linear_viscosity = is_quadratic ? 0. : 0.5;
    viscous.quadratic_viscosity = is_quadratic ? 1.2 : 0.;
    Body unscaled(equal, material, viscous), body(equal, material, viscous);
    body.block().scale_mass(std::sqrt(rho_factor) * step_at_rest(unscaled));
    step_at_rest(body);
    body.advance(u, step);
    return body.result().viscous_work;
  };
  check(name_of(formulation) + ", mass scaling, linear viscosity as the root of the density",
        std::abs(pressure(4., false) / pressure(1., false) - 2.), 1e-12);
  check(name_of(formulation) + ", mass scaling, quadratic viscosity as the density",
        std::abs(pressure(4., true) / pressure(1., true) - 4.), 1e-12);

  // Distorted elements: only those that need it.
  const Mesh distorted = make_mesh({4, 3, 3}, 0.3, random);
  Body some(distorted, material, formulation), none(distorted, material, formulation);
  const double shortest = step_at_rest(none);
  const double total_before = total(masses_of(some)), some_added = some.block().scale_mass(1.2 * shortest);
  check(name_of(formulation) + ", mass scaling, distorted, step reached",
        std::abs(step_at_rest(some) / (1.2 * shortest) - 1.), 1e-12);
  check(name_of(formulation) + ", mass scaling, distorted, less than for all",
        some_added > 0. && some_added < 0.3 * total_before);
  check(name_of(formulation) + ", mass scaling, distorted, mass added",
        std::abs(some_added / (total(masses_of(some)) - total_before) - 1.), 1e-12);
  check(name_of(formulation) + ", mass scaling, nothing to do",
        none.block().scale_mass(0.9 * shortest) == 0.);
}

BILLET_TEST(explicit_step) {
  Random random;
  const auto undeformed = random_states(random, 6, 0.2, 0., 0.),
             deformed = random_states(random, 8, 0.15, 0.2, 0.), far = random_states(random, 6, 0.1, 0.5, 0.),
             fast = random_states(random, 6, 0.15, 0.1, 0.03);
  for_each_kernel([&](Formulation formulation) {
    for (const double nu : {0., 0.3, 0.48}) {
      const MaterialLaw material{ElasticModuli::from_young_poisson(young, nu), {}};
      const std::string name = "nu = " + std::to_string(nu).substr(0, 4);
      test_bound(name + ", undeformed", material, formulation, undeformed);
      test_bound(name + ", deformed", material, formulation, deformed);
      test_bound(name + ", far deformed", material, formulation, far);
    }
    test_bound("plastic", {steel, linear}, formulation, deformed);
    test_sharpness(formulation);
    test_vibration(formulation);
    test_viscosity(formulation);
    test_mass_scaling(formulation);
    formulation.linear_viscosity = 0.06;
    formulation.quadratic_viscosity = 1.2;
    test_bound("viscous", {steel, {}}, formulation, fast);
    formulation.linear_viscosity = 1.;
    test_bound("very viscous", {steel, {}}, formulation, fast);
  });
}

} // namespace explicit_step_test
