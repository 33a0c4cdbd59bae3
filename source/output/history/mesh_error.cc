// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_quantity.h"

namespace billet {

HistoryQuantity mesh_error_quantity();

HistoryQuantity mesh_error_quantity() {
  return {
      "error of the mesh",
      {{"mesh_error", "Estimated error that the size of the elements makes in the forces so far, relative to "
                      "them (0 while nothing has deformed)."},
       {"geometry_error", "Part of the work of deformation so far in the space between flat facets and the "
                          "curved surfaces that they stand for."}},
      [](const Scene &) -> std::vector<std::string> {
        return {"mesh_error", "geometry_error"};
      },
      [](const HistorySample &sample) -> std::vector<double> {
        return {sample.mesh_error, sample.geometry_error};
      }};
}

} // namespace billet
