// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/elasticity.h"

#include "billet/material/flow_rule.h"
#include "billet/material/hypoelastic.h"
#include "billet/material/law_adapter.h"
#include "billet/material/neo_hookean.h"
#include "billet/material/viscoelastic.h"

#include <algorithm>

namespace billet {

ElasticityType hencky_type();
ElasticityType neo_hookean_type();
ElasticityType hypoelastic_type();
ElasticityType mooney_rivlin_type();
ElasticityType yeoh_type();
ElasticityType ogden_type();
ElasticityType arruda_boyce_type();

TypeTable<std::shared_ptr<const Elasticity>, ElasticityType> &elasticity_types() {
  static TypeTable<std::shared_ptr<const Elasticity>, ElasticityType> types{
      hencky_type(), neo_hookean_type(), hypoelastic_type(), mooney_rivlin_type(),
      yeoh_type(),   ogden_type(),       arruda_boyce_type()};
  return types;
}

namespace {

/// Elasticity determined by bulk and shear modulus.
class IsotropicElasticity final : public Elasticity {
public:
  using Maker = SharedLaw (*)(const ElasticModuli &, SharedFlow);
  using MakerWithRule = SharedLaw (*)(const ElasticModuli &, SharedFlow, const FlowRule &);

  IsotropicElasticity(const double young, const double poisson, Maker make, MakerWithRule make_with_rule)
      : young_(young), moduli_(ElasticModuli::from_young_poisson(young, poisson)), make_(make),
        make_with_rule_(make_with_rule) {}

  const ElasticModuli &moduli() const override { return moduli_; }
  double young_modulus() const override { return young_; } // the given value, without round-off
  SharedLaw make_elastic_law() const override { return make_(moduli_, nullptr); }
  SharedLaw make_plastic_law(SharedFlow flow) const override { return make_(moduli_, std::move(flow)); }
  SharedLaw make_law_with_rule(SharedFlow flow, const FlowRule &rule) const override {
    return make_with_rule_ != nullptr ? make_with_rule_(moduli_, std::move(flow), rule) : nullptr;
  }

private:
  double young_;
  ElasticModuli moduli_;
  Maker make_;
  MakerWithRule make_with_rule_;
};

template <class Elastic, class Plastic>
SharedLaw make_elastic_law(const char *name, const ElasticModuli &elastic, SharedFlow flow) {
  if (flow == nullptr)
    return std::make_shared<const LawAdapter<Elastic>>(name, Elastic(elastic));
  return std::make_shared<const LawAdapter<Plastic>>(name, Plastic(elastic, std::move(flow)));
}

constexpr const char *hencky = "Hencky", *neo_hookean = "neo-Hookean", *hypoelastic = "hypoelastic";

} // namespace

double PointLaw::bound_stiffness(const dealii::SymmetricTensor<2, 3> &tau) const {
  return bound_elastic_stiffness(elastic(), tau);
}

SharedLaw make_hencky_law(const ElasticModuli &elastic, SharedFlow flow) {
  return make_elastic_law<HenckyElasticity, HenckyPlasticity>(hencky, elastic, std::move(flow));
}
SharedLaw make_neo_hookean_law(const ElasticModuli &elastic, SharedFlow flow) {
  return make_elastic_law<NeoHookeanElasticity, NeoHookeanPlasticity>(neo_hookean, elastic, std::move(flow));
}
SharedLaw make_hypoelastic_law(const ElasticModuli &elastic, SharedFlow flow) {
  return make_elastic_law<HypoelasticElasticity, HypoelasticPlasticity>(hypoelastic, elastic,
                                                                        std::move(flow));
}

ElasticityType isotropic_elasticity_type(std::string name, std::string meaning,
                                         SharedLaw (*make)(const ElasticModuli &, SharedFlow),
                                         SharedLaw (*make_with_rule)(const ElasticModuli &, SharedFlow,
                                                                     const FlowRule &)) {
  using Kind = TypeParameter::Kind;
  ElasticityType type;
  type.name = std::move(name);
  type.meaning = std::move(meaning);
  type.parameters = {{"Young modulus", "0", Kind::number, "E > 0. Young's modulus. [stress]"},
                     {"Poisson ratio", "0.3", Kind::number, "-1 < nu < 0.5. Poisson's ratio."}};
  type.make = [make, make_with_rule](const TypeInput &input) -> std::shared_ptr<const Elasticity> {
    const double young = input.positive("Young modulus"), poisson = input.number("Poisson ratio");
    if (poisson == 0.5)
      input.reject("Poisson ratio", "a number > -1 and < 0.5: the bulk modulus of an incompressible material "
                                    "is infinite. Use 0.499, which elements take without locking");
    if (!(poisson > -1. && poisson < 0.5))
      input.reject("Poisson ratio", "a number > -1 and < 0.5");
    return std::make_shared<const IsotropicElasticity>(young, poisson, make, make_with_rule);
  };
  type.make_law = make;
  type.has_flow_rules = make_with_rule != nullptr;
  return type;
}

ElasticityType hencky_type() {
  return with_prony_series(isotropic_elasticity_type(hencky,
                                                     "multiplicative plasticity with logarithmic strains",
                                                     &make_hencky_law, &make_hencky_law),
                           &make_hencky_energy);
}
ElasticityType neo_hookean_type() {
  return with_prony_series(isotropic_elasticity_type(neo_hookean,
                                                     "Simo's radial return, without an eigenproblem",
                                                     &make_neo_hookean_law),
                           [](const double shear) { return make_ogden_energy({shear}, {2.}); });
}
ElasticityType hypoelastic_type() {
  return isotropic_elasticity_type(hypoelastic,
                                   "stress rates with the final rotation of the step (Bittencourt & Creus "
                                   "1998). The error grows with the step",
                                   &make_hypoelastic_law);
}

} // namespace billet
