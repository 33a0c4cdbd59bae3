// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_ELASTICITY_H
#define BILLET_MATERIAL_ELASTICITY_H

#include "billet/material/point_law.h"
#include "billet/registered_type.h"

#include <memory>
#include <string>
#include <utility>

namespace billet {

using SharedLaw = std::shared_ptr<const PointLaw>;
using SharedFlow = std::shared_ptr<const FlowStress>;

struct FlowRule;

/// Elastic part of a material, with its constants. It makes the law of a body with or without
/// plasticity.
class Elasticity {
public:
  virtual ~Elasticity() = default;

  virtual const ElasticModuli &moduli() const = 0;
  /// Returns Young's modulus of the undeformed solid [stress].
  virtual double young_modulus() const {
    return 9. * moduli().bulk * moduli().shear / (3. * moduli().bulk + moduli().shear);
  }
  virtual SharedLaw make_elastic_law() const = 0;
  /// Returns null if this elasticity does not support plasticity.
  virtual SharedLaw make_plastic_law(SharedFlow flow) const = 0;
  /// Returns the law with a flow rule that is not plain; null if this elasticity does not support
  /// any.
  virtual SharedLaw make_law_with_rule(SharedFlow /*flow*/, const FlowRule & /*rule*/) const {
    return nullptr;
  }
};

/// Elasticities that a scene file can name. A new one is a file in source/material/ with a function
/// that returns its type, and its name in the table of elasticity.cc.
struct ElasticityType : RegisteredType<std::shared_ptr<const Elasticity>> {
  /// Makes the law with two moduli, elastic if the flow stress is null. It returns null if this
  /// elasticity does not support plasticity. A null pointer: two moduli do not determine the law.
  SharedLaw (*make_law)(const ElasticModuli &, SharedFlow) = nullptr;
  /// Whether its plastic law takes a FlowRule; messages and the manual name it.
  bool has_flow_rules = false;
  bool has_volumetric_law = false; ///< whether a scene can choose its volumetric law

  /// Returns the law with these moduli; null if there is none.
  SharedLaw find_law(const ElasticModuli &elastic, SharedFlow flow = nullptr) const {
    return make_law != nullptr ? make_law(elastic, std::move(flow)) : nullptr;
  }
};
TypeTable<std::shared_ptr<const Elasticity>, ElasticityType> &elasticity_types();

// Laws that two moduli determine: Hencky, neo-Hookean, hypoelastic. Without `flow` they are
// elastic.
SharedLaw make_hencky_law(const ElasticModuli &elastic, SharedFlow flow = nullptr);
SharedLaw make_neo_hookean_law(const ElasticModuli &elastic, SharedFlow flow = nullptr);
SharedLaw make_hypoelastic_law(const ElasticModuli &elastic, SharedFlow flow = nullptr);

/// Returns the type of such a law; its parameters are Young's modulus and Poisson's ratio.
/// `make_with_rule`: null if it does not support flow rules.
ElasticityType isotropic_elasticity_type(std::string name, std::string meaning,
                                         SharedLaw (*make)(const ElasticModuli &, SharedFlow),
                                         SharedLaw (*make_with_rule)(const ElasticModuli &, SharedFlow,
                                                                     const FlowRule &) = nullptr);

} // namespace billet

#endif
