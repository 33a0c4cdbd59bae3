// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/element_fields.h"
#include "billet/output/field_quantity.h"

namespace billet {

ElementQuantity stress_quantity();

ElementQuantity stress_quantity() {
  return {"Cauchy stress",
          "stress",
          {"stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_xz", "stress_yz", "von_mises_stress",
           "pressure"},
          true,
          [](const Scene &scene) { return scene.parameters().output.stress; },
          [](const ElementAverage &average) -> std::vector<double> {
            return list_stress(average.cauchy_stress, average.cauchy_stress);
          }};
}

} // namespace billet
