// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_quantity.h"

namespace billet {

HistoryQuantity momenta_quantity();

HistoryQuantity momenta_quantity() {
  return {"momenta",
          {{"momentum_x, momentum_y, momentum_z",
            "Dynamic scenes: momentum of all bodies and free tools. [mass velocity]"},
           {"angular_momentum_x, angular_momentum_y, angular_momentum_z",
            "Their angular momentum about the origin. [mass velocity length]"}},
          [](const Scene &scene) -> std::vector<std::string> {
            if (!scene.parameters().scheme().has_inertia)
              return {};
            return {"momentum_x",         "momentum_y",         "momentum_z",
                    "angular_momentum_x", "angular_momentum_y", "angular_momentum_z"};
          },
          [](const HistorySample &sample) -> std::vector<double> {
            const auto &p = sample.state.momentum, &L = sample.state.angular_momentum;
            return {p[0], p[1], p[2], L[0], L[1], L[2]};
          }};
}

} // namespace billet
