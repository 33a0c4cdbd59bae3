// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/forming_limits.h"

#include "billet/algebra/gather.h"
#include "billet/mechanics/sheet_strains.h"
#include "billet/output/element_fields.h"

#include <algorithm>
#include <array>
#include <sstream>

namespace billet {

namespace {

const DiagnosticKind beyond_forming_limit(
    "beyond-forming-limit", Severity::warning,
    "The major strain in the plane of a sheet exceeds the 'Forming limit' of its material at the end of the "
    "run. The sheet necks or cracks, which the model does not describe.",
    "Set 'Sheet strains = true' in Output to see where; draw less deeply, or change holder, friction or "
    "radii");

/// Ratio of strain to limit, and the place.
using Worst = std::array<double, 4>;

Worst find_worst(const Discretization &discretization, const std::size_t body, const FormingLimit &limit,
                 const Vector &displacements) {
  Worst worst{};
  for (const Element &element : discretization.elements(body)) {
    const ElementVectors positions = nodal_positions(element.cell),
                         moved = gather(displacements, element.dofs);
    const SheetStrains strains =
        compute_sheet_strains(mean_deformation_gradient(positions, moved), find_sheet_normal(positions));
    const double ratio = strains.major / limit.major_strain(strains.minor);
    if (!(ratio > worst[0]))
      continue;
    worst = {ratio, 0., 0., 0.};
    for (unsigned int i = 0; i < n_element_dofs; ++i)
      worst[1 + i % 3] += (positions[i] + moved[i]) / n_element_nodes;
  }
  const auto of_ranks = all_gather(discretization.communicator(), worst);
  return *std::max_element(of_ranks.begin(), of_ranks.end());
}

} // namespace

DiagnosticList check_forming_limits(const Scene &scene, const Solution &solution) {
  DiagnosticList messages;
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    const auto &limit = scene.parameters().bodies[b].material.forming_limit;
    if (limit == nullptr)
      continue;
    const auto [ratio, x, y, z] =
        find_worst(solution.discretization(), b, *limit, solution.state().displacements);
    if (!(ratio > 1.))
      continue;
    std::ostringstream text;
    text.precision(3);
    text << "The major strain is " << ratio << " times the forming limit";
    messages.push_back(Diagnostic(beyond_forming_limit, text.str())
                           .body(scene.bodies()[b].name)
                           .at(dealii::Tensor<1, 3>({x, y, z}))
                           .measure("strain / limit", ratio));
  }
  return messages;
}

} // namespace billet
