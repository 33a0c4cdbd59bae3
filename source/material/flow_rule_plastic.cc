// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/flow_rule_plastic.h"

#include "billet/material/hencky.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

namespace {

const SymmetricTensor<2, 3> identity = dealii::unit_symmetric_tensor<3>();

/// Flow stress of a law with a flow rule, as other classes see it: that of monotone tension.
class TensionFlow final : public FlowStress {
public:
  TensionFlow(SharedFlow flow, const FlowRule &rule)
      : flow_(std::move(flow)), terms_(rule.backstress), description_(rule.description()) {}

  std::string description() const override { return flow_->description() + description_; }
  double stress(const double alpha) const override {
    double sum = flow_->stress(alpha);
    for (const BackstressTerm &term : terms_)
      sum +=
          term.rate > 0. ? -term.modulus / term.rate * std::expm1(-term.rate * alpha) : term.modulus * alpha;
    return sum;
  }
  double slope(const double alpha) const override {
    double sum = flow_->slope(alpha);
    for (const BackstressTerm &term : terms_)
      sum += term.modulus * std::exp(-term.rate * alpha);
    return sum;
  }
  PlasticIncrement solve(const double q, const double m, const double alpha_n,
                         const double dt) const override {
    return flow_->solve(q, m, alpha_n, dt);
  }
  std::size_t n_state() const override { return flow_->n_state(); }
  void advance(const double alpha_n, const double delta_alpha, const double dt, const State &state_n,
               State &state) const override {
    flow_->advance(alpha_n, delta_alpha, dt, state_n, state);
  }
  double plastic_work(const double alpha, const State &state) const override {
    return flow_->plastic_work(alpha, state);
  }
  double plastic_work_at_rest(const double alpha) const override {
    return flow_->plastic_work_at_rest(alpha);
  }
  bool is_bounded() const override {
    return flow_->is_bounded() && std::all_of(terms_.begin(), terms_.end(), [](const BackstressTerm &term) {
             return term.rate > 0. || term.modulus == 0.;
           });
  }

private:
  SharedFlow flow_;
  std::vector<BackstressTerm> terms_;
  std::string description_;
};

/// Factors of a term over x = g Δα: exp(−x), (1 − exp(−x))/x, and the derivative of the latter.
struct Recovery {
  double decay, mean, slope;

  explicit Recovery(const double x) : decay(std::exp(-x)) {
    constexpr double small = 0.1;
    constexpr unsigned int n_terms = 12;
    if (x > small) {
      mean = -std::expm1(-x) / x;
      slope = (decay - mean) / x;
      return;
    }
    mean = slope = 0.;
    double power = 1.; // (−x)^n/(n + 1)!
    for (unsigned int n = 0; n < n_terms; ++n) {
      mean += power;
      slope -= (n + 1.) / (n + 2.) * power;
      power *= -x / (n + 2.);
    }
  }
};

/// Returns ∫ |exp(−u) P + (1 − exp(−u)) D/x|² du from 0 to x: the energy that recovery dissipates
/// in a step, over ⅔ C.
double integrate_recovery(const double x, const Vector6 &P, const Vector6 &D) {
  if (!(x > 0.))
    return 0.;
  constexpr double small = 0.01;
  const double rise = -std::expm1(-x);
  const double of_rise = x > small ? x - 2. * rise - 0.5 * std::expm1(-2. * x)
                                   : x * x * x * (1. / 3. - x * (0.25 - x * (7. / 60. - x / 24.)));
  return -0.5 * std::expm1(-2. * x) * dot(P, P) + rise * rise / x * dot(P, D) + of_rise / (x * x) * dot(D, D);
}

Matrix6 mises_matrix() {
  return HillCoefficients().matrix(
      {Tensor<1, 3>({1., 0., 0.}), Tensor<1, 3>({0., 1., 0.}), Tensor<1, 3>({0., 0., 1.})});
}

/// Returns sym(A B Aᵀ).
SymmetricTensor<2, 3> transform(const Tensor<2, 3> &A, const SymmetricTensor<2, 3> &B) {
  return dealii::symmetrize(A * Tensor<2, 3>(B) * dealii::transpose(A));
}

} // namespace

/// Start of a step: the tensors of the history in the frame of the flow rule.
template <bool has_directions, bool is_thermal> struct FlowRulePlasticity<has_directions, is_thermal>::Trial {
  double log_J;
  Tensor<2, 3> rotation; ///< from that frame to space; not 1 with material axes only
  Tensor<2, 3> A;        ///< deformation gradient to that frame
  Eigensystem stretch;   ///< of A, with material axes only
  SymmetricTensor<2, 3> M;
  std::array<SymmetricTensor<2, 3>, FlowRule::max_terms> metrics;
  PrincipalElasticState principal; ///< of M
  SymmetricTensor<2, 3> strain;    ///< dev ½ ln M

  /// Returns the gradient of the rate that symmetric d of space has in that frame, (H14) of
  /// doc/theory.md. It is d − Ω with the spin Ω of the rotation.
  Tensor<2, 3> gradient_of(const SymmetricTensor<2, 3> &d, const bool is_turned) const {
    Tensor<2, 3> L = d;
    if (!is_turned)
      return L;
    L = dealii::transpose(stretch.frame) * L * stretch.frame;
    const auto &u = stretch.values;
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int b = 0; b < 3; ++b)
        L[a][b] *= 1. - (u[b] - u[a]) / (u[a] + u[b]);
    return stretch.frame * L * dealii::transpose(stretch.frame);
  }
};

/// Return map: the state at an elastic strain, and Newton's method for it.
template <bool has_directions, bool is_thermal> class FlowRulePlasticity<has_directions, is_thermal>::Return {
public:
  Return(const FlowRulePlasticity &law, const Trial &trial, const History &history_n, const PointStep &step)
      : law_(law), trial_(trial), history_n_(history_n), step_(step),
        stabilisation_(step.shared != nullptr ? 6. * law.elastic_.shear * step.shared->energy : 0.),
        strain_(to_kelvin(trial.strain)) {}

  /// Evaluates the trial state. Returns false if it is inadmissible. Only terms need its strains.
  bool start() {
    if (n_terms() > 0 && !evaluate())
      return false;
    assemble();
    set_temperature();
    return std::isfinite(q_);
  }
  bool yields() const {
    return q_ >
           heat_.factor * law_.flow_->stress(history_n_.equivalent_plastic_strain) * (1. + step_.yield_slack);
  }

  /// Iterates to round-off. Returns false if that fails.
  bool iterate() {
    constexpr unsigned int max_iterations = 100;
    constexpr double round_off = 1e-15, small = 1e-10; // strains
    double last = std::numeric_limits<double>::infinity();
    if (n_terms() == 0 && !evaluate())
      return false;
    for (unsigned int i = 0; i < max_iterations; ++i) {
      differentiate();
      const double before = increment_.alpha;
      const bool is_found = find_increment();
      assemble();
      const LinearSystem6 system(jacobian());
      if (!system.is_regular())
        return false;
      const Vector6 change = system.solve(residual());
      add(strain_, -1., change);
      if (!evaluate())
        return false;
      assemble();
      set_temperature();
      const double size = std::sqrt(dot(change, change)) + std::abs(increment_.alpha - before);
      if (!std::isfinite(size) || !std::isfinite(q_))
        return false;
      if (is_found && (size <= round_off || (size < small && size >= 0.5 * last))) {
        differentiate();
        return true;
      }
      last = size;
    }
    return false;
  }

  /// Returns the Kirchhoff stress in space.
  SymmetricTensor<2, 3> stress() const { return transform(trial_.rotation, local_stress()); }
  SymmetricTensor<2, 3> backstress() const {
    Vector6 sum{};
    for (std::size_t j = 0; j < n_terms(); ++j)
      add(sum, 2. / 3. * law_.rule_.backstress[j].modulus, kappa_[j]);
    return transform(trial_.rotation, from_kelvin(sum));
  }
  /// Returns κ_j in space.
  SymmetricTensor<2, 3> strain_of_term(const std::size_t j) const {
    return transform(trial_.rotation, from_kelvin(kappa_[j]));
  }
  /// Returns the energy that the terms of backstress store, (H9) of doc/theory.md [stress].
  double backstress_energy() const {
    double sum = 0.;
    for (std::size_t j = 0; j < n_terms(); ++j)
      sum += law_.rule_.backstress[j].modulus / 3. * dot(kappa_[j], kappa_[j]);
    return sum;
  }

  /// Writes what flow changes.
  void advance(History &history) const {
    const double alpha_n = history_n_.equivalent_plastic_strain;
    history.equivalent_plastic_strain += increment_.alpha;
    law_.flow_->advance(alpha_n, increment_.alpha, step_.dt, history_n_.flow, history.flow);
    history.temperature_rise = heat_.rise;
    history.dissipated += (heat_.factor - 1.) * heat_.work;
    double of_backstress = 0.; // its work
    const Tensor<2, 3> inverse = dealii::invert(trial_.A);
    const auto pull_back = [&](const double factor, const Vector6 &twice_strain, const Tensor<2, 3> &outer) {
      Vector6 exponent{};
      add(exponent, factor, twice_strain);
      return transform(inverse * outer, exponential(from_kelvin(exponent)));
    };
    const double volumetric = std::exp(trial_.log_J / 3.);
    const Tensor<2, 3> V = volumetric * Tensor<2, 3>(exponential(from_kelvin(strain_)));
    history.inverse_plastic_metric = volumetric * volumetric * pull_back(2., strain_, identity);
    for (std::size_t j = 0; j < n_terms(); ++j) {
      const BackstressTerm &term = law_.rule_.backstress[j];
      history.inverse_metrics[j] = pull_back(2., kappa_[j], V);
      Vector6 start = terms_[j].value();
      add(start, -1., flow_strain_.value());
      const double recovered = 2. / 3. * term.modulus *
                               integrate_recovery(term.rate * increment_.alpha, start, flow_strain_.value());
      history.dissipated += recovered;
      of_backstress +=
          recovered + term.modulus / 3. *
                          (dot(kappa_[j], kappa_[j]) - dot(terms_[j].value(), terms_[j].value()) +
                           2. * dot(terms_[j].value(), flow_strain_.value()) -
                           dot(flow_strain_.value(), flow_strain_.value()));
    }
    history.temperature_rise += law_.rule_.heating * of_backstress;
  }

  /// Computes the moduli in space, and the derivatives of the share of a stabilisation.
  void compute_moduli(SpatialModuli &moduli) const {
    const bool is_turned = law_.rule_.anisotropy != nullptr;
    const double two_g = 2. * law_.elastic_.shear, three_g = 1.5 * two_g, h = heat_.slope,
                 p = (1. - increment_.mu * h) / q_, share = 1. / (1. + three_g * increment_.mu),
                 share_slope = -three_g * share * share;
    const LinearSystem6 system(jacobian());
    const Response response = respond(system);
    const double stiffness = h - response.of_mu * p - response.of_alpha;
    Vector6 by_alpha = multiply(law_.yield_, xi_alpha_); // −b_α/μ
    for (unsigned int i = 0; i < 6; ++i)
      by_alpha[i] = increment_.mu * by_alpha[i] + p * flow_[i];
    by_alpha = system.solve(by_alpha); // ∂ε/∂Δα
    const Tensor<2, 3> T = local_stress();
    Matrix6 local{};
    Vector6 share_rate{};
    for (unsigned int k = 0; k < 6; ++k) {
      Vector6 one{};
      one[k] = 1.;
      const Tensor<2, 3> L = trial_.gradient_of(from_kelvin(one), is_turned);
      const auto rate_of = [&](const SymmetricTensor<2, 3> &M) {
        return 2. * dealii::symmetrize(L * Tensor<2, 3>(M));
      };
      const Vector6 strain_rate = flow_strain_.along(rate_of(trial_.M));
      Vector6 xi_rate{};
      for (std::size_t j = 0; j < n_terms(); ++j) {
        const double c = 2. / 3. * law_.rule_.backstress[j].modulus;
        const Recovery recovery(law_.rule_.backstress[j].rate * increment_.alpha);
        add(xi_rate, -c * recovery.decay, terms_[j].along(rate_of(trial_.metrics[j])));
        add(xi_rate, -c * (recovery.mean - recovery.decay), strain_rate);
      }
      Vector6 residual_rate = multiply(law_.yield_, xi_rate);
      for (unsigned int i = 0; i < 6; ++i)
        residual_rate[i] = strain_rate[i] - increment_.mu * residual_rate[i];
      Vector6 elastic_rate{};
      add(elastic_rate, -1., system.solve(residual_rate));
      const double q_rate = dot(response.gradient, elastic_rate) + dot(flow_, xi_rate) / q_,
                   alpha_rate = q_rate / stiffness;
      add(elastic_rate, alpha_rate, by_alpha);
      share_rate[k] = share_slope * p * alpha_rate;
      const double trace = k < 3 ? 1. : 0.;
      const SymmetricTensor<2, 3> stress_rate =
          law_.elastic_.bulk * trace * identity + two_g * dealii::deviator(from_kelvin(elastic_rate));
      const Vector6 column = to_kelvin(stress_rate - 2. * dealii::symmetrize(L * T));
      for (unsigned int i = 0; i < 6; ++i)
        local[i][k] = column[i];
    }
    turn(local, is_turned, moduli);
    if (step_.shared != nullptr) {
      step_.shared->share = share;
      step_.shared->slope = share_slope * p * three_g * share * share / (q_ * stiffness);
      step_.shared->rate += Tensor<2, 3>(transform(trial_.rotation, from_kelvin(share_rate)));
    }
  }

  /// Sets the share of a stabilisation without moduli.
  void set_share() const {
    if (step_.shared != nullptr)
      step_.shared->share = 1. / (1. + 3. * law_.elastic_.shear * increment_.mu);
  }

  double delta_alpha() const { return increment_.alpha; }

private:
  /// Linear response of Q at the elastic strain that the flow rule gives.
  struct Response {
    Vector6 gradient; ///< of Q over the elastic strain
    double at_zero;   ///< change of Q that ends the residual
    double of_mu, of_alpha;
  };

  std::size_t n_terms() const { return law_.rule_.backstress.size(); }

  SymmetricTensor<2, 3> local_stress() const {
    return law_.elastic_.bulk * trial_.log_J * identity + 2. * law_.elastic_.shear * from_kelvin(strain_);
  }

  /// Computes the strains of flow and of the terms at the elastic strain.
  bool evaluate() {
    SymmetricTensor<2, 3> strain = from_kelvin(strain_);
    strain += trial_.log_J / 3. * identity;
    if (!stretch_.compute(strain) || !flow_strain_.compute(stretch_, trial_.M))
      return false;
    for (std::size_t j = 0; j < n_terms(); ++j)
      if (!terms_[j].compute(stretch_, trial_.metrics[j]))
        return false;
    return true;
  }

  /// Computes ξ, Q and what follows from them at μ and Δα.
  void assemble() {
    xi_ = {};
    add(xi_, 2. * law_.elastic_.shear, strain_);
    xi_alpha_ = {};
    for (std::size_t j = 0; j < n_terms(); ++j) {
      const BackstressTerm &term = law_.rule_.backstress[j];
      const Recovery recovery(term.rate * increment_.alpha);
      const double c = 2. / 3. * term.modulus, of_flow = recovery.mean - recovery.decay;
      kappa_[j] = {};
      add(kappa_[j], recovery.decay, terms_[j].value());
      add(kappa_[j], of_flow, flow_strain_.value());
      add(xi_, -c, kappa_[j]);
      add(xi_alpha_, c * term.rate * recovery.decay, terms_[j].value());
      add(xi_alpha_, -c * term.rate * (recovery.slope + recovery.decay), flow_strain_.value());
    }
    flow_ = multiply(law_.yield_, xi_);
    const double share = 1. / (1. + 3. * law_.elastic_.shear * increment_.mu);
    q_ = std::sqrt(std::max(dot(xi_, flow_), 0.) + stabilisation_ * share * share);
    q_mu_ = q_ > 0. ? -3. * law_.elastic_.shear * stabilisation_ * share * share * share / q_ : 0.;
  }

  /// Computes the derivatives of the strains, at evaluate()'s elastic strain.
  void differentiate() {
    strain_by_strain_ = flow_strain_.derivative();
    for (std::size_t j = 0; j < n_terms(); ++j)
      terms_by_strain_[j] = terms_[j].derivative();
  }

  Matrix6 xi_by_strain() const {
    Matrix6 result{};
    const double two_g = 2. * law_.elastic_.shear;
    for (unsigned int i = 0; i < 6; ++i) {
      result[i][i] = two_g;
      for (unsigned int k = 0; i < 3 && k < 3; ++k)
        result[i][k] -= two_g / 3.;
    }
    for (std::size_t j = 0; j < n_terms(); ++j) {
      const BackstressTerm &term = law_.rule_.backstress[j];
      const Recovery recovery(term.rate * increment_.alpha);
      const double c = 2. / 3. * term.modulus;
      add(result, -c * recovery.decay, terms_by_strain_[j]);
      add(result, -c * (recovery.mean - recovery.decay), strain_by_strain_);
    }
    return result;
  }

  Vector6 residual() const {
    Vector6 result = flow_strain_.value();
    add(result, -increment_.mu, flow_);
    return result;
  }
  /// Returns the derivative of the residual; that along the trace is −1, which keeps it.
  Matrix6 jacobian() const {
    Matrix6 result = strain_by_strain_;
    const Matrix6 by_strain = xi_by_strain();
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int k = 0; k < 6; ++k) {
        double sum = 0.;
        for (unsigned int j = 0; j < 6; ++j)
          sum += law_.yield_[i][j] * by_strain[j][k];
        result[i][k] -= increment_.mu * sum + (i < 3 && k < 3 ? 1. / 3. : 0.);
      }
    return result;
  }

  Response respond(const LinearSystem6 &system) const {
    Response response{};
    const Matrix6 by_strain = xi_by_strain();
    for (unsigned int i = 0; i < 6; ++i)
      add(response.gradient, flow_[i] / q_, by_strain[i]);
    response.at_zero = -dot(response.gradient, system.solve(residual()));
    response.of_mu = dot(response.gradient, system.solve(flow_)) + q_mu_;
    response.of_alpha =
        increment_.mu * dot(response.gradient, system.solve(multiply(law_.yield_, xi_alpha_))) +
        dot(flow_, xi_alpha_) / q_;
    return response;
  }

  /// Finds Δα and μ = Δα/Q. Q over Δα is linear, and exact if flow is radial: 1/Q is linear in μ,
  /// (H7). Returns false, and keeps both, far from the solution where that line is of no use.
  bool find_increment() {
    const LinearSystem6 system(jacobian());
    if (!system.is_regular())
      return false;
    const Response response = respond(system);
    const double y = 1. / q_, base = y - y * y * (response.at_zero - response.of_mu * increment_.mu);
    if (!(base > 0.) || !(response.of_mu < 0.))
      return false;
    const double correction = response.of_alpha / (1. + y * response.of_mu * increment_.mu);
    const double q = 1. / base - correction * increment_.alpha,
                 m = -y * y * response.of_mu / base - correction;
    if (!(m > 0.) || !(q > 0.))
      return false;
    const PlasticIncrement increment =
        law_.flow_->solve(q / heat_.factor, m / heat_.factor, history_n_.equivalent_plastic_strain, step_.dt);
    increment_.alpha = increment.strain;
    increment_.slope = increment.slope;
    increment_.mu = increment_.alpha / (q - m * increment_.alpha);
    return true;
  }

  /// Finds the temperature at Δα, (H16) of doc/theory.md, and the slope of the flow stress with it.
  void set_temperature() {
    heat_.factor = 1.;
    heat_.slope = increment_.slope;
    heat_.rise = history_n_.temperature_rise;
    heat_.work = 0.;
    if constexpr (is_thermal) {
      const ThermalFactor &thermal = *law_.rule_.thermal;
      const double alpha_n = history_n_.equivalent_plastic_strain, alpha = alpha_n + increment_.alpha;
      if (increment_.alpha > 0.) {
        FlowStress::State state{};
        law_.flow_->advance(alpha_n, increment_.alpha, step_.dt, history_n_.flow, state);
        heat_.work =
            law_.flow_->plastic_work(alpha, state) - law_.flow_->plastic_work(alpha_n, history_n_.flow);
      }
      const double heating = law_.rule_.heating, start = step_.temperature + history_n_.temperature_rise;
      double temperature = start;
      constexpr unsigned int max_iterations = 50;
      for (unsigned int i = 0; i < max_iterations; ++i) {
        const double change =
            (start + heating * thermal.value_at(alpha, temperature) * heat_.work - temperature) /
            (1. - heating * thermal.slopes_at(alpha, temperature).first * heat_.work);
        temperature += change;
        if (std::abs(change) <= 1e-15 * (std::abs(temperature) + std::abs(start)))
          break;
      }
      heat_.factor = thermal.value_at(alpha, temperature);
      heat_.rise = temperature - step_.temperature;
      const auto [theta_slope, theta_hardening] = thermal.slopes_at(alpha, temperature);
      const double at_rest = law_.flow_->stress(alpha), raw = q_ / heat_.factor;
      const double work_slope =
          raw + (increment_.alpha > 0.
                     ? (increment_.slope / raw - law_.flow_->slope(alpha) / at_rest) * heat_.work
                     : 0.);
      const double warming = heating * (heat_.factor * work_slope + theta_hardening * heat_.work) /
                             (1. - heating * theta_slope * heat_.work);
      heat_.slope = heat_.factor * increment_.slope + raw * (theta_slope * warming + theta_hardening);
    }
  }

  void turn(const Matrix6 &local, const bool is_turned, SpatialModuli &moduli) const {
    const Matrix6 K = rotation_of(trial_.rotation);
    const double root_2 = std::sqrt(2.);
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int j = 0; j < 6; ++j) {
        double sum = local[i][j];
        if (is_turned) {
          sum = 0.;
          for (unsigned int k = 0; k < 6; ++k)
            sum += K[i][k] * dot(local[k], K[j]);
        }
        moduli[i][j] = sum / ((i < 3 ? 1. : root_2) * (j < 3 ? 1. : root_2));
      }
  }

  const FlowRulePlasticity &law_;
  const Trial &trial_;
  const History &history_n_;
  const PointStep &step_;
  double stabilisation_; ///< 6 G W

  Vector6 strain_; ///< deviator of the elastic strain
  struct {
    /// Δα/Q, Δα, derivative of the flow stress without heat.
    double mu = 0., alpha = 0., slope = 0.;
  } increment_;
  struct {
    double factor = 1., rise = 0., work = 0., slope = 0.; ///< slope: of the flow stress with heat
  } heat_;
  InverseStretch stretch_;
  RelativeStrain flow_strain_;
  std::array<RelativeStrain, FlowRule::max_terms> terms_;
  Matrix6 strain_by_strain_{};
  std::array<Matrix6, FlowRule::max_terms> terms_by_strain_;
  std::array<Vector6, FlowRule::max_terms> kappa_;
  Vector6 xi_{}, xi_alpha_{}, flow_{};
  double q_ = 0., q_mu_ = 0.;
};

template <bool has_directions, bool is_thermal>
FlowRulePlasticity<has_directions, is_thermal>::FlowRulePlasticity(const ElasticModuli &elastic,
                                                                   SharedFlow flow, FlowRule rule)
    : elastic_(elastic), flow_(std::move(flow)),
      described_flow_(std::make_shared<const TensionFlow>(flow_, rule)), rule_(std::move(rule)),
      yield_(rule_.anisotropy != nullptr
                 ? rule_.anisotropy->coefficients.matrix(rule_.anisotropy->axes.at({}))
                 : mises_matrix()) {
  if (rule_.backstress.size() > FlowRule::max_terms)
    throw std::invalid_argument("too many terms of backstress");
  if (is_thermal != (rule_.thermal != nullptr))
    throw std::logic_error("a thermal law has a thermal factor");
}

template <bool has_directions, bool is_thermal>
bool FlowRulePlasticity<has_directions, is_thermal>::prepare(const Tensor<2, 3> &F, const History &history_n,
                                                             Trial &trial) const {
  const double J = dealii::determinant(F);
  if (!(J > 0.) || !std::isfinite(J))
    return false;
  trial.log_J = std::log(J);
  trial.A = F;
  trial.rotation = identity;
  if (rule_.anisotropy != nullptr) {
    if (!trial.stretch.compute(dealii::symmetrize(dealii::transpose(F) * F)))
      return false;
    std::array<double, 3> inverse{};
    for (unsigned int a = 0; a < 3; ++a) {
      trial.stretch.values[a] = std::sqrt(trial.stretch.values[a]);
      inverse[a] = 1. / trial.stretch.values[a];
    }
    trial.A = trial.stretch.compose(trial.stretch.values);
    trial.rotation = F * Tensor<2, 3>(trial.stretch.compose(inverse));
  }
  trial.M = transform(trial.A, history_n.inverse_plastic_metric);
  if (!compute_principal_state(trial.M, trial.principal))
    return false;
  for (unsigned int a = 0; a < 3; ++a)
    trial.strain += trial.principal.deviatoric_log_strains[a] *
                    dealii::symmetrize(
                        dealii::outer_product(trial.principal.directions[a], trial.principal.directions[a]));
  for (std::size_t j = 0; j < rule_.backstress.size(); ++j)
    trial.metrics[j] = transform(trial.A, history_n.inverse_metrics[j]);
  return true;
}

template <bool has_directions, bool is_thermal>
bool FlowRulePlasticity<has_directions, is_thermal>::update(const Tensor<2, 3> &F, const History &history_n,
                                                            History &history, SymmetricTensor<2, 3> &tau,
                                                            SpatialModuli *moduli,
                                                            const PointStep &step) const {
  Trial trial;
  if (!prepare(F, history_n, trial))
    return false;
  Return solution(*this, trial, history_n, step);
  if (!solution.start())
    return false;
  const bool yields = solution.yields();
  if (yields && !solution.iterate())
    return false;
  tau = solution.stress();
  history = history_n;
  if (!rule_.backstress.empty())
    history.backstress = solution.backstress();
  if (!yields) {
    if (moduli != nullptr) {
      trial.principal.volumetric_log_strain = trial.log_J;
      PrincipalResponse response;
      for (unsigned int a = 0; a < 3; ++a) {
        response.stress[a] =
            elastic_.bulk * trial.log_J + 2. * elastic_.shear * trial.principal.deviatoric_log_strains[a];
        trial.principal.directions[a] = trial.rotation * trial.principal.directions[a];
      }
      compute_spatial_moduli(trial.principal, response, elastic_, *moduli);
    }
    return true;
  }
  if (solution.delta_alpha() > 0.)
    solution.advance(history);
  solution.set_share();
  if (moduli != nullptr)
    solution.compute_moduli(*moduli);
  return true;
}

template <bool has_directions, bool is_thermal>
double FlowRulePlasticity<has_directions, is_thermal>::elastic_energy(const Tensor<2, 3> &F,
                                                                      const History &history) const {
  Trial trial;
  if (!prepare(F, history, trial))
    return 0.;
  const PointStep at_rest;
  Return solution(*this, trial, history, at_rest);
  if (!solution.start())
    return 0.;
  return 0.5 * elastic_.bulk * trial.log_J * trial.log_J + elastic_.shear * (trial.strain * trial.strain) +
         solution.backstress_energy();
}

template <bool has_directions, bool is_thermal>
typename FlowRulePlasticity<has_directions, is_thermal>::History
FlowRulePlasticity<has_directions, is_thermal>::find_history(const Tensor<2, 3> &F,
                                                             const SymmetricTensor<2, 3> &deviator,
                                                             const double equivalent_plastic_strain) const {
  History history;
  history.inverse_plastic_metric = std::pow(dealii::determinant(F), 2. / 3.) *
                                   transform(dealii::invert(F), exponential(deviator / elastic_.shear));
  history.equivalent_plastic_strain = equivalent_plastic_strain;
  history.inverse_metrics.fill(history.inverse_plastic_metric); // no backstress
  return history;
}

template <bool has_directions, bool is_thermal>
std::vector<double> FlowRulePlasticity<has_directions, is_thermal>::memory(const Tensor<2, 3> &F,
                                                                           const History &history) const {
  std::vector<double> numbers = flow_->numbers_of(history.flow);
  numbers.push_back(history.dissipated);
  numbers.push_back(history.temperature_rise);
  Trial trial;
  const PointStep at_rest;
  const bool is_sound = prepare(F, history, trial);
  Return solution(*this, trial, history, at_rest);
  const bool has_strains = is_sound && solution.start();
  for (std::size_t j = 0; j < rule_.backstress.size(); ++j) {
    const SymmetricTensor<2, 3> kappa = has_strains ? solution.strain_of_term(j) : SymmetricTensor<2, 3>();
    for (unsigned int i = 0; i < 6; ++i)
      numbers.push_back(kappa.access_raw_entry(i));
  }
  return numbers;
}

template <bool has_directions, bool is_thermal>
void FlowRulePlasticity<has_directions, is_thermal>::remember(const Tensor<2, 3> &F,
                                                              const std::vector<double> &memory,
                                                              History &history) const {
  auto number = memory.begin();
  std::copy_n(number, flow_->n_state(), history.flow.begin());
  number += static_cast<std::ptrdiff_t>(flow_->n_state());
  history.dissipated = *number++;
  history.temperature_rise = *number++;
  Trial trial;
  if (rule_.backstress.empty() || !prepare(F, history, trial))
    return;
  const Tensor<2, 3> V = std::exp(trial.log_J / 3.) * Tensor<2, 3>(exponential(trial.strain)),
                     to_body = dealii::invert(trial.A) * V, to_frame = dealii::transpose(trial.rotation);
  history.backstress = 0.;
  for (std::size_t j = 0; j < rule_.backstress.size(); ++j) {
    SymmetricTensor<2, 3> kappa;
    for (unsigned int i = 0; i < 6; ++i)
      kappa.access_raw_entry(i) = *number++;
    history.backstress += 2. / 3. * rule_.backstress[j].modulus * kappa;
    history.inverse_metrics[j] = transform(to_body, exponential(2. * transform(to_frame, kappa)));
  }
}

template <bool has_directions, bool is_thermal>
std::optional<double>
FlowRulePlasticity<has_directions, is_thermal>::flow_slope(const History &history,
                                                           const double temperature) const {
  if constexpr (is_thermal) {
    const double alpha = history.equivalent_plastic_strain, at = temperature + history.temperature_rise,
                 stress = flow_->stress(alpha), slope = flow_->slope(alpha),
                 at_rest = flow_->plastic_work_at_rest(alpha),
                 rate_factor = at_rest > 0. ? flow_->plastic_work(alpha, history.flow) / at_rest : 1.,
                 theta = rule_.thermal->value_at(alpha, at);
    const auto [theta_slope, theta_hardening] = rule_.thermal->slopes_at(alpha, at);
    const double of_backstress = described_flow_->stress(alpha) - stress,
                 heat = rule_.heating * (theta * rate_factor * stress + of_backstress);
    return rate_factor * (theta * slope + theta_slope * stress * heat + theta_hardening * stress) +
           described_flow_->slope(alpha) - slope;
  } else
    return {};
}

template <bool has_directions, bool is_thermal>
std::vector<StateField> FlowRulePlasticity<has_directions, is_thermal>::fields() const {
  std::vector<StateField> result = {symmetric_field("inverse plastic metric"),
                                    {"equivalent plastic strain", 1},
                                    {flow_state_name, flow_->n_state()},
                                    {"further dissipation", 1}};
  if (is_thermal)
    result.push_back({"temperature rise", 1});
  if (!rule_.backstress.empty())
    result.push_back(symmetric_field("backstress"));
  for (std::size_t j = 0; j < rule_.backstress.size(); ++j)
    result.push_back(symmetric_field("inverse metric of backstress " + std::to_string(j + 1)));
  return result;
}

namespace {

/// Copies numbers of a history from or to an array, in the order of its fields.
template <class History, class Copy>
void copy_numbers(History &history, const std::size_t n_flow, const bool is_thermal,
                  const std::size_t n_terms, const Copy &copy) {
  const auto copy_tensor = [&](auto &tensor) {
    for (unsigned int i = 0; i < 6; ++i)
      copy(tensor.access_raw_entry(i));
  };
  copy_tensor(history.inverse_plastic_metric);
  copy(history.equivalent_plastic_strain);
  for (std::size_t i = 0; i < n_flow; ++i)
    copy(history.flow[i]);
  copy(history.dissipated);
  if (is_thermal)
    copy(history.temperature_rise);
  if (n_terms > 0)
    copy_tensor(history.backstress);
  for (std::size_t j = 0; j < n_terms; ++j)
    copy_tensor(history.inverse_metrics[j]);
}

} // namespace

template <bool has_directions, bool is_thermal>
void FlowRulePlasticity<has_directions, is_thermal>::store(const History &history, double *numbers) const {
  copy_numbers(history, flow_->n_state(), is_thermal, rule_.backstress.size(),
               [&](const double number) { *numbers++ = number; });
}

template <bool has_directions, bool is_thermal>
typename FlowRulePlasticity<has_directions, is_thermal>::History
FlowRulePlasticity<has_directions, is_thermal>::restore(const double *numbers) const {
  History history;
  copy_numbers(history, flow_->n_state(), is_thermal, rule_.backstress.size(),
               [&](double &number) { number = *numbers++; });
  return history;
}

template class FlowRulePlasticity<false, true>;
template class FlowRulePlasticity<true, false>;
template class FlowRulePlasticity<true, true>;

} // namespace billet
