// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/tensor_columns.h"
#include "billet/output/element_fields.h"
#include "billet/output/field_quantity.h"

namespace billet {

ElementQuantity strain_quantity();

ElementQuantity strain_quantity() {
  return {"logarithmic strain",
          "",
          strain_columns(),
          false,
          [](const Scene &scene) { return scene.parameters().output.strain; },
          [](const ElementAverage &average) -> std::vector<double> {
            return list_components(logarithmic_strain(average.deformation_gradient));
          }};
}

} // namespace billet
