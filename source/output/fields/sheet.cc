// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/field_quantity.h"

#include <algorithm>

namespace billet {

ElementQuantity sheet_strains_quantity();
ElementQuantity forming_limit_quantity();

ElementQuantity sheet_strains_quantity() {
  return {"strains of a sheet",
          "",
          {"major_strain", "minor_strain", "thinning"},
          false,
          [](const Scene &scene) { return scene.parameters().output.sheet_strains; },
          [](const ElementAverage &average) -> std::vector<double> {
            return {average.sheet.major, average.sheet.minor, average.sheet.thinning};
          }};
}

ElementQuantity forming_limit_quantity() {
  return {"major strain of a sheet over its forming limit",
          "",
          {"forming_limit_ratio"},
          false,
          [](const Scene &scene) {
            const auto &bodies = scene.parameters().bodies;
            return scene.parameters().output.sheet_strains &&
                   std::any_of(bodies.begin(), bodies.end(), [](const parameters::Body &body) {
                     return body.material.forming_limit != nullptr;
                   });
          },
          [](const ElementAverage &average) -> std::vector<double> {
            return {average.forming_limit > 0. ? average.sheet.major / average.forming_limit : 0.};
          }};
}

} // namespace billet
