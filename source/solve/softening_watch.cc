// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/softening_watch.h"

#include "billet/algebra/gather.h"

#include <algorithm>
#include <array>
#include <sstream>

namespace billet {

namespace {

/// Limits of the warning. The slope is over the flow stress.
struct SofteningWatchLimits {
  static constexpr double strain = 0.01; ///< smaller ones are no bands yet
  static constexpr double slope = -0.05; ///< flatter curves hardly localise
};

const DiagnosticKind softening_by_heat(
    "softening-by-heat", Severity::warning,
    "Heat softens a material that flows by more than it hardens. Its flow stress falls by more than 5 % per "
    "plastic strain of 1. Strains localise in one layer of elements, and results depend on the mesh.",
    "Compare with finer elements, and take no result that they change");

} // namespace

SofteningWatch::SofteningWatch(const Scene &scene) : scene_(scene) {
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    const PointLaw &law = *scene.bodies()[b].law;
    std::vector<double> state(law.n_state());
    law.initialize(state.data());
    if (law.flow_slope(state.data(), 0.))
      bodies_.push_back({b, {}});
  }
}

DiagnosticList SofteningWatch::check(const Solution &solution) {
  DiagnosticList messages;
  for (auto heated = bodies_.begin(); heated != bodies_.end();) {
    const auto [slope, strain] = find_weakest(*heated, solution);
    if (!(slope < SofteningWatchLimits::slope)) {
      ++heated;
      continue;
    }
    has_softened_ = true;
    std::ostringstream text;
    text.precision(2);
    text << "At a plastic strain of " << strain << " the flow stress falls by " << -100. * slope
         << " % per strain of 1";
    messages.push_back(Diagnostic(softening_by_heat, text.str())
                           .body(scene_.bodies()[heated->body].name)
                           .time(solution.state().time)
                           .measure("slope / flow stress", slope));
    heated = bodies_.erase(heated);
  }
  return messages;
}

SofteningWatch::Weakest SofteningWatch::find_weakest(Heated &heated, const Solution &solution) const {
  const Body &body = scene_.bodies()[heated.body];
  const double temperature =
      body.temperature != nullptr ? body.temperature->value(solution.state().time) : 0.;
  const FlowStress *flow = body.law->flow_stress();
  std::vector<double> strains;
  Weakest weakest{0., 0.};
  for (const StateAverages &layers : solution.average_states(heated.body))
    for (const std::vector<double> &state : layers) {
      const double strain = body.law->equivalent_plastic_strain(state.data());
      const std::size_t i = strains.size();
      strains.push_back(strain);
      if (i >= heated.strains.size() ||
          !(strain > heated.strains[i] && strain > SofteningWatchLimits::strain))
        continue;
      const double slope =
          body.law->flow_slope(state.data(), temperature).value_or(0.) / flow->stress(strain);
      if (slope < weakest.slope)
        weakest = {slope, strain};
    }
  heated.strains = std::move(strains);
  const auto of_ranks = all_gather(solution.discretization().communicator(),
                                   std::array<double, 2>{weakest.slope, weakest.strain});
  const auto &minimum = *std::min_element(of_ranks.begin(), of_ranks.end());
  return {minimum[0], minimum[1]};
}

} // namespace billet
