// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/probes/probe.h"

namespace billet {

ProbeType set_type();

ProbeType set_type() {
  return {"set", "quantities at the nodes of faces and, of stress and strains, at the middles of these faces",
          with_probed_axes({probed_body(), probed_faces(), probed_quantities(), probed_statistics()}),
          [](const TypeInput &input) {
            Probe probe{ProbedFaces{}};
            probe.axes = Axes(input);
            probe.quantities = read_quantities(input);
            for (const ProbeQuantity &quantity : probe.quantities)
              if (quantity.is_nodal() != probe.quantities.front().is_nodal())
                input.reject("Quantities",
                             "either quantities of nodes (displacement, velocity, position, contact "
                             "pressure) or of elements (stress, strain, plastic strain): a set of both has "
                             "no common sites. Use two probes");
            probe.statistics = read_statistics(input, false);
            return probe;
          }};
}

} // namespace billet
