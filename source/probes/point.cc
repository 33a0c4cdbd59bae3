// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/probes/probe.h"

namespace billet {

ProbeType point_type();

ProbeType point_type() {
  return {"point", "quantities at a point of a body",
          with_probed_axes({probed_body(), probed_point(), probed_place(), probed_quantities()}),
          [](const TypeInput &input) {
            Probe probe{ProbedPoints{{dealii::Point<3>(input.vector("Point"))}, read_place(input)}};
            probe.axes = Axes(input);
            probe.quantities = read_quantities(input);
            probe.statistics = {ProbeStatistic::each};
            return probe;
          }};
}

} // namespace billet
