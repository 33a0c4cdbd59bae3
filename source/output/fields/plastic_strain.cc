// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/field_quantity.h"

namespace billet {

ElementQuantity plastic_strain_quantity();

ElementQuantity plastic_strain_quantity() {
  return {"equivalent plastic strain",
          "",
          {"equivalent_plastic_strain"},
          true,
          [](const Scene &scene) {
            return scene.parameters().output.plastic_strain && scene.capabilities().plasticity;
          },
          [](const ElementAverage &average) -> std::vector<double> {
            return {average.equivalent_plastic_strain};
          }};
}

} // namespace billet
