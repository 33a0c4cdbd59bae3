// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/field_quantity.h"

#include <cmath>

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
            const auto &sigma = average.cauchy_stress;
            return {sigma[0][0],
                    sigma[1][1],
                    sigma[2][2],
                    sigma[0][1],
                    sigma[0][2],
                    sigma[1][2],
                    std::sqrt(1.5) * dealii::deviator(sigma).norm(),
                    -dealii::trace(sigma) / 3.};
          }};
}

} // namespace billet
