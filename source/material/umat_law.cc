// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/umat_law.h"

#include "billet/material/guarded_call.h"
#include "billet/material/hencky.h"
#include "billet/material/hypoelastic.h"
#include "billet/material/log_map.h"
#include "billet/material/state_fields.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

namespace {

constexpr unsigned int rows[6] = {0, 1, 2, 0, 0, 1}, columns[6] = {0, 1, 2, 1, 2, 2};
constexpr const char *plastic_strain_name = "equivalent plastic strain";

/// Places in the state of a point, before those of STATEV.
enum Place : std::size_t {
  gradient = 0,
  stress = 9,
  strain = 15,
  energies = 21, // SSE, SPD, SCD
  work = 24,
  time = 25,
  temperature = 26,
  increments = 27
};

Tensor<2, 3> read_gradient(const double *state) {
  Tensor<2, 3> F;
  for (unsigned int i = 0; i < 9; ++i)
    F[i / 3][i % 3] = state[gradient + i];
  return F;
}

void write_gradient(const Tensor<2, 3> &F, double *state) {
  for (unsigned int i = 0; i < 9; ++i)
    state[gradient + i] = F[i / 3][i % 3];
}

SymmetricTensor<2, 3> read_tensor(const double *numbers) {
  SymmetricTensor<2, 3> result;
  for (unsigned int i = 0; i < 6; ++i)
    result.access_raw_entry(i) = numbers[i];
  return result;
}

void write_tensor(const SymmetricTensor<2, 3> &tensor, double *numbers) {
  for (unsigned int i = 0; i < 6; ++i)
    numbers[i] = tensor.access_raw_entry(i);
}

/// Writes a strain with engineering shears.
void write_strain(const SymmetricTensor<2, 3> &tensor, double *numbers) {
  for (unsigned int i = 0; i < 6; ++i)
    numbers[i] = (i < 3 ? 1. : 2.) * tensor.access_raw_entry(i);
}

void write_columns(const Tensor<2, 3> &A, double *numbers) {
  for (unsigned int i = 0; i < 9; ++i)
    numbers[i] = A[i % 3][i / 3];
}

SymmetricTensor<2, 3> turn(const Tensor<2, 3> &R, const SymmetricTensor<2, 3> &s) {
  return dealii::symmetrize(R * static_cast<Tensor<2, 3>>(s) * dealii::transpose(R));
}

SymmetricTensor<2, 3> multiply(const SpatialModuli &C, const SymmetricTensor<2, 3> &d) {
  SymmetricTensor<2, 3> result;
  for (unsigned int i = 0; i < 6; ++i)
    for (unsigned int j = 0; j < 6; ++j)
      result.access_raw_entry(i) += C[i][j] * (j < 3 ? 1. : 2.) * d.access_raw_entry(j);
  return result;
}

template <class Numbers> bool are_finite(const Numbers &numbers) {
  return std::all_of(std::begin(numbers), std::end(numbers), [](const double x) { return std::isfinite(x); });
}

} // namespace

SpatialModuli moduli_of_jaumann(const SpatialModuli &C, const double J, const SymmetricTensor<2, 3> &tau) {
  SpatialModuli c;
  for (unsigned int r = 0; r < 6; ++r)
    for (unsigned int s = 0; s < 6; ++s) {
      const unsigned int i = rows[r], j = columns[r], k = rows[s], l = columns[s];
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
    double stress[6], ddsdde[36] = {}, sse, spd, scd, pnewdt = 1.;
  };
  struct Motion {
    double stran[6], dstran[6], drot[9], dfgrd0[9], dfgrd1[9];
  };
  struct Instant {
    double time[2], dtime, temp, dtemp;
    int kinc;
  };
  /// What this program has no use for.
  struct Unused {
    double rpl = 0., ddsddt[6] = {}, drplde[6] = {}, drpldt = 0., predef[1] = {}, dpred[1] = {},
           coords[3] = {};
    int one = 1, jstep[4] = {1, 1, 1, 0}; // JSTEP: a static step with NLGEOM
  };

  UmatSettings *settings = nullptr;
  Response response;
  Motion motion;
  Instant instant;
  Unused unused;
  double *statev = nullptr;
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
    int ndi = 3, nshr = 3, ntens = 6;
    c.settings->function(r.stress, c.statev, r.ddsdde, &r.sse, &r.spd, &r.scd, &u.rpl, u.ddsddt, u.drplde,
                         &u.drpldt, m.stran, m.dstran, i.time, &i.dtime, &i.temp, &i.dtemp, u.predef, u.dpred,
                         c.cmname, &ndi, &nshr, &ntens, &c.nstatv, c.settings->constants.data(), &c.nprops,
                         u.coords, m.drot, &r.pnewdt, &c.celent, m.dfgrd0, m.dfgrd1, &u.one, &u.one, &u.one,
                         &u.one, u.jstep, &i.kinc, sizeof c.cmname);
  }

  /// Sets what follows from the start of the step, and its end. `variables` is STATEV of the start.
  void begin(const UmatSettings &of, const double *state_n, double *variables, const Tensor<2, 3> &F,
             const MidpointIncrement &increment, const PointStep &step) {
    settings = const_cast<UmatSettings *>(&of); // Fortran has no const; UMATs do not change PROPS
    statev = variables;
    nstatv = static_cast<int>(of.initial_state.size());
    nprops = static_cast<int>(of.constants.size());
    celent = of.element_length;
    std::fill(std::begin(cmname), std::end(cmname), ' ');
    std::copy_n(of.name.begin(), std::min(of.name.size(), sizeof cmname), cmname);
    write_tensor(turn(increment.rotation, read_tensor(state_n + Place::stress)), response.stress);
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

  SpatialModuli tangent(const bool is_symmetric) const {
    const double *const C = response.ddsdde;
    SpatialModuli moduli;
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int j = 0; j < 6; ++j)
        moduli[i][j] = is_symmetric ? 0.5 * (C[6 * j + i] + C[6 * i + j]) : C[6 * j + i];
    return moduli;
  }
};

UmatLaw::UmatLaw(UmatSettings settings) : settings_(std::move(settings)) {
  title_ = "UMAT '" + settings_.name + "' of library '" + settings_.library + "'";
  const auto named =
      std::find(settings_.state_names.begin(), settings_.state_names.end(), plastic_strain_name);
  plastic_strain_ = n_own_state + (named != settings_.state_names.end()
                                       ? static_cast<std::size_t>(named - settings_.state_names.begin())
                                       : settings_.initial_state.size());
  find_initial_moduli();
}

void UmatLaw::find_initial_moduli() {
  constexpr double small = 1e-6; // strain of the probe for SSE
  std::vector<double> state_n(n_state()), state(n_state());
  initialize(state_n.data());
  const auto probe = [&](const double size) {
    Tensor<2, 3> F = dealii::unit_symmetric_tensor<3>();
    F[0][0] += size;
    F[1][1] -= size;
    MidpointIncrement increment;
    compute_increment(read_gradient(state_n.data()), F, increment);
    state = state_n;
    PointStep step;
    step.dt = probe_time;
    Call call;
    call.begin(settings_, state_n.data(), state.data() + n_own_state, F, increment, step);
    if (!perform(call))
      throw std::runtime_error(refusal_.what + " at the undeformed point");
    return call;
  };
  const Call at_rest = probe(0.);
  const SpatialModuli C = initial_ = at_rest.tangent(settings_.has_symmetric_tangent);
  const double normal = C[0][0] + C[1][1] + C[2][2], coupled = C[0][1] + C[0][2] + C[1][2],
               sheared = C[3][3] + C[4][4] + C[5][5];
  elastic_ = {(normal + 2. * coupled) / 9., (normal - coupled + 3. * sheared) / 15.};
  if (!(elastic_.bulk > 0. && elastic_.shear > 0.))
    throw std::runtime_error(title_ + " has a bulk modulus of " + std::to_string(elastic_.bulk) +
                             " and a shear modulus of " + std::to_string(elastic_.shear) +
                             " by its DDSDDE at the undeformed point; both must be above 0");
  for (unsigned int i = 0; i < 6; ++i) { // Gershgorin's bound, in Kelvin's notation
    double sum = 0.;
    for (unsigned int j = 0; j < 6; ++j)
      sum += std::abs(C[i][j]) * (i < 3 ? 1. : std::sqrt(2.)) * (j < 3 ? 1. : std::sqrt(2.));
    stiffness_ = std::max(stiffness_, sum);
  }
  has_stored_energy_ = probe(small).response.sse != 0.;
}

double UmatLaw::bound_stiffness(const SymmetricTensor<2, 3> &tau) const {
  const double of_moduli = std::max(3. * elastic_.bulk, 2. * elastic_.shear);
  return PointLaw::bound_stiffness(tau) + std::max(0., stiffness_ - of_moduli);
}

std::vector<StateField> UmatLaw::fields() const {
  std::vector<StateField> result = {tensor_field("deformation gradient"),
                                    symmetric_field("Cauchy stress"),
                                    symmetric_field("strain"),
                                    {"energies", 4, {"elastic", "plastic", "creep", "work"}},
                                    {"clock", 3, {"time", "temperature", "increments"}}};
  for (const std::string &name : settings_.state_names)
    result.push_back({name, 1});
  if (settings_.state_names.empty() && !settings_.initial_state.empty())
    result.push_back({"state variables", settings_.initial_state.size()});
  return result;
}

void UmatLaw::initialize(double *state) const {
  std::fill_n(state, n_own_state, 0.);
  write_gradient(dealii::unit_symmetric_tensor<3>(), state);
  std::copy(settings_.initial_state.begin(), settings_.initial_state.end(), state + n_own_state);
}

double UmatLaw::stored_energy(const double *state) const {
  if (has_stored_energy_)
    return state[energies];
  const SymmetricTensor<2, 3> tau =
      dealii::determinant(read_gradient(state)) * read_tensor(state + Place::stress);
  Matrix6 C;
  for (unsigned int i = 0; i < 6; ++i)
    for (unsigned int j = 0; j < 6; ++j)
      C[i][j] = initial_[i][j] * (i < 3 ? 1. : std::sqrt(2.)) * (j < 3 ? 1. : std::sqrt(2.));
  const Vector6 kelvin = to_kelvin(tau);
  return 0.5 * dot(kelvin, LinearSystem6(C).solve(kelvin));
}

double UmatLaw::stored_energy(const Tensor<2, 3> &, double, const double *state) const {
  return stored_energy(state);
}

double UmatLaw::dissipated_energy(const double *state) const {
  const double computed = state[energies + 1] + state[energies + 2];
  return has_stored_energy_ && computed != 0. ? computed : state[work] - stored_energy(state);
}

double UmatLaw::equivalent_plastic_strain(const double *state) const {
  return plastic_strain_ < n_state() ? state[plastic_strain_] : 0.;
}

void UmatLaw::set_stress(const Tensor<2, 3> &F, const SymmetricTensor<2, 3> &deviator,
                         const double equivalent_plastic_strain, double *state) const {
  const double J = dealii::determinant(F);
  write_gradient(F, state);
  write_tensor((deviator + elastic_.bulk * std::log(J) * dealii::unit_symmetric_tensor<3>()) / J,
               state + Place::stress);
  PrincipalElasticState principal;
  SymmetricTensor<2, 3> log_strain;
  if (compute_principal_state(dealii::symmetrize(F * dealii::transpose(F)), principal))
    for (unsigned int a = 0; a < 3; ++a)
      log_strain += (principal.deviatoric_log_strains[a] + principal.volumetric_log_strain / 3.) *
                    dealii::symmetrize(outer_product(principal.directions[a], principal.directions[a]));
  write_tensor(log_strain, state + Place::strain);
  if (plastic_strain_ < n_state())
    state[plastic_strain_] = equivalent_plastic_strain;
  state[work] = stored_energy(state);
}

bool UmatLaw::refuse(const std::string &what, const bool is_final) const {
  refusal_ = {title_ + " " + what, is_final};
  return false;
}

bool UmatLaw::perform(Call &call) const {
  if (refusal_.is_final) // a crash may have damaged its data
    return false;
  const CallResult result = call_guarded(&Call::perform, &call, title_.c_str());
  if (result.end != CallEnd::returned)
    return refuse(result.describe(), true);
  if (!(call.response.pnewdt >= 1.))
    return refuse("asks for a shorter step (PNEWDT = " + std::to_string(call.response.pnewdt) + ")");
  if (!are_finite(call.response.stress))
    return refuse("returned a stress that is not a number (STRESS)");
  if (!are_finite(call.response.ddsdde))
    return refuse("returned a tangent that is not a number (DDSDDE)");
  if (!std::all_of(call.statev, call.statev + call.nstatv, [](const double x) { return std::isfinite(x); }))
    return refuse("returned a state variable that is not a number (STATEV)");
  if (!refusal_.what.empty())
    refusal_ = {};
  return true;
}

bool UmatLaw::update_at_rest(const Tensor<2, 3> &F, const double *state_n, double *state,
                             SymmetricTensor<2, 3> &tau, SpatialModuli *moduli) const {
  MidpointIncrement increment;
  if (!compute_increment(read_gradient(state_n), F, increment))
    return false;
  const double J = dealii::determinant(F);
  const SymmetricTensor<2, 3> change = multiply(initial_, dealii::symmetrize(increment.gradient)),
                              sigma = turn(increment.rotation, read_tensor(state_n + Place::stress)) + change;
  std::copy_n(state_n, n_state(), state);
  write_gradient(F, state);
  write_tensor(sigma, state + Place::stress);
  tau = J * sigma;
  if (moduli != nullptr)
    *moduli = moduli_of_jaumann(initial_, J, tau);
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
  std::copy_n(state_n + n_own_state, settings_.initial_state.size(), state + n_own_state);
  Call call;
  call.begin(settings_, state_n, state + n_own_state, F, increment, step);
  SymmetricTensor<2, 3> strain_n;
  for (unsigned int i = 0; i < 6; ++i)
    strain_n.access_raw_entry(i) = (i < 3 ? 1. : 0.5) * call.motion.stran[i];
  const SymmetricTensor<2, 3> change = dealii::symmetrize(increment.gradient),
                              turned = read_tensor(call.response.stress);
  if (!perform(call))
    return false;
  const SymmetricTensor<2, 3> sigma = read_tensor(call.response.stress);
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
  if (moduli != nullptr)
    *moduli = moduli_of_jaumann(call.tangent(settings_.has_symmetric_tangent), J, tau);
  return true;
}

} // namespace billet
