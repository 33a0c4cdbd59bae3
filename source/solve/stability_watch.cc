// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/stability_watch.h"

#include "billet/algebra/gather.h"
#include "billet/diagnostic_kinds.h"
#include "billet/material/elasticity.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <sstream>

namespace billet {

namespace {

/// Returns ∂x/∂ξ at the centre of a brick, with nodes in deal.II's order.
dealii::Tensor<2, 3> middle_jacobian(const ElementVectors &x) {
  dealii::Tensor<2, 3> result;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int j = 0; j < 3; ++j)
      for (unsigned int i = 0; i < 3; ++i)
        result[i][j] += ((a >> j & 1U) != 0 ? 0.25 : -0.25) * x[3 * a + i];
  return result;
}

Stretches principal_stretches(const dealii::Tensor<2, 3> &F) {
  const auto squares = dealii::eigenvalues(dealii::symmetrize(dealii::transpose(F) * F));
  return {std::sqrt(std::max(0., squares[0])), std::sqrt(std::max(0., squares[1])),
          std::sqrt(std::max(0., squares[2]))};
}

/// Returns what to do: the first elasticity with the same moduli that is stable there; empty if
/// there is none.
std::string advise(const PointLaw &law, const Stretches &stretches) {
  for (const ElasticityType &type : elasticity_types()) {
    const SharedLaw other = type.name != law.name() ? type.find_law(law.elastic()) : nullptr;
    if (other != nullptr && other->min_wave_stiffness(stretches).value_or(-1.) > 0.)
      return "Choose 'Elasticity = " + type.name + "', which is stable there, or reduce the strains";
  }
  return "";
}

} // namespace

StabilityWatch::StabilityWatch(const Scene &scene, const Discretization &discretization)
    : discretization_(discretization) {
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    const Body &body = scene.bodies()[b];
    if (body.law->min_wave_stiffness({1., 1., 1.}))
      bodies_.push_back({b, body.name, body.law, find_safe_range(*body.law), false});
  }
}

StabilityWatch::Range StabilityWatch::find_safe_range(const PointLaw &law) {
  // Most elements are not strained further, and most laws are stable there for any Poisson's ratio.
  constexpr std::array<Range, 3> ranges{{{0.75, 1.3}, {0.9, 1.1}, {0.98, 1.02}}};
  constexpr unsigned int n = 4; // stretches of a range that are tried
  const auto is_stable = [&](const Range &range) {
    const auto stretch = [&](const unsigned int i) {
      return range.least + i * (range.largest - range.least) / (n - 1);
    };
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j <= i; ++j)
        for (unsigned int k = 0; k <= j; ++k)
          if (law.min_wave_stiffness({stretch(i), stretch(j), stretch(k)}).value_or(-1.) < 0.)
            return false;
    return true;
  };
  const auto *safe = std::find_if(ranges.begin(), ranges.end(), is_stable);
  return safe == ranges.end() ? Range{1., 1.} : *safe;
}

DiagnosticList StabilityWatch::check(const SolutionState &state) {
  DiagnosticList messages;
  for (Watched &watched : bodies_) {
    if (watched.is_unstable)
      continue;
    const auto [stiffness, stretches] = find_weakest(watched, state.displacements);
    if (!(stiffness < 0.))
      continue;
    watched.is_unstable = has_unstable_bodies_ = true;
    std::ostringstream text;
    text.precision(2);
    text << "The law loses its ellipticity at principal stretches of " << stretches[2] << ", " << stretches[1]
         << " and " << stretches[0] << "; results depend on the mesh";
    messages.push_back(Diagnostic(diagnostic::unstable_law, text.str())
                           .body(watched.name)
                           .time(state.time)
                           .advice(advise(*watched.law, stretches)));
  }
  return messages;
}

StabilityWatch::Weakest StabilityWatch::find_weakest(const Watched &watched,
                                                     const Vector &displacements) const {
  Weakest weakest = {1., {1., 1., 1.}};
  for (const Element &element : discretization_.elements(watched.body)) {
    const dealii::Tensor<2, 3> J = middle_jacobian(nodal_positions(element.cell));
    const Stretches stretches =
        principal_stretches((J + middle_jacobian(gather(displacements, element.dofs))) * dealii::invert(J));
    if (stretches[2] > watched.safe.least && stretches[0] < watched.safe.largest)
      continue;
    const double stiffness = watched.law->min_wave_stiffness(stretches).value_or(1.);
    if (stiffness < weakest.stiffness)
      weakest = {stiffness, stretches};
  }
  const auto of_ranks = all_gather(discretization_.communicator(),
                                   std::array<double, 4>{weakest.stiffness, weakest.stretches[0],
                                                         weakest.stretches[1], weakest.stretches[2]});
  const auto &minimum = *std::min_element(of_ranks.begin(), of_ranks.end());
  return {minimum[0], {minimum[1], minimum[2], minimum[3]}};
}

} // namespace billet
