// SPDX-License-Identifier: LGPL-2.1-or-later
// The certification of laws: every built-in law passes, and a law with one planted error of each kind fails
// the trial for it, and no other trial where errors do not show in others. Units. Ranges of ellipticity
// against the laws' own (M7).

#include "rubber_laws.h"

#include "billet/material/certificate.h"
#include "billet/material/flow_rule.h"
#include "billet/material/hypoelastic.h"
#include "billet/material/law_trials.h"

#include <limits>
#include <set>

namespace certificate_test {

using namespace billet;
using namespace billet::testing;

namespace {

CertificationSettings settings() {
  CertificationSettings result;
  result.dt = 1e-3;
  return result;
}

std::set<std::string> failures(const Certificate &certificate) {
  std::set<std::string> names;
  for (const Finding &finding : certificate.findings)
    if (finding.verdict == Finding::Verdict::failed)
      names.insert(finding.property);
  return names;
}

std::string join(const std::set<std::string> &names) {
  std::string all;
  for (const std::string &name : names)
    all += (all.empty() ? "" : ", ") + name;
  return all;
}

void require_pass(const std::string &name, const SharedLaw &law) {
  const Certificate certificate = certify(*law, settings());
  check(name + (certificate.has_passed() ? "" : " fails in " + join(failures(certificate))),
        certificate.has_passed() && certificate.findings.size() >= 9 && certificate.ranges.size() == 5 &&
            certificate.seconds < 60.);
}

void test_built_in_laws() {
  using Maker = SharedLaw (*)(const ElasticModuli &, SharedFlow);
  const std::vector<std::pair<std::string, Maker>> makers = {{"Hencky", &make_hencky_law},
                                                             {"neo-Hookean", &make_neo_hookean_law},
                                                             {"hypoelastic", &make_hypoelastic_law}};
  for (const auto &[name, make] : makers) {
    const auto &law = make;
    const std::string &label = name;
    require_pass(label + ", elastic", law(steel, nullptr));
    for_each_hardening([&](const std::string &hardening, const auto &flow) {
      require_pass(label + ", " + hardening, law(steel, make_hardening(flow)));
    });
    require_pass(label + ", rate factor",
                 law(steel, make_flow_stress(make_hardening(linear), cowper_symonds(40., 5.))));
  }
  FlowRule chaboche;
  chaboche.backstress = {{60000., 600.}, {12000., 100.}, {1500., 0.}};
  require_pass("Chaboche", make_hencky_law(steel, make_hardening(voce), chaboche));
  // Viscous with each energy and with each volumetric law, not with each pair of them.
  const PronySeries series{{0.3, 0.2}, {0.01, 1.}};
  const auto &volumes = volumetric_law_types();
  const auto n_types = static_cast<std::size_t>(std::distance(volumes.begin(), volumes.end()));
  std::size_t n_energies = 0;
  for (const auto &[name, energy] : rubber_energies()) {
    std::size_t n_volumes = 0;
    for (const auto &type : volumes) {
      const std::string label = name + ", volume " + type.name;
      require_pass(label, make_hyperelastic_law(HyperelasticLaw(name, energy, volume(type.name)), {}));
      if (n_volumes++ == n_energies % n_types)
        require_pass(label + ", viscous",
                     make_hyperelastic_law(HyperelasticLaw(name, energy, volume(type.name)), series));
    }
    ++n_energies;
  }
}

enum class Error {
  none,
  fixed_direction, ///< the stress has a part that does not turn
  tangent,         ///< too stiff in shear
  asymmetry,
  stored,     ///< too much stored energy
  dissipated, ///< too much dissipated energy
  step,       ///< the stress depends on the length of the step
  refusal,    ///< no stress for large strains
  no_number,  ///< the same, without saying so
  leak,       ///< the state changes with every update
  hidden,     ///< the stress depends on the last point
  fields      ///< names for a part of the state alone
};

/// Hencky's law with J2 plasticity and a planted error.
class FaultyLaw final : public SpatialLaw {
public:
  explicit FaultyLaw(const Error error)
      : error_(error), law_(std::dynamic_pointer_cast<const SpatialLaw>(
                           make_hencky_law(steel, make_hardening(LinearHardening{700., 3000.})))) {}

  std::string name() const override { return "faulty"; }
  const ElasticModuli &elastic() const override { return law_->elastic(); }
  std::shared_ptr<const FlowStress> shared_flow_stress() const override { return law_->shared_flow_stress(); }
  bool has_symmetric_moduli() const override { return true; }
  bool is_rate_form() const override { return false; }
  bool has_exact_dissipation() const override { return true; }
  std::vector<StateField> fields() const override {
    auto fields = law_->fields();
    if (error_ == Error::fields)
      fields.erase(fields.begin());
    return fields;
  }
  std::size_t n_state() const override { return law_->n_state(); }
  void initialize(double *state) const override { law_->initialize(state); }
  double stored_energy(const Tensor<2, 3> &F, const double J, const double *state) const override {
    return (error_ == Error::stored ? 3. : 1.) * law_->stored_energy(F, J, state);
  }
  double dissipated_energy(const double *state) const override {
    return (error_ == Error::dissipated ? 1.2 : 1.) * law_->dissipated_energy(state);
  }
  double equivalent_plastic_strain(const double *state) const override {
    return law_->equivalent_plastic_strain(state);
  }
  void set_stress(const Tensor<2, 3> &F, const SymmetricTensor<2, 3> &deviator, const double strain,
                  double *state) const override {
    law_->set_stress(F, deviator, strain, state);
  }
  std::optional<double> min_wave_stiffness(const std::array<double, 3> &) const override { return {}; }

  bool update(const Tensor<2, 3> &F, const double J, const PointStep &step, const double *state_n,
              double *state, SymmetricTensor<2, 3> &tau, SpatialModuli *moduli) const override {
    constexpr double large = 0.06;
    if (!law_->update(F, J, step, state_n, state, tau, moduli))
      return false;
    const double size = (symmetrize(transpose(F) * F) - dealii::unit_symmetric_tensor<3>()).norm();
    switch (error_) {
    case Error::fixed_direction:
      tau[0][0] *= 1.001;
      break;
    case Error::tangent:
      if (moduli != nullptr)
        for (unsigned int i = 3; i < 6; ++i)
          (*moduli)[i][i] *= 1.2;
      break;
    case Error::asymmetry:
      if (moduli != nullptr)
        (*moduli)[0][1] *= 1.0001;
      break;
    case Error::step:
      tau *= 1. + 1e-6 / step.dt;
      break;
    case Error::refusal:
      return size < large;
    case Error::no_number:
      if (size > large)
        tau[1][2] = std::numeric_limits<double>::quiet_NaN();
      break;
    case Error::leak:
      state[0] *= 1. + 1e-6;
      break;
    case Error::hidden:
      tau *= 1. + 1e-9 * last_;
      last_ = size;
      break;
    default:
      break;
    }
    return true;
  }

private:
  Error error_;
  std::shared_ptr<const SpatialLaw> law_;
  mutable double last_ = 0.;
};

/// The trial of an error must fail; so may `others`, which the error shows in, too.
void require_failure(const Error error, const std::string &property, const std::set<std::string> &others) {
  const std::set<std::string> found = failures(certify(FaultyLaw(error), settings()));
  bool is_expected = found.count(property) > 0;
  for (const std::string &name : found)
    is_expected = is_expected && (name == property || others.count(name) > 0);
  check("planted error: " + property + (is_expected ? "" : ", found: " + join(found)), is_expected);
}

void test_planted_errors() {
  const std::string tangent = "tangent", symmetry = "symmetry of the tangent", falls = "dissipation >= 0",
                    balance = "balance of energies", steps = "steps of 1e-6 to 0.5",
                    objectivity = "objectivity", repeated = "repeated stretches", checkpoint = "checkpoint";
  check("the law without an error passes", failures(certify(FaultyLaw(Error::none), settings())).empty());
  require_failure(Error::fixed_direction, objectivity, {});
  require_failure(Error::tangent, tangent, {});
  require_failure(Error::asymmetry, symmetry, {});
  require_failure(Error::stored, falls, {balance});
  require_failure(Error::dissipated, balance, {});
  require_failure(Error::step, steps, {balance, falls, repeated});
  require_failure(Error::refusal, steps, {repeated, checkpoint});
  require_failure(Error::no_number, steps,
                  {objectivity, tangent, symmetry, falls, balance, repeated, checkpoint});
  require_failure(Error::leak, repeated, {balance, falls, steps, tangent});
  require_failure(Error::hidden, checkpoint, {});
  require_failure(Error::fields, checkpoint, {});
}

/// A rate that is the same number in all units is a constant of the law.
void test_units() {
  constexpr double stress = 1e-12, time = 1e3;
  const auto law_with = [](const double of_stress, const double rate) {
    return make_hencky_law(
        {of_stress * steel.bulk, of_stress * steel.shear},
        make_flow_stress(make_hardening(LinearHardening{of_stress * 700., of_stress * 300.}),
                         cowper_symonds(rate, 5.)));
  };
  CertificationSettings in_units = settings();
  in_units.other_units = OtherUnits{law_with(stress, 40. / time), "", stress, time, 1.};
  const SharedLaw law = law_with(1., 40.);
  check("all units follow", failures(certify(*law, in_units)).empty());
  in_units.other_units->law = law_with(stress, 40.);
  check("a rate without a unit", failures(certify(*law, in_units)) == std::set<std::string>{"units"});
  in_units.other_units = OtherUnits{nullptr, "'Constants' has the unit [any unit]"};
  const std::vector<Finding> untried = try_units(*law, in_units);
  check("units that are not known", untried.size() == 1 &&
                                        untried.front().verdict == Finding::Verdict::reported &&
                                        untried.front().remark.find("'Constants'") != std::string::npos);
}

/// The ends of the ranges are those of (M7), to the step of the trial.
void test_ranges() {
  const SharedLaw law = make_hencky_law(steel);
  WorstError error;
  unsigned int n_ends = 0;
  for (const SafeRange &range : find_safe_ranges(*law, settings()))
    if (range.mode == "uniaxial strain" || range.mode == "volume, by its edge") {
      const auto stiffness = [&](const double x) {
        return *law->min_wave_stiffness(range.mode == "uniaxial strain" ? Stretches{x, 1., 1.}
                                                                        : Stretches{x, x, x});
      };
      if (range.is_open_above)
        continue;
      ++n_ends;
      error.add(stiffness(range.maximum) >= -1e-9 && stiffness(range.maximum * std::exp(0.03)) < 0. ? 0.
                                                                                                    : 1.);
    }
  check("ranges have ends", n_ends == 2);
  check("ends of the ranges", error.value(), 0.);
}

} // namespace

BILLET_TEST(certificate) {
  test_built_in_laws();
  test_planted_errors();
  test_units();
  test_ranges();
}

} // namespace certificate_test
