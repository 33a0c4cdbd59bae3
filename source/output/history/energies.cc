// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_quantity.h"

#include <algorithm>

namespace billet {

std::vector<HistoryQuantity> energy_quantities();

namespace {

bool is_any(const Scene &) { return true; }
bool is_explicit(const Scene &scene) { return scene.parameters().is_explicit(); }
bool is_dynamic(const Scene &scene) { return scene.parameters().is_dynamic(); }
bool is_implicit_dynamics(const Scene &scene) { return is_dynamic(scene) && !is_explicit(scene); }
bool has_hourglass_modes(const Scene &scene) {
  return is_explicit(scene) || scene.capabilities().stabilisation;
}
/// Whether viscous forces stabilise bodies of a static scene until contact supports them.
bool has_stabilised_bodies(const Scene &scene) {
  const auto &bodies = scene.parameters().bodies;
  return std::any_of(bodies.begin(), bodies.end(),
                     [](const parameters::Body &body) { return body.is_stabilised.value; });
}

HistoryQuantity energy(const std::string &name, const std::string &column, bool (*has_it)(const Scene &),
                       double EnergyLedger::*value) {
  return {
      name,
      [column, has_it](const Scene &scene) {
        return has_it(scene) ? std::vector<std::string>{column} : std::vector<std::string>();
      },
      [value](const HistorySample &sample) -> std::vector<double> { return {sample.state.energies.*value}; }};
}

} // namespace

std::vector<HistoryQuantity> energy_quantities() {
  using E = EnergyLedger;
  return {
      energy("kinetic energy", "kinetic_energy", is_dynamic, &E::kinetic),
      energy("elastic energy", "elastic_energy", is_any, &E::elastic),
      energy("plastic work", "plastic_work", is_any, &E::plastic),
      energy("contact energy", "contact_energy", is_any, &E::contact),
      energy("friction dissipation", "friction_dissipation", is_any, &E::friction),
      energy("dissipation by bulk viscosity", "viscous_dissipation", is_explicit, &E::viscous),
      energy("numerical dissipation", "numerical_dissipation", is_implicit_dynamics, &E::numerical),
      energy("hourglass energy", "hourglass_energy", has_hourglass_modes, &E::hourglass),
      energy("dissipation by stabilisation", "viscous_dissipation", has_stabilised_bodies, &E::viscous),
      energy("external work", "external_work", is_any, &E::external),
      {"energy drift", [](const Scene &) -> std::vector<std::string> { return {"energy_drift"}; },
       [](const HistorySample &sample) -> std::vector<double> { return {sample.state.energies.drift()}; }}};
}

} // namespace billet
