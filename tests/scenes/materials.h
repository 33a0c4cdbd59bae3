// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_SCENES_MATERIALS_H
#define BILLET_TESTS_SCENES_MATERIALS_H

#include "../given_values.h"

#include "billet/material/hardening.h"
#include "billet/parameters/body.h"

/// Changes of a body's material.
namespace billet::testing {

/// Sets elasticity and its constants; the flow stress stays.
inline void set_elasticity(parameters::Material &material, const std::string &name, const double young,
                           const double poisson) {
  const GivenValues moduli({{"Young modulus", young}, {"Poisson ratio", poisson}});
  material.elasticity = elasticity_types().find(name)->make(moduli);
  SharedFlow flow = material.law->shared_flow_stress();
  material.law = flow == nullptr ? material.elasticity->make_elastic_law()
                                 : material.elasticity->make_plastic_law(std::move(flow));
}

inline double young_modulus(const parameters::Material &material) {
  return material.elasticity->young_modulus();
}

inline void set_elasticity(parameters::Material &material, const std::string &name) {
  set_elasticity(material, name, young_modulus(material), material.law->elastic().poisson_ratio());
}
inline void set_young_modulus(parameters::Material &material, const double young) {
  set_elasticity(material, material.law->name(), young, material.law->elastic().poisson_ratio());
}
inline void set_poisson_ratio(parameters::Material &material, const double poisson) {
  set_elasticity(material, material.law->name(), young_modulus(material), poisson);
}

inline void make_elastic(parameters::Material &material) {
  material.law = material.elasticity->make_elastic_law();
}
template <class Hardening> void set_hardening(parameters::Material &material, const Hardening &hardening) {
  material.law = material.elasticity->make_plastic_law(make_hardening(hardening));
}

/// The linear hardening that the material has.
inline LinearHardening linear_hardening(const parameters::Material &material) {
  const LaneHardening form = material.law->flow_stress()->lane_form();
  return {form.yield_stress, form.hardening_modulus};
}

} // namespace billet::testing

#endif
