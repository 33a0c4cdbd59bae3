// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/viscoelastic.h"

#include "billet/material/drucker.h"
#include "billet/material/state_fields.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

double PronySeries::lasting_share() const { return 1. - std::accumulate(moduli.begin(), moduli.end(), 0.); }

namespace {

constexpr const char *prony_moduli_key = "Prony moduli", *times_key = "Prony times";

} // namespace

std::vector<TypeParameter> prony_parameters() {
  using Kind = TypeParameter::Kind;
  return {
      {prony_moduli_key, "", Kind::text,
       "g of each term of Prony's series, separated by commas. They are the shares of the instantaneous "
       "isochoric stress that relax, each > 0 and together < 1. Empty: no viscosity."},
      {times_key, "", Kind::text,
       "Relaxation time of each term, > 0, separated by commas. The elastic constants are those of a fast "
       "deformation. [time]"}};
}

PronySeries read_prony_series(const TypeInput &input) {
  PronySeries series;
  const bool has_moduli = input.is_set(prony_moduli_key), has_times = input.is_set(times_key);
  if (!has_moduli && !has_times)
    return series;
  if (!has_moduli)
    input.reject(prony_moduli_key, "as many numbers as 'Prony times'");
  series.moduli = input.numbers(prony_moduli_key);
  const auto is_positive = [](const double number) { return number > 0.; };
  if (series.moduli.empty() || !std::all_of(series.moduli.begin(), series.moduli.end(), is_positive) ||
      !(series.lasting_share() > 0.))
    input.reject(prony_moduli_key, "numbers > 0 whose sum is < 1");
  if (has_times)
    series.times = input.numbers(times_key);
  if (series.times.size() != series.moduli.size() ||
      !std::all_of(series.times.begin(), series.times.end(), is_positive))
    input.reject(times_key, "as many numbers > 0 as 'Prony moduli'");
  return series;
}

namespace {

/// Returns (ln x − ln y)/(x − y).
double log_difference(const double x, const double y) {
  const double r = (x - y) / y;
  return (r == 0. ? 1. : std::log1p(r) / r) / y;
}

/// Returns the second divided difference of ln at x, y and z. Where they are close it is the mean
/// of −1/s² over the simplex between them, by Gauss' rule of 7 points in each direction. Elsewhere
/// there is no cancellation.
double second_log_difference(double x, double y, double z) {
  if (x < y)
    std::swap(x, y);
  if (y < z)
    std::swap(y, z);
  if (x < y)
    std::swap(x, y);
  constexpr double near = 0.1;
  if (x - z > near * z)
    return (log_difference(x, y) - log_difference(y, z)) / (x - z);
  // ∫_0^1 ds ∫_0^s dt (−1)/(x + s (y − x) + t (z − y))²
  //   = ∫_0^1 ds (−s)/(u v), u = x + s (y − x), v = u + s (z − y): the inner integral is exact.
  constexpr std::array<double, 4> place = {0., 0.405845151377397166906606412076961,
                                           0.741531185599394439863864773280788,
                                           0.949107912342758524526189684047851};
  constexpr std::array<double, 4> weight = {
      0.417959183673469387755102040816327, 0.381830050505118944950369775488975,
      0.279705391489276667901467771423780, 0.129484966168869693270611432679082};
  double sum = 0.;
  for (int k = -3; k <= 3; ++k) {
    const auto i = static_cast<std::size_t>(std::abs(k));
    const double s = 0.5 * (1. + (k < 0 ? -place[i] : place[i])), u = x + s * (y - x);
    sum -= 0.5 * weight[i] * s / (u * (u + s * (z - y)));
  }
  return sum;
}

/// Map between T, conjugate to ½ ln C, and the Kirchhoff stress, (V8).
class LogarithmicMap {
public:
  LogarithmicMap(const Tensor<2, 3> &F, const PrincipalElasticState &principal) : principal_(principal) {
    for (unsigned int a = 0; a < 3; ++a) {
      const double stretch = std::sqrt(principal.stretches_squared[a]);
      material_[a] = principal.directions[a] * F / stretch; // Fᵀ n / λ
    }
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int b = 0; b < 3; ++b) {
        const double x = principal.stretches_squared[a], y = principal.stretches_squared[b];
        factor_[a][b] = std::sqrt(x * y) * log_difference(x, y);
      }
  }

  /// Returns Σ_A t_A N_A ⊗ N_A.
  SymmetricTensor<2, 3> material_tensor(const std::array<double, 3> &t) const {
    SymmetricTensor<2, 3> result;
    for (unsigned int a = 0; a < 3; ++a)
      result += t[a] * dealii::symmetrize(dealii::outer_product(material_[a], material_[a]));
    return result;
  }

  /// Returns the Kirchhoff stress of T.
  SymmetricTensor<2, 3> push(const SymmetricTensor<2, 3> &T) const {
    return combine(principal_.directions, [&](const unsigned int a, const unsigned int b) {
      return factor_[a][b] * (material_[a] * (T * material_[b]));
    });
  }
  SymmetricTensor<2, 3> pull(const SymmetricTensor<2, 3> &tau) const {
    const auto &n = principal_.directions;
    return combine(material_, [&](const unsigned int a, const unsigned int b) {
      return n[a] * (tau * n[b]) / factor_[a][b];
    });
  }

  /// Adds the moduli of push(T) at constant T.
  void add_moduli(const SymmetricTensor<2, 3> &T, SpatialModuli &moduli) const {
    const auto &b = principal_.stretches_squared;
    double factors[3][3][3]; // of d_ac e_cb
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        for (unsigned int k = 0; k < 3; ++k)
          factors[i][k][j] = 2. * (material_[i] * (T * material_[j])) * std::sqrt(b[i] * b[j]) * b[k] *
                             second_log_difference(b[i], b[k], b[j]);
    constexpr unsigned int rows[6] = {0, 1, 2, 0, 0, 1}, columns[6] = {0, 1, 2, 1, 2, 2};
    const auto unit = [&](const unsigned int r, const unsigned int i, const unsigned int j) {
      return (i == rows[r] && j == columns[r]) || (j == rows[r] && i == columns[r]) ? 1. : 0.;
    };
    std::array<std::array<double, 6>, 6> basis;
    for (unsigned int r = 0; r < 6; ++r)
      basis[r] = symmetric_dyad(principal_.directions[rows[r]], principal_.directions[columns[r]]);
    for (unsigned int r = 0; r < 6; ++r)
      for (unsigned int s = 0; s < 6; ++s) {
        double c = 0.;
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int k = 0; k < 3; ++k)
            for (unsigned int j = 0; j < 3; ++j)
              c += factors[i][k][j] * (unit(r, i, k) * unit(s, k, j) + unit(s, i, k) * unit(r, k, j));
        for (unsigned int i = 0; i < 6; ++i)
          for (unsigned int j = 0; j < 6; ++j)
            moduli[i][j] += c * basis[r][i] * basis[s][j];
      }
  }

private:
  template <class Component>
  static SymmetricTensor<2, 3> combine(const std::array<Tensor<1, 3>, 3> &directions,
                                       const Component &component) {
    SymmetricTensor<2, 3> result;
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int b = 0; b < 3; ++b)
        result += component(a, b) * dealii::symmetrize(dealii::outer_product(directions[a], directions[b]));
    return result;
  }

  const PrincipalElasticState &principal_;
  std::array<Tensor<1, 3>, 3> material_; ///< N_A
  double factor_[3][3];
};

/// Returns e with dev t(e) = `stress`, whose sum is 0, by Newton's method on the convex
/// W − stress · e with steps that reduce it. Beyond Drucker's limit it returns the last iterate.
IsochoricStrains invert_stress(const IsochoricEnergy &energy, const std::array<double, 3> &stress) {
  const double scale = 2. * energy.shear_modulus();
  IsochoricStrains e{};
  const auto value = [&](const IsochoricStrains &at) {
    return energy.energy(at) - stress[0] * at[0] - stress[1] * at[1] - stress[2] * at[2];
  };
  double last = value(e);
  constexpr unsigned int max_iterations = 50;
  for (unsigned int i = 0; i < max_iterations; ++i) {
    const IsochoricResponse response = energy.respond(e);
    const double mean = (response.stress[0] + response.stress[1] + response.stress[2]) / 3.;
    std::array<double, 3> r{};
    double size = 0.;
    for (unsigned int a = 0; a < 3; ++a) {
      r[a] = stress[a] - (response.stress[a] - mean);
      size = std::max(size, std::abs(r[a]));
    }
    if (!(size > 1e-15 * scale))
      break;
    // On Σ e = 0, e_3 = −e_1 − e_2.
    const auto &H = response.slope;
    const double a = H[0][0] - 2. * H[0][2] + H[2][2], b = H[0][1] - H[0][2] - H[1][2] + H[2][2],
                 c = H[1][1] - 2. * H[1][2] + H[2][2], f = r[0] - r[2], g = r[1] - r[2],
                 determinant = a * c - b * b;
    if (!(determinant > 0.))
      break;
    double x = (c * f - b * g) / determinant, y = (a * g - b * f) / determinant;
    IsochoricStrains next{};
    double now = 0.;
    unsigned int n_halvings = 0;
    for (;; ++n_halvings, x *= 0.5, y *= 0.5) {
      next = {e[0] + x, e[1] + y, e[2] - x - y};
      now = value(next);
      if (now <= last + 1e-14 * std::abs(last) || n_halvings == 30)
        break;
    }
    if (n_halvings == 30)
      break;
    const double change = std::max(std::abs(x), std::abs(y));
    e = next;
    last = now;
    if (change < 1e-15)
      break;
  }
  return e;
}

/// Returns ½ ln C of a material stress −k/g of the elastic law, (V9), and its energy.
SymmetricTensor<2, 3> invert_stress(const IsochoricEnergy &energy, const SymmetricTensor<2, 3> &T,
                                    double &stored) {
  const auto pairs = dealii::eigenvectors(T, dealii::SymmetricTensorEigenvectorMethod::jacobi);
  const IsochoricStrains e =
      invert_stress(energy, std::array<double, 3>{pairs[0].first, pairs[1].first, pairs[2].first});
  stored = energy.energy(e);
  SymmetricTensor<2, 3> H;
  for (unsigned int a = 0; a < 3; ++a)
    H += e[a] * dealii::symmetrize(dealii::outer_product(pairs[a].second, pairs[a].second));
  return H;
}

/// Factors of a step of y = Δt/τ: h = a h_n + g b ΔT. For |h|² dt/τ over the step, (V10).
struct Recurrence {
  double decay, gain;                ///< a = exp(−y), b = (1 − a)/y
  double of_start, of_both, of_gain; ///< factors of |h_n|², h_n : g ΔT and |g ΔT|²

  explicit Recurrence(const double y) {
    const double lost = -std::expm1(-y);
    decay = 1. - lost;
    gain = y > 0. ? lost / y : 1.;
    of_start = 0.5 * lost * (1. + decay);
    of_both = gain * lost;
    // (y − lost − lost²/2)/y², by its series where that cancels
    of_gain = 0.;
    if (y > 0.5)
      of_gain = (y - lost - 0.5 * lost * lost) / (y * y);
    else {
      double power = -y / 6.; // (−1)^n y^{n−2}/n! at n = 3
      double two = 4.;        // 2^{n−1}
      for (unsigned int n = 3; n < 20; ++n) {
        of_gain += power * (2. - two);
        power *= -y / (n + 1.);
        two *= 2.;
      }
    }
  }
};

SymmetricTensor<2, 3> read(const double *numbers) {
  SymmetricTensor<2, 3> result;
  for (unsigned int i = 0; i < 6; ++i)
    result.access_raw_entry(i) = numbers[i];
  return result;
}
void write(const SymmetricTensor<2, 3> &tensor, double *numbers) {
  for (unsigned int i = 0; i < 6; ++i)
    numbers[i] = tensor.access_raw_entry(i);
}

} // namespace

std::vector<StateField> ViscoelasticLaw::fields() const {
  std::vector<StateField> result = {symmetric_field("instantaneous stress"), {"viscous dissipation", 1}};
  for (std::size_t i = 1; i <= series_.times.size(); ++i) {
    result.push_back(symmetric_field("viscous stress " + std::to_string(i)));
    result.push_back({"viscous compliance " + std::to_string(i), 1});
  }
  return result;
}

void ViscoelasticLaw::initialize(double *state) const {
  std::fill_n(state, n_state(), 0.);
  for (std::size_t i = 0; i < series_.times.size(); ++i)
    state[n_common + n_term * i + 6] = 0.5 / (series_.moduli[i] * elastic_.elastic().shear);
}

bool ViscoelasticLaw::update(const Tensor<2, 3> &F, double, const PointStep &step, const double *state_n,
                             double *state, SymmetricTensor<2, 3> &tau, SpatialModuli *moduli) const {
  HyperelasticState now;
  if (!elastic_.respond(F, now))
    return false;
  const LogarithmicMap map(F, now.principal);
  const SymmetricTensor<2, 3> T = map.material_tensor(now.response.stress), T_n = read(state_n),
                              H = map.material_tensor(now.principal.deviatoric_log_strains);
  const double shear = elastic_.elastic().shear;
  double share = series_.lasting_share(), dissipated = state_n[6];
  SymmetricTensor<2, 3> carried; // the part of Σ h that the step does not change
  for (std::size_t i = 0; i < series_.times.size(); ++i) {
    const double *term_n = state_n + n_common + n_term * i;
    double *term = state + n_common + n_term * i;
    const double g = series_.moduli[i];
    const Recurrence step_factors(step.dt / series_.times[i]);
    const SymmetricTensor<2, 3> h_n = read(term_n),
                                kept = step_factors.decay * h_n - g * step_factors.gain * T_n,
                                h = kept + g * step_factors.gain * T, rise = g * (T - T_n);
    carried += kept;
    share += g * step_factors.gain;
    // (V9): the branch is at rest at the strain whose stress is T − h/g.
    const double squared = h * h, small = 1e-7 * g * shear;
    double stored = 0., compliance = 0.5 / (g * shear);
    if (squared > small * small)
      compliance = (H - invert_stress(elastic_.isochoric_energy(), T - h / g, stored)) * h / squared;
    dissipated += 0.5 * (term_n[6] + compliance) *
                  (step_factors.of_start * (h_n * h_n) + step_factors.of_both * (h_n * rise) +
                   step_factors.of_gain * (rise * rise));
    write(h, term);
    term[6] = compliance;
  }
  write(T, state);
  state[6] = dissipated;
  tau = compute_hyperelastic_stress(now, share) + map.push(carried);
  if (moduli != nullptr) {
    compute_hyperelastic_moduli(now, share, *moduli);
    map.add_moduli(carried, *moduli);
  }
  return std::isfinite(tau.norm());
}

double ViscoelasticLaw::stored_energy(const Tensor<2, 3> &F, double, const double *state) const {
  HyperelasticState now;
  if (!elastic_.respond(F, now))
    return 0.;
  const IsochoricEnergy &isochoric = elastic_.isochoric_energy();
  const LogarithmicMap map(F, now.principal);
  const SymmetricTensor<2, 3> T = map.material_tensor(now.response.stress),
                              H = map.material_tensor(now.principal.deviatoric_log_strains);
  const double W = isochoric.energy(now.principal.deviatoric_log_strains);
  double result = elastic_.volumetric_energy().energy(now.J) + series_.lasting_share() * W;
  for (std::size_t i = 0; i < series_.times.size(); ++i) {
    const double g = series_.moduli[i];
    const SymmetricTensor<2, 3> at_rest = T - read(state + n_common + n_term * i) / g;
    double stored = 0.;
    const SymmetricTensor<2, 3> H_at_rest = invert_stress(isochoric, at_rest, stored);
    result += g * (W - stored - at_rest * (H - H_at_rest));
  }
  return result;
}

void ViscoelasticLaw::set_stress(const Tensor<2, 3> &F, const SymmetricTensor<2, 3> &deviator, double,
                                 double *state) const {
  HyperelasticState now;
  if (!elastic_.respond(F, now))
    return;
  const LogarithmicMap map(F, now.principal);
  const SymmetricTensor<2, 3> T = map.material_tensor(now.response.stress);
  const double lasting = series_.lasting_share();
  write(T, state);
  for (std::size_t i = 0; i < series_.times.size(); ++i)
    write(series_.moduli[i] / (1. - lasting) * (map.pull(deviator) - lasting * T),
          state + n_common + n_term * i);
}

std::vector<double> ViscoelasticLaw::memory(const Tensor<2, 3> &, const double *const state) const {
  return {state + 6, state + n_state()};
}

void ViscoelasticLaw::remember(const Tensor<2, 3> &, const std::vector<double> &memory,
                               double *const state) const {
  SymmetricTensor<2, 3> missing; // of the stress
  for (std::size_t i = 0; i < series_.times.size(); ++i)
    missing += read(state + n_common + n_term * i);
  std::copy(memory.begin(), memory.end(), state + 6);
  for (std::size_t i = 0; i < series_.times.size(); ++i)
    missing -= read(state + n_common + n_term * i);
  for (std::size_t i = 0; i < series_.times.size(); ++i) {
    double *const term = state + n_common + n_term * i;
    write(read(term) + series_.moduli[i] / (1. - series_.lasting_share()) * missing, term);
  }
}

std::string ViscoelasticLaw::summary() const {
  const std::string stability = describe_stability(elastic_.isochoric_energy());
  return PointLaw::summary() + " with viscosity" + (stability.empty() ? "" : ", " + stability);
}

double ViscoelasticLaw::bound_stiffness(const SymmetricTensor<2, 3> &tau) const {
  // A relaxed stress belongs to an instantaneous one that is larger.
  return elastic_.bound_stiffness(tau + (1. / series_.lasting_share() - 1.) * dealii::deviator(tau));
}

SharedLaw make_hyperelastic_law(HyperelasticLaw elastic, PronySeries series) {
  if (series.times.empty())
    return std::make_shared<const HyperelasticLaw>(std::move(elastic));
  return std::make_shared<const ViscoelasticLaw>(std::move(elastic), std::move(series));
}

ElasticityType with_prony_series(ElasticityType type, SharedEnergy (*make)(double shear)) {
  for (TypeParameter &parameter : prony_parameters())
    type.parameters.push_back(std::move(parameter));
  type.make = [name = type.name, make_elastic = std::move(type.make),
               make](const TypeInput &input) -> std::shared_ptr<const Elasticity> {
    std::shared_ptr<const Elasticity> elastic = make_elastic(input);
    PronySeries series = read_prony_series(input);
    if (series.times.empty())
      return elastic;
    const ElasticModuli moduli = elastic->moduli();
    const VolumetricEnergy volumetric(make_logarithmic_volume(), moduli.bulk);
    return make_elasticity(
        make_hyperelastic_law(HyperelasticLaw(name, make(moduli.shear), volumetric), std::move(series)),
        elastic->young_modulus());
  };
  return type;
}

} // namespace billet
