// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/probes/probe.h"

namespace billet {

ProbeType body_type();

ProbeType body_type() {
  return {
      "body",
      "velocity of the centre of mass, momentum, kinetic and internal energy of a body. The internal energy "
      "is elastic and hourglass energy and plastic work. Static scenes have it alone, and 0 for the others",
      {probed_body()},
      [](const TypeInput &) { return Probe{ProbedMotion{}}; }};
}

} // namespace billet
