// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/field_quantity.h"

namespace billet {

NodalQuantity velocity_quantity();

NodalQuantity velocity_quantity() {
  return {"velocity", "length/time",
          [](const Scene &, const Discretization &, const Solution &solution) -> std::vector<NodalField> {
            const Vector &velocities = solution.state().velocities;
            if (velocities.size() == 0) // statics
              return {};
            return {{{"velocity", "velocity", "velocity"}, true, velocities}};
          }};
}

} // namespace billet
