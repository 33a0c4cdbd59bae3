// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/probes/probe.h"

namespace billet {

ProbeType draw_in_type();

namespace {

Probe make_draw_in(const TypeInput &input) {
  const bool has_direction = input.is_set("Direction");
  if (has_direction && input.is_set("Centre"))
    input.reject("Centre", "no value: 'Direction' says which way the edge travels");
  ProbedTravel travel{input.direction("Normal"), {}, {}};
  if (has_direction) {
    constexpr double least_part = 1e-6;
    const dealii::Tensor<1, 3> d = input.direction("Direction");
    const dealii::Tensor<1, 3> in_plane = d - (d * travel.normal) * travel.normal;
    if (!(in_plane.norm() > least_part))
      input.reject("Direction", "a direction that is not along 'Normal'");
    travel.direction = in_plane / in_plane.norm();
  } else
    travel.centre = input.vector("Centre");
  Probe probe{travel};
  probe.statistics = read_statistics(input, false);
  return probe;
}

} // namespace

ProbeType draw_in_type() {
  return {"draw-in",
          "travel of the nodes of an edge in the plane of the sheet, along 'Direction' or towards 'Centre'",
          {probed_body(),
           probed_faces(),
           {"Normal", "0, 0, 1", TypeParameter::Kind::text, "Normal 'x, y, z' of the sheet's plane."},
           {"Direction", "", TypeParameter::Kind::text,
            "Direction 'x, y, z' of the travel; its part along 'Normal' does not count. Empty: towards "
            "'Centre'."},
           {"Centre", "0, 0, 0", TypeParameter::Kind::text,
            "Point 'x, y, z'. The travel is the loss of distance from it in the plane. [length]"},
           probed_statistics()},
          make_draw_in};
}

} // namespace billet
