// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/hyperelastic.h"

#include "billet/material/drucker.h"
#include "billet/material/stability.h"
#include "billet/material/viscoelastic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

bool HyperelasticLaw::respond(const Tensor<2, 3> &F, HyperelasticState &state) const {
  state.J = dealii::determinant(F);
  if (!(state.J > 0.) || !std::isfinite(state.J) ||
      !compute_principal_state(dealii::symmetrize(F * dealii::transpose(F)), state.principal))
    return false;
  state.mean_stress = volumetric_.mean_stress(state.J);
  state.volumetric_slope = volumetric_.slope(state.J);
  state.response = isochoric_->respond(state.principal.deviatoric_log_strains);
  auto &t = state.response.stress;
  const double mean = (t[0] + t[1] + t[2]) / 3.;
  bool is_finite = std::isfinite(state.mean_stress);
  for (double &stress : t) {
    stress -= mean;
    is_finite = is_finite && std::isfinite(stress);
  }
  return is_finite;
}

SymmetricTensor<2, 3> compute_hyperelastic_stress(const HyperelasticState &state, const double share) {
  PrincipalResponse response;
  for (unsigned int a = 0; a < 3; ++a)
    response.stress[a] = state.mean_stress + share * state.response.stress[a];
  return compute_kirchhoff_stress(state.principal, response);
}

void compute_hyperelastic_moduli(const HyperelasticState &state, const double share, SpatialModuli &moduli) {
  const auto &n = state.principal.directions;
  const auto &H = state.response.slope;
  for (auto &row : moduli)
    row.fill(0.);
  const auto add = [&](const double factor, const std::array<double, 6> &v, const std::array<double, 6> &w) {
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int j = 0; j < 6; ++j)
        moduli[i][j] += factor * v[i] * w[j];
  };
  std::array<double, 3> row_means{};
  for (unsigned int a = 0; a < 3; ++a)
    row_means[a] = (H[a][0] + H[a][1] + H[a][2]) / 3.;
  const double mean = (row_means[0] + row_means[1] + row_means[2]) / 3.;
  std::array<double, 3> tau{};
  std::array<std::array<double, 6>, 3> m{};
  for (unsigned int a = 0; a < 3; ++a) {
    tau[a] = state.mean_stress + share * state.response.stress[a];
    m[a] = symmetric_dyad(n[a], n[a]);
  }
  for (unsigned int a = 0; a < 3; ++a)
    for (unsigned int b = 0; b < 3; ++b)
      add(state.volumetric_slope + share * (H[a][b] - row_means[a] - row_means[b] + mean) -
              (a == b ? 2. * tau[a] : 0.),
          m[a], m[b]);
  for (unsigned int k = 0; k < 3; ++k) {
    const auto [a, b] = principal_pairs[k];
    const auto s = symmetric_dyad(n[a], n[b]);
    add(4. * (share * state.response.shear[k] - tau[b]), s, s);
  }
}

std::string HyperelasticLaw::summary() const {
  const std::string stability = describe_stability(*isochoric_);
  return PointLaw::summary() + (stability.empty() ? "" : ", " + stability);
}

bool HyperelasticLaw::update(const Tensor<2, 3> &F, double, const PointStep &, const double *, double *,
                             SymmetricTensor<2, 3> &tau, SpatialModuli *moduli) const {
  HyperelasticState state;
  if (!respond(F, state))
    return false;
  tau = compute_hyperelastic_stress(state);
  if (moduli != nullptr)
    compute_hyperelastic_moduli(state, 1., *moduli);
  return true;
}

double HyperelasticLaw::stored_energy(const Tensor<2, 3> &F, double, const double *) const {
  PrincipalElasticState principal;
  if (!compute_principal_state(dealii::symmetrize(F * dealii::transpose(F)), principal))
    return 0.;
  return isochoric_->energy(principal.deviatoric_log_strains) + volumetric_.energy(dealii::determinant(F));
}

double HyperelasticLaw::bound_stiffness(const SymmetricTensor<2, 3> &tau) const {
  // t_max − t_min is at most 2/√3 of von Mises' stress.
  const double mean = dealii::trace(tau) / 3., mises = std::sqrt(1.5) * dealii::deviator(tau).norm();
  return std::max(3. * volumetric_.bound_slope(mean),
                  2. * moduli_.shear + isochoric_->growth() * (2. / std::sqrt(3.)) * mises) +
         4. * std::abs(mean) + 3. * mises;
}

namespace {

/// The law as min_wave_stiffness() needs it.
struct LawOfStability {
  struct History {};
  const HyperelasticLaw &law;

  bool update(const Tensor<2, 3> &F, const History &, History &, SymmetricTensor<2, 3> &tau,
              SpatialModuli *moduli) const {
    return law.update(F, 1., {}, nullptr, nullptr, tau, moduli);
  }
};

/// Elasticity that is one elastic law: no plasticity.
class ElasticLawAlone final : public Elasticity {
public:
  ElasticLawAlone(SharedLaw law, const double young) : law_(std::move(law)), young_(young) {}

  const ElasticModuli &moduli() const override { return law_->elastic(); }
  double young_modulus() const override { return young_; }
  SharedLaw make_elastic_law() const override { return law_; }
  SharedLaw make_plastic_law(SharedFlow) const override { return nullptr; }

private:
  SharedLaw law_;
  double young_;
};

constexpr const char *bulk_key = "Bulk modulus", *poisson_key = "Poisson ratio";
constexpr double greatest_poisson_ratio = 0.49999;

std::vector<TypeParameter> volumetric_parameters() {
  using Kind = TypeParameter::Kind;
  return {{bulk_key, "0", Kind::number, "K > 0. Bulk modulus; or give 'Poisson ratio'. [stress]"},
          {poisson_key, "0.3", Kind::number, "-1 < nu < 0.5. Poisson's ratio."}};
}

VolumetricEnergy read_volumetric_energy(const TypeInput &input, const double shear) {
  const VolumetricLawType *type = volumetric_law_types().find(input.text(volumetric_law_key));
  if (type == nullptr) // the selection has refused all other names
    throw std::logic_error("unknown type '" + input.text(volumetric_law_key) + "'");
  if (input.is_set(bulk_key) == input.is_set(poisson_key))
    input.reject(bulk_key, "a bulk modulus, or else a 'Poisson ratio': exactly one of them");
  const auto bulk_at = [shear](const double poisson) {
    return 2. * shear * (1. + poisson) / (3. * (1. - 2. * poisson));
  };
  if (input.is_set(bulk_key)) {
    constexpr double rounding = 1e-9;
    const double bulk = input.positive(bulk_key), most = bulk_at(greatest_poisson_ratio);
    if (!(bulk <= most * (1. + rounding)))
      input.reject(bulk_key, "a number up to " + std::to_string(most) +
                                 ", at which Poisson's ratio is 0.49999: rubber has a finite bulk modulus");
    return {type->make(input), bulk};
  }
  const double poisson = input.number(poisson_key);
  if (!(poisson > -1. && poisson <= greatest_poisson_ratio))
    input.reject(poisson_key, "a number > -1 and <= 0.49999: rubber has a finite bulk modulus");
  return {type->make(input), bulk_at(poisson)};
}

} // namespace

std::optional<double> HyperelasticLaw::min_wave_stiffness(const std::array<double, 3> &stretches) const {
  return billet::min_wave_stiffness(LawOfStability{*this}, moduli_.shear, stretches);
}

std::shared_ptr<const Elasticity> make_elasticity(SharedLaw law, const double young) {
  return std::make_shared<const ElasticLawAlone>(std::move(law), young);
}

ElasticityType hyperelastic_type(std::string name, std::string meaning, std::vector<TypeParameter> parameters,
                                 std::string main_key, SharedEnergy (*make)(const TypeInput &)) {
  ElasticityType type;
  type.name = std::move(name);
  type.meaning = std::move(meaning);
  type.parameters = std::move(parameters);
  for (TypeParameter &parameter : volumetric_parameters())
    type.parameters.push_back(std::move(parameter));
  for (TypeParameter &parameter : prony_parameters())
    type.parameters.push_back(std::move(parameter));
  type.has_volumetric_law = true;
  type.make = [name = type.name, main_key = std::move(main_key),
               make](const TypeInput &input) -> std::shared_ptr<const Elasticity> {
    SharedEnergy isochoric = make(input);
    const double shear = isochoric->shear_modulus();
    if (!(shear > 0.)) {
      std::ostringstream text;
      text << "constants with an initial shear modulus > 0; it is " << shear;
      input.reject(main_key, text.str());
    }
    const VolumetricEnergy volumetric = read_volumetric_energy(input, shear);
    const double bulk = volumetric.bulk_modulus(), young_modulus = 9. * bulk * shear / (3. * bulk + shear);
    return make_elasticity(
        make_hyperelastic_law(HyperelasticLaw(name, isochoric, volumetric), read_prony_series(input)),
        young_modulus);
  };
  return type;
}

} // namespace billet
