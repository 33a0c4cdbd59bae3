// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_quantity.h"

namespace billet {

HistoryQuantity mesh_error_quantity();

HistoryQuantity mesh_error_quantity() {
  return {"error of the mesh", [](const Scene &) -> std::vector<std::string> { return {"mesh_error"}; },
          [](const HistorySample &sample) -> std::vector<double> { return {sample.mesh_error}; }};
}

} // namespace billet
