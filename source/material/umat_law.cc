// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/umat_law.h"

#include "billet/material/hypoelastic.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

namespace {

constexpr unsigned int umat_rows[6] = {0, 1, 2, 0, 0, 1}, umat_columns[6] = {0, 1, 2, 1, 2, 2};

/// Writes a strain with engineering shears.
void write_strain(const SymmetricTensor<2, 3> &tensor, double *numbers) {
  for (unsigned int i = 0; i < 6; ++i)
    numbers[i] = (i < 3 ? 1. : 2.) * tensor.access_raw_entry(i);
}

void write_columns(const Tensor<2, 3> &A, double *numbers) {
  for (unsigned int i = 0; i < 9; ++i)
    numbers[i] = A[i % 3][i / 3];
}

} // namespace

SpatialModuli moduli_of_jaumann(const SpatialModuli &C, const double J, const SymmetricTensor<2, 3> &tau) {
  SpatialModuli c;
  for (unsigned int r = 0; r < 6; ++r)
    for (unsigned int s = 0; s < 6; ++s) {
      const unsigned int i = umat_rows[r], j = umat_columns[r], k = umat_rows[s], l = umat_columns[s];
      const double H = 0.5 * ((i == k ? tau[j][l] : 0.) + (i == l ? tau[j][k] : 0.) +
                              (j == k ? tau[i][l] : 0.) + (j == l ? tau[i][k] : 0.));
      c[r][s] = J * C[r][s] - H;
    }
  return c;
}

/// Arguments of a UMAT.
struct UmatLaw::Call {
  /// Input and output.
  struct Response {
    double sse, spd, scd, pnewdt = 1.;
  };
  struct Motion {
    double stran[6], dstran[6], drot[9], dfgrd0[9], dfgrd1[9];
  };
  struct Instant {
    double time[2], dtime, temp, dtemp;
    int kinc;
  };
  /// Arguments that this program has no use for.
  struct Unused {
    double rpl = 0., ddsddt[6] = {}, drplde[6] = {}, drpldt = 0., predef[1] = {}, dpred[1] = {},
           coords[3] = {};
    int one = 1, jstep[4] = {1, 1, 1, 0}; // JSTEP: a static step with NLGEOM
  };

  /// Arrays of the law that the UMAT may write to.
  enum Array { stress, ddsdde, props, statev };
  static constexpr const char *names[] = {"STRESS (NTENS)", "DDSDDE (NTENS by NTENS)", "PROPS (NPROPS)",
                                          "STATEV (NSTATV, 'State variables')"};
  static std::vector<std::size_t> sizes(const UserLawSettings &settings) {
    return {6, 36, settings.constants.size(), settings.initial_state.size()};
  }
  static constexpr std::size_t n_guards_behind = 512;

  UmatFunction *function = nullptr;
  GuardedArrays *arrays = nullptr;
  Response response;
  Motion motion;
  Instant instant;
  Unused unused;
  double celent = 1.;
  char cmname[80];
  int nstatv = 0, nprops = 0;

  /// Performs the call, for call_guarded().
  static void perform(void *const data) {
    Call &c = *static_cast<Call *>(data);
    Response &r = c.response;
    Motion &m = c.motion;
    Instant &i = c.instant;
    Unused &u = c.unused;
    GuardedArrays &a = *c.arrays;
    int ndi = 3, nshr = 3, ntens = 6;
    c.function(a[stress], a[statev], a[ddsdde], &r.sse, &r.spd, &r.scd, &u.rpl, u.ddsddt, u.drplde, &u.drpldt,
               m.stran, m.dstran, i.time, &i.dtime, &i.temp, &i.dtemp, u.predef, u.dpred, c.cmname, &ndi,
               &nshr, &ntens, &c.nstatv, a[props], &c.nprops, u.coords, m.drot, &r.pnewdt, &c.celent,
               m.dfgrd0, m.dfgrd1, &u.one, &u.one, &u.one, &u.one, u.jstep, &i.kinc, sizeof c.cmname);
  }

  /// Sets what follows from the start of the step, and its end.
  void begin(const UmatLaw &law, const double *state_n, const Tensor<2, 3> &F,
             const MidpointIncrement &increment, const PointStep &step) {
    function = law.function_;
    arrays = law.arrays_.get();
    std::copy(law.settings().constants.begin(), law.settings().constants.end(), (*arrays)[props]);
    std::copy_n(state_n + n_own_state, arrays->size(statev), (*arrays)[statev]);
    std::fill_n((*arrays)[ddsdde], 36, 0.);
    nstatv = static_cast<int>(law.settings().initial_state.size());
    nprops = static_cast<int>(law.settings().constants.size());
    celent = law.settings().element_length;
    write_name(law.settings().name, cmname);
    write_tensor(turn(increment.rotation, read_tensor(state_n + Place::stress)), (*arrays)[stress]);
    response.sse = state_n[energies];
    response.spd = state_n[energies + 1];
    response.scd = state_n[energies + 2];
    write_strain(turn(increment.rotation, read_tensor(state_n + Place::strain)), motion.stran);
    write_strain(dealii::symmetrize(increment.gradient), motion.dstran);
    write_columns(increment.rotation, motion.drot);
    write_columns(read_gradient(state_n), motion.dfgrd0);
    write_columns(F, motion.dfgrd1);
    instant.time[0] = instant.time[1] = state_n[Place::time];
    instant.dtime = step.dt;
    instant.temp = state_n[increments] > 0. ? state_n[Place::temperature] : step.temperature;
    instant.dtemp = step.temperature - instant.temp;
    instant.kinc = 1 + static_cast<int>(std::min(state_n[increments], 2e9));
  }

  SpatialModuli tangent(const UmatLaw &law) const {
    const double *const C = (*arrays)[ddsdde];
    SpatialModuli moduli;
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int j = 0; j < 6; ++j)
        moduli[i][j] = C[6 * j + i];
    law.symmetrise(moduli);
    return moduli;
  }
};

UmatLaw::UmatLaw(UmatFunction *const function, UserLawSettings settings)
    : UserLaw(law_name, std::move(settings)), function_(function),
      arrays_(std::make_unique<GuardedArrays>(Call::sizes(this->settings()), Call::n_guards_behind)) {
  std::vector<double> state_n(n_state());
  initialize(state_n.data());
  const auto probe = [&](const double size) {
    Tensor<2, 3> F = dealii::unit_symmetric_tensor<3>();
    F[0][0] += size;
    F[1][1] -= size;
    MidpointIncrement increment;
    compute_increment(read_gradient(state_n.data()), F, increment);
    PointStep step;
    step.dt = probe_time;
    Call call;
    call.begin(*this, state_n.data(), F, increment, step);
    if (!perform(call))
      throw std::runtime_error(refusal().what + " at the undeformed point");
    return call;
  };
  const SpatialModuli C = probe(0.).tangent(*this);
  set_initial(C, probe(probe_strain).response.sse != 0.);
}

bool UmatLaw::perform(Call &call) const {
  if (!UserLaw::call(&Call::perform, &call) || !check_guards(*arrays_, Call::names))
    return false;
  if (!(call.response.pnewdt >= 1.))
    return refuse("asks for a shorter step (PNEWDT = " + std::to_string(call.response.pnewdt) + ")");
  const GuardedArrays &arrays = *arrays_;
  if (!check(arrays[Call::stress], 6, "a stress", "STRESS") ||
      !check(arrays[Call::ddsdde], 36, "a tangent", "DDSDDE") ||
      !check(arrays[Call::statev], arrays.size(Call::statev), "a state variable", "STATEV") ||
      !check(&call.response.sse, 1, "an energy", "SSE") ||
      !check(&call.response.spd, 1, "an energy", "SPD") || !check(&call.response.scd, 1, "an energy", "SCD"))
    return false;
  accept();
  return true;
}

bool UmatLaw::update_at_rest(const Tensor<2, 3> &F, const double *state_n, double *state,
                             SymmetricTensor<2, 3> &tau, SpatialModuli *moduli) const {
  const double J = dealii::determinant(F);
  const Tensor<2, 3> F_n = read_gradient(state_n);
  SymmetricTensor<2, 3> sigma = read_tensor(state_n + Place::stress);
  if (F != F_n) { // up to an elastic change
    MidpointIncrement increment;
    if (!compute_increment(F_n, F, increment))
      return false;
    sigma =
        turn(increment.rotation, sigma) + multiply(initial_moduli(), dealii::symmetrize(increment.gradient));
  }
  std::copy_n(state_n, n_state(), state);
  write_gradient(F, state);
  write_tensor(sigma, state + Place::stress);
  tau = J * sigma;
  if (moduli != nullptr)
    *moduli = moduli_of_jaumann(initial_moduli(), J, tau);
  return true;
}

bool UmatLaw::update(const Tensor<2, 3> &F, double, const PointStep &step, const double *state_n,
                     double *state, SymmetricTensor<2, 3> &tau, SpatialModuli *moduli) const {
  const double J = dealii::determinant(F);
  if (!(J > 0.) || !std::isfinite(F.norm()))
    return false;
  if (step.dt == 0.)
    return update_at_rest(F, state_n, state, tau, moduli);
  MidpointIncrement increment;
  if (!compute_increment(read_gradient(state_n), F, increment))
    return false;
  Call call;
  call.begin(*this, state_n, F, increment, step);
  SymmetricTensor<2, 3> strain_n;
  for (unsigned int i = 0; i < 6; ++i)
    strain_n.access_raw_entry(i) = (i < 3 ? 1. : 0.5) * call.motion.stran[i];
  const SymmetricTensor<2, 3> change = dealii::symmetrize(increment.gradient),
                              turned = read_tensor((*arrays_)[Call::stress]);
  if (!perform(call))
    return false;
  const SymmetricTensor<2, 3> sigma = read_tensor((*arrays_)[Call::stress]);
  tau = J * sigma;
  write_gradient(F, state);
  write_tensor(sigma, state + Place::stress);
  write_tensor(strain_n + change, state + Place::strain);
  state[energies] = call.response.sse;
  state[energies + 1] = call.response.spd;
  state[energies + 2] = call.response.scd;
  state[work] = state_n[work] + 0.5 * ((dealii::determinant(read_gradient(state_n)) * turned + tau) * change);
  state[Place::time] = state_n[Place::time] + step.dt;
  state[Place::temperature] = step.temperature;
  state[increments] = state_n[increments] + 1.;
  std::copy_n((*arrays_)[Call::statev], arrays_->size(Call::statev), state + n_own_state);
  const SpatialModuli tangent = call.tangent(*this);
  state[bound] = bound_moduli(tangent, J);
  if (moduli != nullptr)
    *moduli = moduli_of_jaumann(tangent, J, tau);
  return true;
}

} // namespace billet
