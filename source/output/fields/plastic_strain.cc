// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/field_quantity.h"

#include <algorithm>

namespace billet {

ElementQuantity plastic_strain_quantity();

namespace {

constexpr const char *name = "equivalent plastic strain";

/// Whether the law has it: by its plasticity, or as a state variable of this name of a user's
/// subroutine.
bool has_plastic_strain(const PointLaw &law) {
  const std::vector<StateField> fields = law.fields();
  return law.has_plasticity() || std::any_of(fields.begin(), fields.end(),
                                             [](const StateField &field) { return field.name == name; });
}

} // namespace

ElementQuantity plastic_strain_quantity() {
  return {name,
          "",
          {"equivalent_plastic_strain"},
          true,
          [](const Scene &scene) {
            return scene.parameters().output.plastic_strain &&
                   std::any_of(scene.bodies().begin(), scene.bodies().end(),
                               [](const Body &body) { return has_plastic_strain(*body.law); });
          },
          [](const ElementAverage &average) -> std::vector<double> {
            return {average.equivalent_plastic_strain};
          }};
}

} // namespace billet
