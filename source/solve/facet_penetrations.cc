// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/facet_penetrations.h"

#include "billet/diagnostic_kinds.h"

#include <sstream>

namespace billet {

DiagnosticList check_facet_penetrations(const Scene &scene, const Solution &solution) {
  constexpr double deep = 0.1; // present lengths of facets
  DiagnosticList diagnostics;
  for (std::size_t p = 0; p < scene.pairs().size(); ++p) {
    const FacetPenetration &penetration = solution.reactions().between_nodes[p];
    if (!(penetration.of_facet > deep))
      continue;
    const ContactPair &pair = scene.pairs()[p];
    constexpr double enough = 0.4; // radii: a quarter turn has four facets
    const double length = penetration.facet_length,
                 radius = length / (8. * penetration.of_facet); // it enters by length²/(8 radius)
    std::ostringstream text, advice;
    text.precision(3);
    advice.precision(3);
    text << "The tool penetrates facets between their nodes by " << penetration.of_facet
         << " of the facets' present length, which is " << length
         << ": bricks are too long for the tool's radius there, of about " << radius
         << ", and forces are too small";
    advice << "Use bricks that are no longer than " << enough * radius << " where they touch, as stretched";
    diagnostics.push_back(Diagnostic(diagnostic::penetration_between_nodes, text.str())
                              .pair(pair.name)
                              .tool(scene.tools()[pair.tool].name())
                              .at(penetration.position)
                              .time(solution.state().time)
                              .measure("penetration / facet length", penetration.of_facet)
                              .value("facet length", length)
                              .value("radius", radius)
                              .advice(advice.str()));
  }
  return diagnostics;
}

} // namespace billet
