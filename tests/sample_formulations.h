// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_SAMPLE_FORMULATIONS_H
#define BILLET_TESTS_SAMPLE_FORMULATIONS_H

#include "billet/material/elasticity.h"
#include "billet/material/hardening.h"
#include "billet/mechanics/explicit_block.h"

#include <array>

/// Pairs of elements and laws, as the tests name them.
namespace billet::testing {

enum class Kinematics { hencky, neo_hookean, hypoelastic };
inline constexpr std::array all_kinematics = {Kinematics::hencky, Kinematics::neo_hookean,
                                              Kinematics::hypoelastic};

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

inline SharedLaw make_law(const MaterialLaw &material, const Kinematics kinematics) {
  switch (kinematics) {
  case Kinematics::hencky:
    return make_hencky_law(material.elastic, material.hardening.stress);
  case Kinematics::neo_hookean:
    return make_neo_hookean_law(material.elastic, material.hardening.stress);
  case Kinematics::hypoelastic:
    return make_hypoelastic_law(material.elastic, material.hardening.stress);
  }
  return nullptr;
}

inline std::string name_of(const Kinematics kinematics) {
  return make_law({{1., 1.}, {}}, kinematics)->name();
}

/// An element, and the law that it is used with.
struct LawFormulation : ElementFormulation {
  using Kinematics = testing::Kinematics;

  Kinematics kinematics = Kinematics::hencky;
};

/// The same of explicit dynamics.
struct Formulation : ExplicitFormulation {
  using Kinematics = testing::Kinematics;

  Kinematics kinematics = Kinematics::hencky;
};

inline std::unique_ptr<ElementBlock> make_element_block(const MaterialLaw &material,
                                                        const LawFormulation &formulation = {}) {
  return billet::make_element_block(make_law(material, formulation.kinematics), formulation);
}

inline std::unique_ptr<ExplicitBlock> make_explicit_block(const MaterialLaw &material, const double density,
                                                          const Formulation &formulation) {
  return billet::make_explicit_block(make_law(material, formulation.kinematics), density, formulation);
}

inline bool has_symmetric_tangent(const LawFormulation &formulation, const bool is_plastic) {
  const MaterialLaw law =
      is_plastic ? MaterialLaw{{1., 1.}, LinearHardening{1., 0.}} : MaterialLaw{{1., 1.}, {}};
  return make_law(law, formulation.kinematics)->has_symmetric_moduli();
}

} // namespace billet::testing

#endif
