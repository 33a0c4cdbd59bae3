// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_SAMPLE_FORMULATIONS_H
#define BILLET_TESTS_SAMPLE_FORMULATIONS_H

#include "billet/material/elasticity.h"
#include "billet/material/hardening.h"
#include "billet/mechanics/explicit_block.h"

#include <stdexcept>
#include <string>

/// Pairs of elements and laws, as the tests name them.
namespace billet::testing {

// Names of elasticities in the program's table.
inline const std::string hencky = "Hencky", neo_hookean = "neo-Hookean", hypoelastic = "hypoelastic";

/// Moduli and, unless elastic, hardening.
struct MaterialLaw {
  struct Flow {
    Flow() = default;
    Flow(SharedFlow flow) : stress(std::move(flow)) {}
    template <class Law> Flow(const Law &law) : stress(make_hardening(law)) {}

    SharedFlow stress;
  };

  ElasticModuli elastic;
  Flow hardening;

  bool is_plastic() const { return hardening.stress != nullptr; }
};

/// Returns the law with an elasticity that two moduli determine.
inline SharedLaw make_law(const MaterialLaw &material, const std::string &elasticity) {
  const ElasticityType *type = elasticity_types().find(elasticity);
  SharedLaw law = type != nullptr ? type->find_law(material.elastic, material.hardening.stress) : nullptr;
  if (law == nullptr)
    throw std::logic_error("no law of the elasticity '" + elasticity + "' with two moduli");
  return law;
}

/// An element, and the elasticity of the law that it is used with.
struct LawFormulation : ElementFormulation {
  std::string elasticity = hencky;
};

/// The same of explicit dynamics.
struct Formulation : ExplicitFormulation {
  std::string elasticity = hencky;
};

inline std::unique_ptr<ElementBlock> make_element_block(const MaterialLaw &material,
                                                        const LawFormulation &formulation = {}) {
  return billet::make_element_block(make_law(material, formulation.elasticity), formulation);
}

inline std::unique_ptr<ExplicitBlock> make_explicit_block(const MaterialLaw &material, const double density,
                                                          const Formulation &formulation) {
  return billet::make_explicit_block(make_law(material, formulation.elasticity), density, formulation);
}

inline bool has_symmetric_tangent(const LawFormulation &formulation, const bool is_plastic) {
  const MaterialLaw law =
      is_plastic ? MaterialLaw{{1., 1.}, LinearHardening{1., 0.}} : MaterialLaw{{1., 1.}, {}};
  return make_law(law, formulation.elasticity)->has_symmetric_moduli();
}

} // namespace billet::testing

#endif
