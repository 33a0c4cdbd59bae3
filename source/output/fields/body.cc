// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/field_quantity.h"

namespace billet {

ElementQuantity body_quantity();

ElementQuantity body_quantity() {
  ElementQuantity quantity{"number of the body",
                           "",
                           {"body"},
                           false,
                           [](const Scene &) { return true; },
                           [](const ElementAverage &average) -> std::vector<double> {
                             return {static_cast<double>(average.body)};
                           }};
  quantity.is_number = true;
  return quantity;
}

} // namespace billet
