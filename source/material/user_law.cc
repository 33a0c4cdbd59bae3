// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/user_law.h"

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

constexpr const char *plastic_strain_name = "equivalent plastic strain";

} // namespace

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

Tensor<2, 3> read_gradient(const double *numbers) {
  Tensor<2, 3> F;
  for (unsigned int i = 0; i < 9; ++i)
    F[i / 3][i % 3] = numbers[i];
  return F;
}

void write_gradient(const Tensor<2, 3> &F, double *numbers) {
  for (unsigned int i = 0; i < 9; ++i)
    numbers[i] = F[i / 3][i % 3];
}

SymmetricTensor<2, 3> multiply(const SpatialModuli &C, const SymmetricTensor<2, 3> &d) {
  SymmetricTensor<2, 3> result;
  for (unsigned int i = 0; i < 6; ++i)
    for (unsigned int j = 0; j < 6; ++j)
      result.access_raw_entry(i) += C[i][j] * (j < 3 ? 1. : 2.) * d.access_raw_entry(j);
  return result;
}

UserLaw::UserLaw(const char *const kind, UserLawSettings settings)
    : kind_(kind), settings_(std::move(settings)),
      title_(std::string(kind) + " '" + settings_.name + "' of library '" + settings_.library + "'") {
  const auto named =
      std::find(settings_.state_names.begin(), settings_.state_names.end(), plastic_strain_name);
  plastic_strain_ = n_own_state + (named != settings_.state_names.end()
                                       ? static_cast<std::size_t>(named - settings_.state_names.begin())
                                       : settings_.initial_state.size());
}

void UserLaw::set_initial(const SpatialModuli &C, const bool has_stored_energy) {
  initial_ = C;
  has_stored_energy_ = has_stored_energy;
  const double normal = C[0][0] + C[1][1] + C[2][2], coupled = C[0][1] + C[0][2] + C[1][2],
               sheared = C[3][3] + C[4][4] + C[5][5];
  elastic_ = {(normal + 2. * coupled) / 9., (normal - coupled + 3. * sheared) / 15.};
  if (!(elastic_.bulk > 0. && elastic_.shear > 0.))
    throw std::runtime_error(title_ + " has a bulk modulus of " + std::to_string(elastic_.bulk) +
                             " and a shear modulus of " + std::to_string(elastic_.shear) +
                             " at the undeformed point; both must be above 0");
  stiffness_ = bound_by_moduli(C, {});
}

void UserLaw::symmetrise(SpatialModuli &C) const {
  if (!settings_.has_symmetric_tangent)
    return;
  double lost = 0., size = 0.;
  for (unsigned int i = 0; i < 6; ++i)
    for (unsigned int j = 0; j < 6; ++j) {
      lost += (C[i][j] - C[j][i]) * (C[i][j] - C[j][i]);
      size += C[i][j] * C[i][j];
    }
  lost_asymmetry_ = lost > 0. ? std::sqrt(lost / size) : 0.;
  for (unsigned int i = 0; i < 6; ++i)
    for (unsigned int j = 0; j < i; ++j)
      C[i][j] = C[j][i] = 0.5 * (C[i][j] + C[j][i]);
}

double UserLaw::bound_moduli(const SpatialModuli &moduli, const double J) const {
  return std::max(stiffness_, J * bound_by_moduli(moduli, {}));
}

double UserLaw::bound_stiffness(const SymmetricTensor<2, 3> &tau) const {
  const double of_moduli = std::max(3. * elastic_.bulk, 2. * elastic_.shear);
  return PointLaw::bound_stiffness(tau) + std::max(0., stiffness_ - of_moduli);
}

double UserLaw::bound_stiffness_at(const double *const state, const SymmetricTensor<2, 3> &tau) const {
  return bound_stiffness(tau) + state[bound] - stiffness_;
}

std::vector<StateField> UserLaw::fields() const {
  std::vector<StateField> result = {tensor_field("deformation gradient"),
                                    symmetric_field("stress"),
                                    symmetric_field("strain"),
                                    {"energies", 4, {"elastic", "plastic", "creep", "work"}},
                                    {"clock", 3, {"time", "temperature", "increments"}},
                                    {"bound of moduli", 1}};
  for (const std::string &name : settings_.state_names)
    result.push_back({name, 1});
  if (settings_.state_names.empty() && !settings_.initial_state.empty())
    result.push_back({"state variables", settings_.initial_state.size()});
  return result;
}

void UserLaw::initialize(double *state) const {
  std::fill_n(state, n_own_state, 0.);
  write_gradient(dealii::unit_symmetric_tensor<3>(), state);
  state[bound] = stiffness_;
  std::copy(settings_.initial_state.begin(), settings_.initial_state.end(), state + n_own_state);
}

double UserLaw::stored_energy(const Tensor<2, 3> &, double, const double *state) const {
  return has_stored_energy_ ? state[energies] : state[work] - dissipated_energy(state);
}

double UserLaw::dissipated_energy(const double *state) const {
  const double computed = state[energies + 1] + state[energies + 2];
  return computed != 0. || !has_stored_energy_ ? computed : state[work] - state[energies];
}

double UserLaw::equivalent_plastic_strain(const double *state) const {
  return plastic_strain_ < n_state() ? state[plastic_strain_] : 0.;
}

void UserLaw::set_stress(const Tensor<2, 3> &F, const SymmetricTensor<2, 3> &deviator,
                         const double equivalent_plastic_strain, double *state) const {
  const double J = dealii::determinant(F);
  write_gradient(F, state);
  const Tensor<2, 3> to_frame = dealii::transpose(frame(F));
  const SymmetricTensor<2, 3> tau =
      deviator + elastic_.bulk * std::log(J) * dealii::unit_symmetric_tensor<3>();
  write_tensor(turn(to_frame, tau) / J, state + Place::stress);
  PrincipalElasticState principal;
  SymmetricTensor<2, 3> log_strain;
  if (compute_principal_state(dealii::symmetrize(F * dealii::transpose(F)), principal))
    for (unsigned int a = 0; a < 3; ++a)
      log_strain += (principal.deviatoric_log_strains[a] + principal.volumetric_log_strain / 3.) *
                    dealii::symmetrize(outer_product(principal.directions[a], principal.directions[a]));
  write_tensor(turn(to_frame, log_strain), state + Place::strain);
  if (plastic_strain_ < n_state())
    state[plastic_strain_] = equivalent_plastic_strain;
  Matrix6 C; // the initial moduli
  for (unsigned int i = 0; i < 6; ++i)
    for (unsigned int j = 0; j < 6; ++j)
      C[i][j] = initial_[i][j] * (i < 3 ? 1. : std::sqrt(2.)) * (j < 3 ? 1. : std::sqrt(2.));
  const Vector6 kelvin = to_kelvin(tau);
  state[work] = 0.5 * dot(kelvin, LinearSystem6(C).solve(kelvin));
  if (has_stored_energy_)
    state[energies] = state[work];
}

std::vector<double> UserLaw::memory(const Tensor<2, 3> &, const double *const state) const {
  return {state + energies, state + n_state()};
}

void UserLaw::remember(const Tensor<2, 3> &, const std::vector<double> &memory, double *const state) const {
  std::copy(memory.begin(), memory.end(), state + energies);
}

Tensor<2, 3> UserLaw::frame(const Tensor<2, 3> &) const { return dealii::unit_symmetric_tensor<3>(); }

void write_name(const std::string &name, char (&target)[80]) {
  std::fill(std::begin(target), std::end(target), ' ');
  std::copy_n(name.begin(), std::min(name.size(), sizeof target), target);
}

bool UserLaw::refuse(const std::string &what, const bool is_final) const {
  refusal_ = {title_ + " " + what, is_final};
  return false;
}

bool UserLaw::call(void (*const function)(void *), void *const data) const {
  if (refusal_.is_final) // a crash may have damaged its data
    return false;
  const CallResult result = call_guarded(function, data, title_.c_str());
  return result.end == CallEnd::returned || refuse(result.describe(), true);
}

bool UserLaw::check(const double *const numbers, const std::size_t n, const std::string &what,
                    const std::string &name) const {
  return std::all_of(numbers, numbers + n, [](const double x) { return std::isfinite(x); }) ||
         refuse("returned " + what + " that is not a number (" + name + ")");
}

bool UserLaw::check_guards(GuardedArrays &arrays, const char *const *const names) const {
  const auto overrun = arrays.find_overrun();
  return !overrun || refuse(std::string("wrote outside of the array ") + names[*overrun] + ", which has " +
                                std::to_string(arrays.size(*overrun)) + " numbers",
                            true);
}

void UserLaw::accept() const {
  if (!refusal_.what.empty())
    refusal_ = {};
}

const UserSubroutine *find_user_subroutine(const PointLaw &law) {
  return dynamic_cast<const UserSubroutine *>(&law);
}

} // namespace billet
