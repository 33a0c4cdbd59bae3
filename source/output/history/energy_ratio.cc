// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_quantity.h"

namespace billet {

HistoryQuantity energy_ratio_quantity();

HistoryQuantity energy_ratio_quantity() {
  return {"kinetic to internal energy",
          {{"kinetic_to_internal",
            "Dynamic scenes: kinetic energy over the energy in elements, stored or dissipated by yielding."}},
          [](const Scene &scene) -> std::vector<std::string> {
            if (!scene.parameters().scheme().has_inertia)
              return {};
            return {"kinetic_to_internal"};
          },
          [](const HistorySample &sample) -> std::vector<double> {
            const EnergyLedger &energies = sample.state.energies;
            const double internal = energies.of_elements();
            return {internal > 0. ? energies.kinetic / internal : 0.};
          }};
}

} // namespace billet
