// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/element_fields.h"
#include "billet/output/field_quantity.h"

namespace billet {

ElementQuantity strain_quantity();

ElementQuantity strain_quantity() {
  return {"logarithmic strain",
          "",
          {"logarithmic_strain_xx", "logarithmic_strain_yy", "logarithmic_strain_zz", "logarithmic_strain_xy",
           "logarithmic_strain_xz", "logarithmic_strain_yz"},
          false,
          [](const Scene &scene) { return scene.parameters().output.strain; },
          [](const ElementAverage &average) -> std::vector<double> {
            return list_components(logarithmic_strain(average.deformation_gradient));
          }};
}

} // namespace billet
