// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_FLOW_RULE_H
#define BILLET_MATERIAL_FLOW_RULE_H

#include "billet/material/anisotropy.h"
#include "billet/material/elasticity.h"
#include "billet/material/thermal_factor.h"

#include <memory>
#include <string>
#include <vector>

namespace billet {

/// Term of kinematic hardening in tension, dX = C dε_p − g X dα (Armstrong & Frederick 1966;
/// Chaboche 1986). With g = 0 it is Prager's.
struct BackstressTerm {
  double modulus; ///< C [stress]
  double rate;    ///< g
};

/// Parts of plasticity beside isotropic hardening with von Mises' yield function.
struct FlowRule {
  static constexpr std::size_t max_terms = 8;

  std::vector<BackstressTerm> backstress;
  std::shared_ptr<const Anisotropy> anisotropy; ///< null: von Mises
  std::shared_ptr<const ThermalFactor> thermal; ///< null: no dependence on temperature
  /// Rise of the temperature by dissipated energy per volume [temperature/stress].
  double heating = 0.;

  bool is_plain() const { return backstress.empty() && anisotropy == nullptr && thermal == nullptr; }
  /// Returns a description that follows that of the flow stress, or nothing.
  std::string description() const;

  /// Returns the parameters of 'backstress' in scene files, and reads them.
  static std::vector<TypeParameter> backstress_parameters();
  static std::vector<BackstressTerm> read_backstress(const TypeInput &input);
  /// Returns the parameters of 'heating' in scene files, and reads them. `density` may be 0 without
  /// heating [mass/length^3].
  static std::vector<TypeParameter> heating_parameters();
  static double read_heating(const TypeInput &input, double density);
};

/// Returns the plastic law; null if the elasticity has none with this flow rule.
SharedLaw make_plastic_law(const Elasticity &elasticity, SharedFlow flow, const FlowRule &rule);

/// Returns Hencky's law with this flow rule.
SharedLaw make_hencky_law(const ElasticModuli &elastic, SharedFlow flow, const FlowRule &rule);

} // namespace billet

#endif
