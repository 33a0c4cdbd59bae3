// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_quantity.h"

#include <algorithm>

namespace billet {

HistoryQuantity loads_quantity();

HistoryQuantity loads_quantity() {
  return {
      "forces and works of loads",
      {{"BODY.load NAME.force_x, BODY.load NAME.force_y, BODY.load NAME.force_z",
        "Resultant force of a load, spring or dashpot on its body. [force]"},
       {"BODY.load NAME.work",
        "Work that it has done on the body since the start. A spring stores, and a dashpot has dissipated, "
        "its negative. [energy]"}},
      [](const Scene &scene) {
        std::vector<std::string> columns;
        for (std::string name : named_loads(scene)) {
          std::replace_if(
              name.begin(), name.end(), [](const char c) { return c == ',' || c == '"'; }, '_');
          for (const char *quantity : {".force_x", ".force_y", ".force_z", ".work"})
            columns.push_back(name + quantity);
        }
        return columns;
      },
      [](const HistorySample &sample) {
        std::vector<double> values;
        for (const LoadResult &load : sample.reactions.of_loads)
          values.insert(values.end(), {load.force[0], load.force[1], load.force[2], load.work});
        return values;
      }};
}

} // namespace billet
