// SPDX-License-Identifier: LGPL-2.1-or-later
// The law of a VUMAT, with subroutines that this file brings: a neo-Hookean one that reads stretches and
// deformation gradients, against the library's law, its tangent included; J2 plasticity in corotational
// rates, along paths without rotation against the hypoelastic law, and with rotations. What a VUMAT is
// called with.

#include "moduli.h"

#include "billet/material/elasticity.h"
#include "billet/material/hypoelastic.h"
#include "billet/material/law_point.h"
#include "billet/material/neo_hookean.h"
#include "billet/material/umat_law.h"
#include "billet/material/vumat_law.h"

#include <limits>

namespace vumat_test {

using namespace billet;
using namespace billet::testing;

namespace {

constexpr unsigned int place_of[6] = {0, 1, 2, 3, 5, 4};
bool is_not_a_number = false;
WorstError polar_error;

/// What the last call was given.
struct Given {
  int nblock = 0;
  double time = 0., dt = 0., density = 0., length = 0., temp_old = 0., temp_new = 0.;
  double strain_inc[6] = {}, spin_inc[3] = {};
  std::string name;
} given;

SymmetricTensor<2, 3> tensor_of(const double *array, const int n, const int p) {
  SymmetricTensor<2, 3> result;
  for (unsigned int i = 0; i < 6; ++i)
    result.access_raw_entry(place_of[i]) = array[static_cast<int>(i) * n + p];
  return result;
}

void write(const SymmetricTensor<2, 3> &tensor, double *array, const int n, const int p) {
  for (unsigned int i = 0; i < 6; ++i)
    array[static_cast<int>(i) * n + p] = tensor.access_raw_entry(place_of[i]);
}

Tensor<2, 3> gradient_of(const double *array, const int n, const int p) {
  constexpr unsigned int rows[9] = {0, 1, 2, 0, 1, 2, 1, 2, 0}, columns[9] = {0, 1, 2, 1, 2, 0, 0, 1, 2};
  Tensor<2, 3> F;
  for (unsigned int i = 0; i < 9; ++i)
    F[rows[i]][columns[i]] = array[static_cast<int>(i) * n + p];
  return F;
}

/// props: κ, G.
void neo_hookean(int *nblock, int *, int *, int *, int *, int *, int *, double *, double *total_time,
                 double *dt, char *cmname, double *, double *char_length, double *props, double *density,
                 double *strain_inc, double *rel_spin_inc, double *temp_old, double *, double *, double *,
                 double *, double *, double *, double *, double *temp_new, double *stretch_new,
                 double *defgrad_new, double *, double *stress_new, double *, double *ener_intern_new,
                 double *, const std::size_t length) {
  const int n = *nblock;
  given = {n,           *total_time, *dt, density[0], char_length[0],
           temp_old[0], temp_new[0], {},  {},         {cmname, length}};
  for (int i = 0; i < 6; ++i)
    given.strain_inc[i] = strain_inc[i * n];
  for (int i = 0; i < 3; ++i)
    given.spin_inc[i] = rel_spin_inc[i * n];
  for (int p = 0; p < n; ++p) {
    const SymmetricTensor<2, 3> U = tensor_of(stretch_new, n, p);
    const Tensor<2, 3> F = gradient_of(defgrad_new, n, p), stretch = U;
    const double J = determinant(U);
    polar_error.add((transpose(F) * F - stretch * stretch).norm());
    const SymmetricTensor<2, 3> C = symmetrize(stretch * stretch) / std::cbrt(J * J);
    write((props[1] * dealii::deviator(C) + props[0] * std::log(J) * dealii::unit_symmetric_tensor<3>()) / J,
          stress_new, n, p);
    ener_intern_new[p] =
        compute_elastic_energy({props[0], props[1]}, {J, trace(C) / 3., dealii::deviator(C)}) /
        (density[p] * J);
    if (is_not_a_number)
      stress_new[3 * n + p] = std::numeric_limits<double>::quiet_NaN();
  }
}

/// props: κ, G, yield stress, hardening modulus; of Kirchhoff's stress.
void plastic(int *nblock, int *, int *, int *, int *, int *, int *, double *, double *, double *, char *,
             double *, double *, double *props, double *, double *strain_inc, double *, double *,
             double *stretch_old, double *, double *, double *stress_old, double *state_old, double *,
             double *, double *, double *stretch_new, double *, double *, double *stress_new,
             double *state_new, double *, double *, std::size_t) {
  const int n = *nblock;
  for (int p = 0; p < n; ++p) {
    const double J_n = determinant(tensor_of(stretch_old, n, p)),
                 J = determinant(tensor_of(stretch_new, n, p));
    SymmetricTensor<2, 3> s = dealii::deviator(J_n * tensor_of(stress_old, n, p)) +
                              2. * props[1] * dealii::deviator(tensor_of(strain_inc, n, p));
    const double q = std::sqrt(1.5) * s.norm(), excess = q - props[2] - props[3] * state_old[p];
    const double strain = std::max(0., excess / (3. * props[1] + props[3]));
    if (strain > 0.)
      s *= 1. - 3. * props[1] * strain / q;
    state_new[p] = state_old[p] + strain;
    write((s + props[0] * std::log(J) * dealii::unit_symmetric_tensor<3>()) / J, stress_new, n, p);
  }
}

UserLawSettings settings_of(VumatFunction *function) {
  UserLawSettings settings;
  settings.library = "none";
  settings.name = "SOLID";
  settings.constants = {steel.bulk, steel.shear};
  settings.element_length = 2.5;
  if (function == &plastic) {
    settings.constants.insert(settings.constants.end(), {700., 300.});
    settings.initial_state = {0.};
    settings.state_names = {"equivalent plastic strain"};
  }
  return settings;
}

constexpr double dt = 0.1, density = 8e-9;

void test_elastic() {
  const VumatLaw vumat(&neo_hookean, settings_of(&neo_hookean), density);
  check("bulk modulus", std::abs(vumat.elastic().bulk / steel.bulk - 1.), 1e-8);
  check("shear modulus", std::abs(vumat.elastic().shear / steel.shear - 1.), 1e-8);
  check("first calls at time 0", std::abs(given.time), 0.);
  const SharedLaw own = make_neo_hookean_law(steel);
  Random random;
  WorstError stress, moduli, energy, at_rest;
  for (unsigned int i = 0; i < 20; ++i) {
    const Tensor<2, 3> F = unit + random.tensor(0.3);
    if (!(determinant(F) > 0.3))
      continue;
    LawPoint point(vumat), other(*own);
    StressRates rates, of_other;
    const SymmetricTensor<2, 3> tau = *point.evaluate(F, dt, &rates),
                                expected = *other.evaluate(F, dt, &of_other);
    stress.add((tau - expected).norm() / expected.norm());
    moduli.add(relative_difference(rates, of_other, false));
    energy.add(std::abs(point.stored_energy(F) / other.stored_energy(F) - 1.));
    point.commit();
    at_rest.add((*point.evaluate(F, 0.) - expected).norm() / expected.norm());
  }
  check("neo-Hookean, stress", stress.value(), 1e-12);
  check("neo-Hookean, moduli", moduli.value(), 1e-7);
  check("neo-Hookean, stored energy", energy.value(), 1e-9);
  check("stress of the known state", at_rest.value(), 1e-12);
  check("stretches and gradients", polar_error.value(), 1e-13);
}

void test_plastic() {
  const VumatLaw vumat(&plastic, settings_of(&plastic), density);
  const SharedLaw own = make_hypoelastic_law(steel, make_hardening(LinearHardening{700., 300.}));
  LawPoint point(vumat), turned(vumat), other(*own);
  Random random;
  const Tensor<2, 3> Q = random.rotation();
  turned.evaluate(Q, dt);
  turned.commit();
  WorstError stress, rotation, tangent;
  Tensor<2, 3> last;
  for (unsigned int i = 1; i <= 400; ++i) {
    Tensor<2, 3> F = unit;
    F[0][0] += 5e-4 * i;
    F[1][1] -= 3e-4 * i;
    F[2][2] += 1e-4 * std::min(i, 400 - i);
    StressRates promised;
    const SymmetricTensor<2, 3> tau = *point.evaluate(F, dt, &promised), expected = *other.evaluate(F, dt);
    stress.add((tau - expected).norm() / expected.norm());
    rotation.add((*turned.evaluate(Q * F, dt) - symmetrize(Q * Tensor<2, 3>(tau) * transpose(Q))).norm() /
                 tau.norm());
    last = F;
    if (const auto measured = point.differentiate(F, dt, 1e-5, 0.01))
      tangent.add(relative_difference(promised, *measured, false));
    for (LawPoint *each : {&point, &turned, &other})
      each->commit();
  }
  check("J2, stress of the hypoelastic law", stress.value(), 1e-12);
  check("it yields", vumat.equivalent_plastic_strain(point.state().data()) > 0.05);
  check("rotations turn the stress", rotation.value(), 1e-9);
  check("J2, moduli", tangent.value(), 1e-4);
  check("work without energies of its own is stored",
        point.dissipated_energy() == 0. &&
            std::abs(point.stored_energy(unit) / (other.stored_energy(last) + other.dissipated_energy()) -
                     1.) < 0.02);
  LawPoint given_stress(vumat), of_own(*own);
  const Tensor<2, 3> F = unit + random.tensor(0.2);
  const SymmetricTensor<2, 3> deviator = 100. * dealii::deviator(symmetrize(random.tensor(1.)));
  vumat.set_stress(F, deviator, 0.125, given_stress.state_n().data());
  own->set_stress(F, deviator, 0.125, of_own.state_n().data());
  const SymmetricTensor<2, 3> expected = *of_own.evaluate(F, 0.);
  check("given stress", (*given_stress.evaluate(F, 0.) - expected).norm() / expected.norm(), 1e-10);
}

void test_arguments() {
  UserLawSettings settings = settings_of(&neo_hookean);
  settings.reads_temperature = true;
  const VumatLaw vumat(&neo_hookean, settings, density);
  std::vector<double> state_n(vumat.n_state()), state(vumat.n_state());
  vumat.initialize(state_n.data());
  SymmetricTensor<2, 3> tau;
  PointStep step;
  Tensor<2, 3> F = unit;
  F[0][0] = 1.1;
  F[1][1] = 0.9;
  for (const double temperature : {20., 50.}) {
    step.dt = dt;
    step.temperature = temperature;
    vumat.update(F, determinant(F), step, state_n.data(), state.data(), tau, nullptr);
    state_n = state;
    F[0][1] = F[1][0] = 0.02;
  }
  check("one point without a tangent", given.nblock == 1);
  check("times", std::abs(given.time - 2. * dt) + std::abs(given.dt - dt), 1e-15);
  check("temperatures", std::abs(given.temp_old - 20.) + std::abs(given.temp_new - 50.), 1e-12);
  check("density", std::abs(given.density * determinant(symmetrize(F)) / density - 1.), 1e-12);
  check("length", std::abs(given.length - 2.5), 0.);
  check("name, padded", given.name == "SOLID" + std::string(75, ' '));
  // ΔU U⁻¹ with ΔU12 = 0.02, U at mid-step = [1.1 0.01; 0.01 0.9].
  const double det = 1.1 * 0.9 - 1e-4, first = 0.02 * 1.1 / det, second = 0.02 * 0.9 / det;
  check("strain increment, a tensor's shear", std::abs(given.strain_inc[3] - 0.5 * (first + second)), 1e-14);
  check("relative spin", std::abs(given.spin_inc[0] - 0.5 * (second - first)), 1e-14);
  is_not_a_number = true;
  const bool is_refused = !vumat.update(F, determinant(F), step, state_n.data(), state.data(), tau, nullptr);
  is_not_a_number = false;
  check("numbers that are none",
        is_refused && vumat.refusal().what == "VUMAT 'SOLID' of library 'none' returned a stress that is "
                                              "not a number (stressNew)");
}

} // namespace

BILLET_TEST(vumat) {
  test_elastic();
  test_plastic();
  test_arguments();
}

} // namespace vumat_test
