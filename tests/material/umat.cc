// SPDX-License-Identifier: LGPL-2.1-or-later
// The law of a UMAT, with subroutines that this file brings: a neo-Hookean one, whose stress and tangent
// depend on DFGRD1 alone, and J2 plasticity in rates. Against the library's own laws; moduli against
// differences; refusals, crashes and what a UMAT is called with. The subroutines of Abaqus that UMATs call.

#include "moduli.h"

#include "billet/material/guarded_call.h"
#include "billet/material/hypoelastic.h"
#include "billet/material/law_point.h"
#include "billet/material/law_type.h"
#include "billet/material/neo_hookean.h"
#include "billet/material/umat_law.h"

#include <csignal>
#include <cstring>
#include <limits>

namespace umat_test {

using namespace billet;
using namespace billet::testing;

extern "C" {
void sinv_(const double *, double *, double *, const int *, const int *);
void sprinc_(const double *, double *, const int *, const int *, const int *);
void sprind_(const double *, double *, double *, const int *, const int *, const int *);
void rotsig_(const double *, const double *, double *, const int *, const int *, const int *);
void xit_();
}

namespace {

enum class Fault { none, shorter, stress, tangent, state, leave, crash, beyond_state, beyond_stress };
Fault fault = Fault::none;
bool computes_energy = true;

/// What the last call was given.
struct Given {
  double time = 0., dtime = 0., temp = 0., dtemp = 0., celent = 0., drot[9] = {}, dfgrd0[9] = {},
         stran[6] = {}, dstran[6] = {};
  int kinc = 0, nstatv = 0, nprops = 0;
  std::string name;
} given;

SymmetricTensor<2, 3> tensor_of(const double *s, const double shear = 1.) {
  SymmetricTensor<2, 3> result;
  for (unsigned int i = 0; i < 6; ++i)
    result.access_raw_entry(i) = (i < 3 ? 1. : shear) * s[i];
  return result;
}

Tensor<2, 3> matrix_of(const double *a) {
  Tensor<2, 3> result;
  for (unsigned int i = 0; i < 9; ++i)
    result[i % 3][i / 3] = a[i];
  return result;
}

/// DDSDDE of a linear map of d onto the Jaumann rate of τ, for δd = e_j.
template <class Map> void write_tangent(const Map &map, const double J, double *ddsdde) {
  for (unsigned int j = 0; j < 6; ++j) {
    SymmetricTensor<2, 3> d;
    d.access_raw_entry(j) = j < 3 ? 1. : 0.5;
    const SymmetricTensor<2, 3> rate = map(d);
    for (unsigned int i = 0; i < 6; ++i)
      ddsdde[6 * j + i] = rate.access_raw_entry(i) / J;
  }
}

void go_wrong(double *stress, double *statev, double *ddsdde, double *pnewdt) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  switch (fault) {
  case Fault::none:
    return;
  case Fault::shorter:
    *pnewdt = 0.25;
    return;
  case Fault::stress:
    stress[4] = nan;
    return;
  case Fault::tangent:
    ddsdde[7] = 1. / (nan < 0. ? 1. : 0.);
    return;
  case Fault::state:
    statev[0] = nan;
    return;
  case Fault::leave:
    xit_();
    return;
  case Fault::beyond_state:
    statev[1] = 0.;
    return;
  case Fault::beyond_stress:
    stress[-1] = 0.;
    return;
  case Fault::crash:
    std::raise(SIGSEGV);
  }
}

/// PROPS: κ, G.
void neo_hookean(double *stress, double *, double *ddsdde, double *sse, double *, double *, double *,
                 double *, double *, double *, double *stran, double *dstran, double *time, double *dtime,
                 double *temp, double *dtemp, double *, double *, char *cmname, int *, int *, int *,
                 int *nstatv, double *props, int *nprops, double *, double *drot, double *pnewdt,
                 double *celent, double *dfgrd0, double *dfgrd1, int *, int *, int *, int *, int *, int *kinc,
                 const std::size_t length) {
  given = {time[1], *dtime, *temp,   *dtemp,  *celent,         {}, {}, {},
           {},      *kinc,  *nstatv, *nprops, {cmname, length}};
  std::copy_n(drot, 9, given.drot);
  std::copy_n(dfgrd0, 9, given.dfgrd0);
  std::copy_n(stran, 6, given.stran);
  std::copy_n(dstran, 6, given.dstran);
  const double bulk = props[0], shear = props[1];
  const Tensor<2, 3> F = matrix_of(dfgrd1);
  const double J = determinant(F);
  const SymmetricTensor<2, 3> b = symmetrize(F * transpose(F)) / std::cbrt(J * J);
  const SymmetricTensor<2, 3> tau =
      shear * dealii::deviator(b) + bulk * std::log(J) * dealii::unit_symmetric_tensor<3>();
  for (unsigned int i = 0; i < 6; ++i)
    stress[i] = tau.access_raw_entry(i) / J;
  const Tensor<2, 3> full = b;
  write_tangent(
      [&](const SymmetricTensor<2, 3> &d) {
        const Tensor<2, 3> D = d;
        return shear * dealii::deviator(symmetrize(D * full + full * D - 2. / 3. * trace(D) * full)) +
               bulk * trace(d) * dealii::unit_symmetric_tensor<3>();
      },
      J, ddsdde);
  if (computes_energy)
    *sse = compute_elastic_energy({bulk, shear}, {J, trace(b) / 3., dealii::deviator(b)});
  go_wrong(stress, nullptr, ddsdde, pnewdt);
}

/// PROPS: κ, G, yield stress, hardening modulus; in Kirchhoff's stress. STATEV: equivalent plastic strain.
void plastic(double *stress, double *statev, double *ddsdde, double *, double *, double *, double *, double *,
             double *, double *, double *, double *dstran, double *, double *, double *, double *, double *,
             double *, char *, int *, int *, int *, int *, double *props, int *, double *, double *,
             double *pnewdt, double *, double *dfgrd0, double *dfgrd1, int *, int *, int *, int *, int *,
             int *, std::size_t) {
  const double bulk = props[0], shear = props[1], J_n = determinant(matrix_of(dfgrd0)),
               J = determinant(matrix_of(dfgrd1));
  const SymmetricTensor<2, 3> s =
      dealii::deviator(J_n * tensor_of(stress)) + 2. * shear * dealii::deviator(tensor_of(dstran, 0.5));
  const double q = std::sqrt(1.5) * s.norm(), excess = q - props[2] - props[3] * statev[0];
  double beta = 1., gamma = 0.;
  SymmetricTensor<2, 3> n;
  if (excess > 0.) {
    const double strain = excess / (3. * shear + props[3]);
    beta = 1. - 3. * shear * strain / q;
    gamma = 1. / (1. + props[3] / (3. * shear)) - (1. - beta);
    n = s / s.norm();
    statev[0] += strain;
  }
  const SymmetricTensor<2, 3> tau = beta * s + bulk * std::log(J) * dealii::unit_symmetric_tensor<3>();
  for (unsigned int i = 0; i < 6; ++i)
    stress[i] = tau.access_raw_entry(i) / J;
  write_tangent(
      [&](const SymmetricTensor<2, 3> &d) {
        return bulk * trace(d) * dealii::unit_symmetric_tensor<3>() +
               2. * shear * (beta * dealii::deviator(d) - gamma * (n * d) * n);
      },
      J, ddsdde);
  go_wrong(stress, statev, ddsdde, pnewdt);
}

UserLawSettings settings_of(UmatFunction *function) {
  UserLawSettings settings;
  settings.library = "none";
  settings.name = "SOLID";
  settings.constants = {steel.bulk, steel.shear};
  if (function == &plastic) {
    settings.constants.insert(settings.constants.end(), {700., 300.});
    settings.initial_state = {0.};
    settings.state_names = {"equivalent plastic strain"};
  }
  return settings;
}

constexpr double dt = 0.1;

void test_against_own_laws() {
  const UmatLaw umat(&neo_hookean, settings_of(&neo_hookean));
  check("bulk modulus", std::abs(umat.elastic().bulk / steel.bulk - 1.), 1e-12);
  check("shear modulus", std::abs(umat.elastic().shear / steel.shear - 1.), 1e-12);
  const SharedLaw own = make_neo_hookean_law(steel);
  Random random;
  check("bound of the stiffness of waves", std::abs(umat.bound_stiffness({}) / own->bound_stiffness({}) - 1.),
        1e-9);
  WorstError stress, moduli, energy;
  for (unsigned int i = 0; i < 20; ++i) {
    const Tensor<2, 3> F = unit + random.tensor(0.3);
    if (!(determinant(F) > 0.3))
      continue;
    LawPoint point(umat), other(*own);
    StressRates rates, of_other;
    const SymmetricTensor<2, 3> tau = *point.evaluate(F, dt, &rates),
                                expected = *other.evaluate(F, dt, &of_other);
    stress.add((tau - expected).norm() / expected.norm());
    moduli.add(relative_difference(rates, of_other, false));
    energy.add(std::abs(point.stored_energy(F) / other.stored_energy(F) - 1.));
  }
  check("neo-Hookean, stress", stress.value(), 1e-13);
  check("neo-Hookean, moduli, all velocity gradients", moduli.value(), 1e-12);
  check("neo-Hookean, stored energy", energy.value(), 1e-9);
}

void test_rates() {
  const UmatLaw umat(&plastic, settings_of(&plastic));
  const SharedLaw own = make_hypoelastic_law(steel, make_hardening(LinearHardening{700., 300.}));
  LawPoint point(umat), other(*own);
  Random random;
  Tensor<2, 3> F = unit;
  WorstError stress, strain, symmetric, all;
  for (unsigned int i = 0; i < 40; ++i) {
    F = (unit + random.tensor(0.01)) * F;
    StressRates promised;
    const SymmetricTensor<2, 3> tau = *point.evaluate(F, dt, &promised), expected = *other.evaluate(F, dt);
    stress.add((tau - expected).norm() / expected.norm());
    strain.add(std::abs(umat.equivalent_plastic_strain(point.state().data()) -
                        own->equivalent_plastic_strain(other.state().data())));
    if (const auto measured = point.differentiate(F, dt, 1e-6, 0.01)) {
      symmetric.add(relative_difference(promised, *measured, true));
      all.add(relative_difference(promised, *measured, false));
    }
    point.commit();
    other.commit();
  }
  check("J2 in rates, stress of the hypoelastic law", stress.value(), 1e-12);
  check("J2 in rates, plastic strain", strain.value(), 1e-14);
  check("it yields", umat.equivalent_plastic_strain(point.state().data()) > 0.05);
  check("J2 in rates, moduli, symmetric velocity gradients", symmetric.value(), 1e-2);
  check("J2 in rates, moduli, all velocity gradients", all.value(), 2e-2);
  // Evaluation of the known state.
  const auto at_rest = point.evaluate(F, 0.), at_end = other.evaluate(F, 0.);
  check("stress of the known state", (*at_rest - *at_end).norm() / at_end->norm(), 1e-12);
  // A rigid rotation turns stress and strain.
  const Tensor<2, 3> Q = random.rotation();
  const SymmetricTensor<2, 3> turned = symmetrize(Q * Tensor<2, 3>(*at_rest) * transpose(Q));
  check("a rotation turns the stress", (*point.evaluate(Q * F, dt) - turned).norm() / turned.norm(), 1e-9);
}

/// All work is stored if the UMAT does not compute SSE.
void test_dissipation() {
  const UmatLaw umat(&plastic, settings_of(&plastic));
  LawPoint point(umat);
  const SharedLaw own = make_hypoelastic_law(steel, make_hardening(LinearHardening{700., 300.}));
  LawPoint other(*own);
  WorstError tangent;
  Tensor<2, 3> F;
  for (unsigned int i = 1; i <= 200; ++i) {
    F = unit;
    F[0][0] += 5e-4 * i;
    F[1][2] = F[2][1] = 2e-4 * i;
    StressRates promised;
    AssertThrow(point.evaluate(F, dt, &promised) && other.evaluate(F, dt), dealii::ExcInternalError());
    if (const auto measured = point.differentiate(F, dt, 1e-7, 0.01))
      tangent.add(relative_difference(promised, *measured, true));
    point.commit();
    other.commit();
  }
  check("work without energies of its own is stored", point.dissipated_energy() == 0.);
  check("and is all of the work",
        std::abs(point.stored_energy(F) / (other.stored_energy(F) + other.dissipated_energy()) - 1.), 1e-3);
  check("J2 in rates, moduli in steps without spin", tangent.value(), 1e-4);
}

void test_arguments() {
  UserLawSettings settings = settings_of(&neo_hookean);
  settings.element_length = 2.5;
  settings.reads_temperature = true;
  settings.initial_state = {1., 2., 3.};
  const UmatLaw umat(&neo_hookean, settings);
  check("number of own fields", umat.fields().size() == 7 && umat.n_state() == 32);
  std::vector<double> state_n(umat.n_state()), state(umat.n_state());
  umat.initialize(state_n.data());
  PointStep step;
  SymmetricTensor<2, 3> tau;
  Tensor<2, 3> F = unit;
  F[0][0] = 1.1;
  F[0][1] = 0.2;
  for (const double temperature : {20., 50.}) {
    step.dt = dt;
    step.temperature = temperature;
    umat.update(F, determinant(F), step, state_n.data(), state.data(), tau, nullptr);
    state_n = state;
    F[0][1] = 0.3;
  }
  check("times", std::abs(given.time - dt) + std::abs(given.dtime - dt), 1e-15);
  check("temperatures", std::abs(given.temp - 20.) + std::abs(given.dtemp - 30.), 1e-12);
  check("counts", given.kinc == 2 && given.nstatv == 3 && given.nprops == 2);
  check("element length", std::abs(given.celent - 2.5), 0.);
  check("name, padded", given.name == "SOLID" + std::string(75, ' '));
  check("DFGRD0", std::abs(given.dfgrd0[0] - 1.1) + std::abs(given.dfgrd0[3] - 0.2), 1e-15);
  check("state variables are kept", state[29] == 1. && state[31] == 3.);
  // The increment of shear: ΔL12 = 0.1/F22 at mid-step.
  check("DSTRAN with engineering shears", std::abs(given.dstran[3] - 0.1), 1e-15);
  check("DROT by columns",
        std::abs(given.drot[3] + given.drot[1]) + std::abs(given.drot[3] - 0.05 / 1.000625), 1e-15);
  MidpointIncrement first, second;
  Tensor<2, 3> middle = unit, end = F;
  middle[0][0] = end[0][0] = 1.1;
  middle[0][1] = 0.2;
  compute_increment(unit, middle, first);
  compute_increment(middle, end, second);
  const Tensor<2, 3> strain = symmetrize(first.gradient);
  const SymmetricTensor<2, 3> turned = symmetrize(second.rotation * strain * transpose(second.rotation));
  check("STRAN is turned", (tensor_of(given.stran, 0.5) - turned).norm(), 1e-15);
}

bool has(const std::string &text, const std::string &part) { return text.find(part) != std::string::npos; }

void test_refusals() {
  const UmatLaw umat(&plastic, settings_of(&plastic));
  LawPoint point(umat);
  Tensor<2, 3> F = unit;
  F[0][1] = 0.02;
  const auto refuses = [&](const Fault of, const std::string &words) {
    fault = of;
    const bool is_refused = !point.evaluate(F, dt);
    fault = Fault::none;
    check("refused: " + words, is_refused && has(umat.refusal().what, "UMAT 'SOLID' of library 'none'") &&
                                   has(umat.refusal().what, words) && !umat.refusal().is_final);
    check("then it works again", point.evaluate(F, dt) && umat.refusal().what.empty());
  };
  refuses(Fault::shorter, "asks for a shorter step (PNEWDT = 0.25");
  refuses(Fault::stress, "returned a stress that is not a number");
  refuses(Fault::tangent, "returned a tangent that is not a number");
  refuses(Fault::state, "returned a state variable that is not a number");
  fault = Fault::leave;
  check("XIT", !point.evaluate(F, dt) && umat.refusal().is_final && has(umat.refusal().what, "XIT"));
  fault = Fault::none;
  const UmatLaw crashing(&plastic, settings_of(&plastic));
  LawPoint other(crashing);
  fault = Fault::crash;
  check("crash", !other.evaluate(F, dt) && crashing.refusal().is_final &&
                     has(crashing.refusal().what, "segmentation fault"));
  fault = Fault::none;
  check("no call after a crash", !other.evaluate(F, dt) && crashing.refusal().is_final);
  fault = Fault::crash;
  std::string why;
  try {
    const UmatLaw failing(&plastic, settings_of(&plastic));
  } catch (const std::runtime_error &error) {
    why = error.what();
  }
  fault = Fault::none;
  check("crash in the first call", has(why, "segmentation fault") && has(why, "undeformed point"));
  for (const auto &[of, array] :
       {std::pair(Fault::beyond_state, "STATEV"), {Fault::beyond_stress, "STRESS"}}) {
    const UmatLaw writing(&plastic, settings_of(&plastic));
    LawPoint third(writing);
    fault = of;
    check(std::string("writing outside of ") + array,
          !third.evaluate(F, dt) && writing.refusal().is_final && has(writing.refusal().what, array));
    fault = Fault::none;
  }
  UserLawSettings soft = settings_of(&neo_hookean);
  soft.constants[1] = -1.;
  try {
    const UmatLaw failing(&neo_hookean, soft);
  } catch (const std::runtime_error &error) {
    why = error.what();
  }
  check("no stiffness", has(why, "shear modulus"));
}

/// Writes are found in the array that they belong to, and once.
void test_guards() {
  GuardedArrays arrays({6, 0, 3}, 100);
  check("guards are unchanged", !arrays.find_overrun());
  for (unsigned int i = 0; i < 3; ++i)
    arrays[2][i] = 7.;
  check("arrays may be written", !arrays.find_overrun() && arrays.size(2) == 3);
  arrays[0][6] = 0.;
  check("behind the first array", arrays.find_overrun() == 0U && !arrays.find_overrun());
  arrays[1][0] = 0.;
  check("in an empty array", arrays.find_overrun() == 1U);
  arrays[2][3 + 99] = 0.;
  check("far behind the last array", arrays.find_overrun() == 2U && arrays[2][2] == 7.);
}

/// A point of rubber that stiffens has a larger bound of explicit steps; other points have not, and it is
/// part of the state: a resumed run has the steps of the whole one.
void test_bound() {
  const UmatLaw umat(&neo_hookean, settings_of(&neo_hookean));
  LawPoint point(umat);
  const double before = umat.bound_stiffness({});
  const auto bound = [&umat](const LawPoint &of) { return umat.bound_stiffness_at(of.state().data(), {}); };
  check("bound at the start", std::abs(bound(point) / before - 1.), 1e-15);
  Tensor<2, 3> F;
  F[0][0] = 3.;
  F[1][1] = F[2][2] = 1. / std::sqrt(3.);
  AssertThrow(point.evaluate(F, dt), dealii::ExcInternalError());
  check("stiffening raises the bound", bound(point) > 1.5 * before);
  check("but not that of other points", std::abs(bound(LawPoint(umat)) / before - 1.), 1e-15);
  AssertThrow(point.evaluate(unit, dt), dealii::ExcInternalError());
  check("unloading lowers it", bound(point) < 1.01 * before);
}

void test_given_stress() {
  const UmatLaw umat(&plastic, settings_of(&plastic));
  const SharedLaw own = make_hypoelastic_law(steel, make_hardening(LinearHardening{700., 300.}));
  Random random;
  const Tensor<2, 3> F = unit + random.tensor(0.2);
  const SymmetricTensor<2, 3> deviator = 100. * dealii::deviator(symmetrize(random.tensor(1.)));
  LawPoint point(umat), other(*own);
  umat.set_stress(F, deviator, 0.125, point.state_n().data());
  own->set_stress(F, deviator, 0.125, other.state_n().data());
  check("given stress", (*point.evaluate(F, 0.) - *other.evaluate(F, 0.)).norm(), 1e-9);
  check("given plastic strain", std::abs(umat.equivalent_plastic_strain(point.state_n().data()) - 0.125), 0.);
}

void test_tangent_errors() {
  check("tangent check, J2", find_tangent_error(UmatLaw(&plastic, settings_of(&plastic)), dt, 0.).error,
        0.01);
  check("tangent check, neo-Hookean",
        find_tangent_error(UmatLaw(&neo_hookean, settings_of(&neo_hookean)), dt, 0.).error, 1e-3);
}

void test_utilities() {
  const double s[6] = {3., -1., 4., 1., -5., 9.};
  const int ndi = 3, nshr = 3, stress = 1, strain = 2;
  const SymmetricTensor<2, 3> S = tensor_of(s), E = tensor_of(s, 0.5);
  double mean = 0., mises = 0., values[3], directions[9], turned[6];
  sinv_(s, &mean, &mises, &ndi, &nshr);
  check("SINV", std::abs(mean - 2.) + std::abs(mises - std::sqrt(1.5) * dealii::deviator(S).norm()), 1e-13);
  sprinc_(s, values, &stress, &ndi, &nshr);
  check("SPRINC, trace and determinant",
        std::abs(values[0] + values[1] + values[2] - 6.) +
            std::abs(values[0] * values[1] * values[2] / determinant(S) - 1.),
        1e-12);
  sprind_(s, values, directions, &strain, &ndi, &nshr);
  WorstError error;
  for (unsigned int k = 0; k < 3; ++k) {
    const Tensor<1, 3> n({directions[k], directions[3 + k], directions[6 + k]});
    error.add((Tensor<2, 3>(E) * n - values[k] * n).norm() + std::abs(n.norm() - 1.));
  }
  check("SPRIND, strains", error.value(), 1e-12);
  const Tensor<2, 3> R = Random().rotation();
  double columns[9];
  for (unsigned int i = 0; i < 9; ++i)
    columns[i] = R[i % 3][i / 3];
  rotsig_(s, columns, turned, &stress, &ndi, &nshr);
  check("ROTSIG, stresses", (tensor_of(turned) - symmetrize(R * Tensor<2, 3>(S) * transpose(R))).norm(),
        1e-13);
  rotsig_(s, columns, turned, &strain, &ndi, &nshr);
  check("ROTSIG, strains", (tensor_of(turned, 0.5) - symmetrize(R * Tensor<2, 3>(E) * transpose(R))).norm(),
        1e-13);
}

} // namespace

BILLET_TEST(umat) {
  test_against_own_laws();
  test_rates();
  test_dissipation();
  test_arguments();
  test_refusals();
  test_guards();
  test_bound();
  test_given_stress();
  test_tangent_errors();
  test_utilities();
}

} // namespace umat_test
