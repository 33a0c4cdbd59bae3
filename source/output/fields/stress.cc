// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/tensor_columns.h"
#include "billet/output/element_fields.h"
#include "billet/output/field_quantity.h"

namespace billet {

ElementQuantity stress_quantity();

ElementQuantity stress_quantity() {
  return {"Cauchy stress",
          "stress",
          stress_columns(),
          true,
          [](const Scene &scene) { return scene.parameters().output.stress; },
          [](const ElementAverage &average) -> std::vector<double> {
            return list_stress(average.cauchy_stress, average.cauchy_stress);
          }};
}

} // namespace billet
