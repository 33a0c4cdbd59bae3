// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_quantity.h"

#include <algorithm>

namespace billet {

std::vector<HistoryQuantity> energy_quantities();

namespace {

bool is_any(const Scene &) { return true; }
bool is_explicit(const Scene &scene) { return !scene.parameters().scheme().has_matrix; }
bool is_dynamic(const Scene &scene) { return scene.parameters().scheme().has_inertia; }
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

HistoryQuantity energy(const std::string &name, const std::string &column, const std::string &meaning,
                       bool (*has_it)(const Scene &), double EnergyLedger::*value) {
  return {
      name,
      {{column, meaning + " [energy]"}},
      [column, has_it](const Scene &scene) {
        return has_it(scene) ? std::vector<std::string>{column} : std::vector<std::string>();
      },
      [value](const HistorySample &sample) -> std::vector<double> { return {sample.state.energies.*value}; }};
}

} // namespace

std::vector<HistoryQuantity> energy_quantities() {
  using E = EnergyLedger;
  return {
      energy("kinetic energy", "kinetic_energy",
             "Dynamic scenes: kinetic energy of all bodies and free tools.", is_dynamic, &E::kinetic),
      energy("elastic energy", "elastic_energy", "Elastic energy of all bodies.", is_any, &E::elastic),
      energy("plastic work", "plastic_work", "Energy dissipated by yielding.", is_any, &E::plastic),
      energy("contact energy", "contact_energy", "Energy stored in the penalty springs of contact.", is_any,
             &E::contact),
      energy("friction dissipation", "friction_dissipation", "Energy dissipated by friction.", is_any,
             &E::friction),
      energy("dissipation by bulk viscosity", "viscous_dissipation",
             "Explicit scenes: energy dissipated by bulk viscosity.", is_explicit, &E::viscous),
      energy("numerical dissipation", "numerical_dissipation",
             "Energy dissipated by the time integrator, and by contact that opens or closes within a step.",
             is_implicit_dynamics, &E::numerical),
      energy("hourglass energy", "hourglass_energy",
             "Energy stored in the stabilisation of one-point elements.", has_hourglass_modes, &E::hourglass),
      energy("dissipation by stabilisation", "viscous_dissipation",
             "Static scenes: work of the viscous forces that stabilise bodies.", has_stabilised_bodies,
             &E::viscous),
      energy("external work", "external_work", "Work of tools, supports and loads.", is_any, &E::external),
      {"energy drift",
       {{"energy_drift",
         "Energy at the start and external work, less all energies: what the balance lacks. [energy]"}},
       [](const Scene &) -> std::vector<std::string> { return {"energy_drift"}; },
       [](const HistorySample &sample) -> std::vector<double> { return {sample.state.energies.drift()}; }}};
}

} // namespace billet
