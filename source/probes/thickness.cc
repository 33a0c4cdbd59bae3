// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/probes/probe.h"

namespace billet {

ProbeType thickness_type();

ProbeType thickness_type() {
  return {"thickness",
          "distance of faces from the opposite ones, along the normal of the deformed face",
          {probed_body(),
           probed_faces(),
           {"Opposite boundary ids", "", TypeParameter::Kind::text,
            "Boundary ids or names of the faces on the other side, separated by commas."},
           probed_point(),
           probed_statistics()},
          [](const TypeInput &input) {
            ProbedThickness thickness;
            if (input.is_set("Point"))
              thickness.point = dealii::Point<3>(input.vector("Point"));
            if (thickness.point && input.is_set("Values"))
              input.reject("Values", "no value: 'Point' says where the thickness is measured");
            Probe probe{thickness};
            probe.statistics = thickness.point ? std::vector<ProbeStatistic>{ProbeStatistic::each}
                                               : read_statistics(input, false);
            return probe;
          }};
}

} // namespace billet
