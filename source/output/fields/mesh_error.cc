// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/field_quantity.h"

namespace billet {

ElementQuantity mesh_error_quantity_of_elements();

ElementQuantity mesh_error_quantity_of_elements() {
  return {"error of the mesh so far, over the mean work of deformation",
          "",
          {"mesh_error"},
          false,
          [](const Scene &) { return true; },
          [](const ElementAverage &average) -> std::vector<double> { return {average.mesh_error}; }};
}

} // namespace billet
