// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_measures.h"

#include <algorithm>
#include <array>

namespace billet {

Penetration FacetMeasures::penetration() const {
  Penetration deepest;
  for (std::size_t s = 0; s < parts_.touching.size(); ++s)
    if (parts_.touching[s].has_pressure())
      deepest.add(parts_.touching.penetration_of(s), parts_.slaves.facet_size(s));
  return deepest;
}

double FacetMeasures::excessive_penetration() const {
  double maximum = 0.;
  for (std::size_t s = 0; s < parts_.touching.size(); ++s)
    if (const SlaveState &state = parts_.touching[s]; state.has_pressure())
      maximum = std::max(maximum, parts_.touching.penetration_of(s) /
                                      parts_.surfaces.facet(state.touched.facet).reach);
  return maximum;
}

double FacetMeasures::closing_of_new_contacts() const {
  double maximum = 0.;
  for (std::size_t s = 0; s < parts_.touching.size(); ++s)
    if (const SlaveState &state = parts_.touching[s];
        state.has_pressure() && !(parts_.start.pressed(s).pressure > 0.))
      maximum = std::max(maximum, -(parts_.touching.motion_of(s).displacement * state.contact.normal) /
                                      parts_.slaves.facet_size(s));
  return maximum;
}

double FacetMeasures::max_sliding(const double expected) const {
  const auto &from = parts_.surfaces.positions_n(), &to = parts_.surfaces.positions();
  double any_motion = 0.; // bounds that of a facet that is no longer near
  for (std::size_t i = 0; i < std::min(from.size(), to.size()); ++i)
    any_motion = std::max(any_motion, (to[i] - from[i]).norm());
  double maximum = 0.;
  for (std::size_t s = 0; s < parts_.touching.size(); ++s) {
    if (!(parts_.start.pressed(s).pressure > 0.))
      continue;
    const unsigned int node = parts_.slaves.node(s);
    const double motion = parts_.touching[s].presses() ? parts_.touching.motion_of(s).displacement.norm()
                          : parts_.start.touched(s).exists()
                              ? parts_.touching.motion_after_contact(s).displacement.norm()
                              : (to[node] - from[node]).norm() + any_motion;
    maximum = std::max(maximum, (motion - expected) / parts_.slaves.facet_size(s));
  }
  return maximum;
}

FrictionUse FacetMeasures::friction_use() const {
  FrictionUse use;
  if (parts_.settings.friction)
    for (std::size_t s = 0; s < parts_.touching.size(); ++s)
      if (const SlaveState &state = parts_.touching[s]; state.presses())
        use.add(*parts_.settings.friction, state.traction.status, state.contact.normal, state.own_area,
                state.traction.traction);
  return use;
}

std::vector<SlaveForce> FacetMeasures::slave_forces() const {
  std::vector<SlaveForce> result(parts_.touching.size());
  for (std::size_t s = 0; s < parts_.touching.size(); ++s)
    if (const SlaveState &state = parts_.touching[s]; state.presses())
      result[s] = {state.traction.status, state.own_area * state.traction.traction};
  return result;
}

namespace {

/// Returns the parts of a slave's force that the nodes of its facet count. Beyond an edge of the
/// facet some weights are negative; their nodes count nothing, since no pressure is negative.
std::array<double, 4> counted_parts(const std::array<double, 4> &weights) {
  std::array<double, 4> parts{};
  double sum = 0.;
  for (unsigned int a = 0; a < 4; ++a)
    sum += parts[a] = std::max(0., weights[a]);
  for (double &part : parts)
    part /= sum;
  return parts;
}

} // namespace

std::vector<SurfaceForce> FacetMeasures::nodal_forces() const {
  const SurfaceExchange &exchange = parts_.surfaces.exchange();
  std::vector<double> of_pressures(exchange.n_nodes());
  std::vector<dealii::Tensor<1, 3>> sums(exchange.n_nodes());
  for (std::size_t s = 0; s < parts_.touching.size(); ++s) {
    const SlaveState &state = parts_.touching[s];
    parts_.touching.visit_forces(s, [&](const FacetShare &share, const auto &force, const auto &) {
      const double part = parts_.touching.area_of(state, share) * state.traction.pressure;
      of_pressures[parts_.slaves.node(s)] += part;
      sums[parts_.slaves.node(s)] += force;
      const std::array<double, 4> parts = counted_parts(share.projection.weights);
      for (unsigned int a = 0; a < 4; ++a) {
        const unsigned int node = parts_.surfaces.facet(share.facet).nodes[a];
        of_pressures[node] += parts[a] * part;
        sums[node] -= parts[a] * force;
      }
    });
  }
  exchange.collect(of_pressures);
  exchange.collect(sums);
  std::vector<SurfaceForce> forces(exchange.n_own_nodes());
  for (std::size_t i = 0; i < forces.size(); ++i) {
    forces[i].force = sums[i];
    forces[i].of_pressures = of_pressures[i];
  }
  for (unsigned int f = 0; f < exchange.n_own_facets(); ++f)
    for (unsigned int a = 0; a < 4; ++a)
      forces[parts_.surfaces.facet(f).nodes[a]].area +=
          parts_.surfaces.moved().areas(f).share(a, -parts_.surfaces.moved().plane(f).normal());
  return forces;
}

std::vector<FacetMeasures::NodeReport> FacetMeasures::report() const {
  const std::vector<SurfaceForce> forces = nodal_forces();
  std::vector<NodeReport> reports(forces.size());
  for (std::size_t s = 0; s < parts_.touching.size(); ++s) {
    const SlaveState &state = parts_.touching[s];
    const bool touches = state.presses();
    reports[parts_.slaves.node(s)] = {
        state.traction.status,
        state.traction.pressure,
        touches ? state.contact.gap - state.touched.offset + parts_.offsets.of(s).now : 0.,
        0.,
        touches ? state.area : 0.,
        state.traction.traction,
        state.has_pressure() ? parts_.touching.penetration_of(s) : 0.,
        parts_.penalties[s].tangential};
  }
  for (std::size_t i = 0; i < forces.size(); ++i)
    reports[i].total = forces[i];
  if (parts_.friction)
    for (std::size_t s = 0; s < parts_.touching.size(); ++s)
      reports[parts_.slaves.node(s)].slip = parts_.friction->slip(s);
  return reports;
}

StartGaps FacetMeasures::start_gaps(const ContactSurfaces::Positions &undeformed) const {
  StartGaps gaps;
  ContactSurfaces::Positions X = undeformed;
  parts_.surfaces.exchange().update(X);
  for (std::size_t s = 0; s < parts_.touching.size(); ++s) {
    const SlaveState &state = parts_.touching[s];
    double slide = 0.;
    if (state.has_pressure()) {
      const FacetShare *largest = &parts_.touching.shares()[state.first_share];
      for (std::size_t i = state.first_share; i < state.end_of_shares; ++i)
        if (const FacetShare &share = parts_.touching.shares()[i]; share.share > largest->share)
          largest = &share;
      const FacetCorners target = corners_of(parts_.surfaces.facet(largest->facet), X);
      slide =
          (parts_.touching.point_of(s, *largest, X) - facet::interpolate(largest->projection.weights, target))
              .norm();
    }
    const double force = state.has_pressure() ? state.traction.pressure * state.own_area : 0.;
    gaps.add(force, state.own_area, slide, parts_.slaves.facet_size(s), parts_.offsets.penetrations.now(s));
  }
  return gaps;
}

std::vector<RestlessNode> FacetMeasures::find_restless() const {
  std::vector<RestlessNode> restless;
  parts_.restless.visit([&](const std::size_t s, const unsigned int n_changes) {
    restless.push_back({parts_.surfaces.positions()[parts_.slaves.node(s)], n_changes});
  });
  return restless;
}

} // namespace billet
