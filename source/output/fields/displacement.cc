// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/field_quantity.h"

namespace billet {

NodalQuantity displacement_quantity();

NodalQuantity displacement_quantity() {
  return {"displacement", "length",
          [](const Scene &, const Discretization &, const Solution &solution) -> std::vector<NodalField> {
            return {{{"displacement", "displacement", "displacement"}, true, solution.state().displacements}};
          }};
}

} // namespace billet
