// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_ELASTICITY_H
#define BILLET_MATERIAL_ELASTICITY_H

#include "billet/material/point_law.h"
#include "billet/registered_type.h"

#include <memory>
#include <string>

namespace billet {

using SharedLaw = std::shared_ptr<const PointLaw>;
using SharedFlow = std::shared_ptr<const FlowStress>;

/// Elastic part of a material, with its constants. It makes the law of a body with or without plasticity.
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
};

/// Elasticities that a scene file can name. A new one is a file in source/material/ with a function that
/// returns its type, and its name in the table of elasticity.cc.
using ElasticityType = RegisteredType<std::shared_ptr<const Elasticity>>;
TypeTable<std::shared_ptr<const Elasticity>> &elasticity_types();

// Laws that two moduli determine: Hencky, neo-Hookean, hypoelastic. Without `flow` they are elastic.
SharedLaw make_hencky_law(const ElasticModuli &elastic, SharedFlow flow = nullptr);
SharedLaw make_neo_hookean_law(const ElasticModuli &elastic, SharedFlow flow = nullptr);
SharedLaw make_hypoelastic_law(const ElasticModuli &elastic, SharedFlow flow = nullptr);

/// Returns the law with this name; null if none of the above has it.
SharedLaw make_isotropic_law(const std::string &name, const ElasticModuli &elastic, SharedFlow flow);

/// Returns the elasticity of one of these laws. Throws std::invalid_argument for another name.
std::shared_ptr<const Elasticity> make_isotropic_elasticity(const std::string &name, double young,
                                                            double poisson);

/// Returns the type of such a law; its parameters are Young's modulus and Poisson's ratio.
ElasticityType isotropic_elasticity_type(std::string name, std::string meaning,
                                         SharedLaw (*make)(const ElasticModuli &, SharedFlow));

} // namespace billet

#endif
