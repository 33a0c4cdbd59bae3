// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_penalties.h"

#include <algorithm>
#include <optional>

namespace billet {

FacetPenalties::FacetPenalties(FacetContactParts &parts, const FacetMeasures &measures)
    : ContactPenalties(parts.settings.penetration_tolerance, parts.settings.max_stiffening), parts_(parts),
      measures_(measures) {}

void FacetPenalties::augment() {
  if (parts_.friction) // uses the offsets so far
    parts_.friction->augment();
  parts_.offsets.augmentation.augment(parts_.slaves.size(), [&](const std::size_t s) {
    const SlaveState &state = parts_.touching[s];
    return state.presses() ? std::optional<double>(state.contact.gap) : std::nullopt;
  });
}

void FacetPenalties::take_back_augmentation() {
  parts_.offsets.augmentation.restart();
  if (parts_.friction)
    parts_.friction->restart();
}

std::vector<double> FacetPenalties::elastic_slips() const {
  std::vector<double> slips(parts_.touching.size());
  if (parts_.friction)
    for (std::size_t s = 0; s < slips.size(); ++s)
      slips[s] = parts_.friction->elastic_slip(s);
  return slips;
}

ContactSprings FacetPenalties::compute_springs() const {
  const std::vector<double> slips = elastic_slips();
  ContactSprings springs;
  springs.normal.of_nodes.resize(parts_.touching.size());
  springs.tangential.of_nodes.resize(parts_.touching.size());
  for (std::size_t s = 0; s < parts_.touching.size(); ++s) {
    const SlaveState &state = parts_.touching[s];
    if (!state.presses())
      continue;
    springs.add(s, state.own_area * state.traction.traction, state.contact.normal,
                state.own_area * parts_.penalties[s].normal * parts_.touching.penetration_of(s),
                state.own_area * parts_.penalties[s].tangential * slips[s]);
  }
  return springs;
}

void FacetPenalties::scale(const double normal, const double tangential) {
  parts_.penalties.scale(normal, tangential);
  parts_.offsets.augmentation.scale(normal);
}

void FacetPenalties::scale_under_load(const double normal, const double tangential) {
  scale(normal, tangential);
  parts_.offsets.penetrations.start(parts_.slaves.size());
  for (std::size_t s = 0; s < parts_.touching.size(); ++s) {
    SlaveState &state = parts_.touching[s];
    if (!state.has_pressure())
      continue;
    parts_.offsets.penetrations.add(s, -((1. - 1. / normal) * state.contact.gap));
    state.contact.gap /= normal;
    parts_.start.divide_penetration(s, normal);
  }
}

double FacetPenalties::max_spring() const {
  double maximum = 0.;
  for (std::size_t s = 0; s < parts_.slaves.size(); ++s)
    maximum = std::max(maximum, std::max(parts_.penalties[s].normal, parts_.penalties[s].tangential) *
                                    parts_.slaves.facet_size(s) * parts_.slaves.facet_size(s));
  return maximum;
}

double FacetPenalties::augmentation_gap() const {
  double worst = measures_.penetration().of_facet;
  const std::vector<double> slips = elastic_slips();
  for (std::size_t s = 0; s < slips.size(); ++s)
    worst = std::max(worst, slips[s] / parts_.slaves.facet_size(s));
  return worst;
}

} // namespace billet
