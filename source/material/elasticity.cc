// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/elasticity.h"

#include "billet/material/hypoelastic.h"
#include "billet/material/law_adapter.h"
#include "billet/material/neo_hookean.h"

#include <algorithm>
#include <stdexcept>

namespace billet {

ElasticityType hencky_type();
ElasticityType neo_hookean_type();
ElasticityType hypoelastic_type();

TypeTable<std::shared_ptr<const Elasticity>> &elasticity_types() {
  static TypeTable<std::shared_ptr<const Elasticity>> types{hencky_type(), neo_hookean_type(),
                                                            hypoelastic_type()};
  return types;
}

namespace {

/// Elasticity determined by bulk and shear modulus.
class IsotropicElasticity final : public Elasticity {
public:
  using Maker = SharedLaw (*)(const ElasticModuli &, SharedFlow);

  IsotropicElasticity(const double young, const double poisson, Maker make)
      : young_(young), moduli_(ElasticModuli::from_young_poisson(young, poisson)), make_(make) {}

  const ElasticModuli &moduli() const override { return moduli_; }
  double young_modulus() const override { return young_; } // the given value, without round-off
  SharedLaw make_elastic_law() const override { return make_(moduli_, nullptr); }
  SharedLaw make_plastic_law(SharedFlow flow) const override { return make_(moduli_, std::move(flow)); }

private:
  double young_;
  ElasticModuli moduli_;
  Maker make_;
};

template <class Elastic, class Plastic>
SharedLaw make_law(const char *name, const ElasticModuli &elastic, SharedFlow flow) {
  if (flow == nullptr)
    return std::make_shared<const LawAdapter<Elastic>>(name, Elastic(elastic));
  return std::make_shared<const LawAdapter<Plastic>>(name, Plastic(elastic, std::move(flow)));
}

constexpr const char *hencky = "Hencky", *neo_hookean = "neo-Hookean", *hypoelastic = "hypoelastic";

} // namespace

double PointLaw::bound_stiffness(const dealii::SymmetricTensor<2, 3> &tau) const {
  const double mean = dealii::trace(tau) / 3., mises = std::sqrt(1.5) * dealii::deviator(tau).norm();
  return std::max(3. * elastic().bulk, 2. * elastic().shear) + 4. * std::abs(mean) + 3. * mises;
}

SharedLaw make_hencky_law(const ElasticModuli &elastic, SharedFlow flow) {
  return make_law<HenckyElasticity, HenckyPlasticity>(hencky, elastic, std::move(flow));
}
SharedLaw make_neo_hookean_law(const ElasticModuli &elastic, SharedFlow flow) {
  return make_law<NeoHookeanElasticity, NeoHookeanPlasticity>(neo_hookean, elastic, std::move(flow));
}
SharedLaw make_hypoelastic_law(const ElasticModuli &elastic, SharedFlow flow) {
  return make_law<HypoelasticElasticity, HypoelasticPlasticity>(hypoelastic, elastic, std::move(flow));
}

namespace {

/// Returns the factory of a law; null for an unknown name.
IsotropicElasticity::Maker find_maker(const std::string &name) {
  if (name == hencky)
    return &make_hencky_law;
  if (name == neo_hookean)
    return &make_neo_hookean_law;
  return name == hypoelastic ? &make_hypoelastic_law : nullptr;
}

} // namespace

SharedLaw make_isotropic_law(const std::string &name, const ElasticModuli &elastic, SharedFlow flow) {
  const auto make = find_maker(name);
  return make != nullptr ? make(elastic, std::move(flow)) : nullptr;
}

std::shared_ptr<const Elasticity> make_isotropic_elasticity(const std::string &name, const double young,
                                                            const double poisson) {
  const auto make = find_maker(name);
  if (make == nullptr)
    throw std::invalid_argument("'" + name + "' is no elasticity of two moduli");
  return std::make_shared<const IsotropicElasticity>(young, poisson, make);
}

ElasticityType isotropic_elasticity_type(std::string name, std::string meaning,
                                         SharedLaw (*make)(const ElasticModuli &, SharedFlow)) {
  using Kind = TypeParameter::Kind;
  return {std::move(name),
          std::move(meaning),
          {{"Young modulus", "0", Kind::number, "E > 0. Young's modulus. [stress]"},
           {"Poisson ratio", "0.3", Kind::number, "-1 < nu < 0.5. Poisson's ratio."}},
          [make](const TypeInput &input) -> std::shared_ptr<const Elasticity> {
            const double young = input.positive("Young modulus"), poisson = input.number("Poisson ratio");
            if (!(poisson > -1. && poisson < 0.5))
              input.reject("Poisson ratio", "a number > -1 and < 0.5");
            return std::make_shared<const IsotropicElasticity>(young, poisson, make);
          }};
}

ElasticityType hencky_type() {
  return isotropic_elasticity_type(hencky, "multiplicative plasticity with logarithmic strains",
                                   &make_hencky_law);
}
ElasticityType neo_hookean_type() {
  return isotropic_elasticity_type(neo_hookean, "Simo's radial return, without an eigenproblem",
                                   &make_neo_hookean_law);
}
ElasticityType hypoelastic_type() {
  return isotropic_elasticity_type(hypoelastic,
                                   "stress rates with the final rotation of the step (Bittencourt & Creus "
                                   "1998); the error grows with the step",
                                   &make_hypoelastic_law);
}

} // namespace billet
