// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_quantity.h"
#include "billet/output/probe_reader.h"

namespace billet {

HistoryQuantity probes_quantity();

HistoryQuantity probes_quantity() {
  return {"probes",
          {{"PROBE.VALUE", "What the scene's 'Probes' read; 'billet --list probes' lists them."}},
          [](const Scene &scene) { return probe_columns(scene); },
          [](const HistorySample &sample) { return sample.probes; }};
}

} // namespace billet
