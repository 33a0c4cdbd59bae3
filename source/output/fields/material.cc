// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/field_quantity.h"

namespace billet {

ElementQuantity material_quantity();

ElementQuantity material_quantity() {
  ElementQuantity quantity{"number of the material",
                           "",
                           {"material"},
                           false,
                           [](const Scene &) { return true; },
                           [](const ElementAverage &average) -> std::vector<double> {
                             return {static_cast<double>(average.material)};
                           }};
  quantity.is_number = true;
  return quantity;
}

} // namespace billet
