// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/inertia_watch.h"

#include "billet/diagnostic_kinds.h"
#include "billet/mechanics/element_mass.h"

#include <cmath>
#include <sstream>

namespace billet {

namespace {

/// Returns twice the kinetic energy.
double square(const ElementMass &mass, const ElementVectors &v) {
  double sum = 0.;
  for (std::size_t a = 0; a < n_element_nodes; ++a)
    for (std::size_t b = 0; b < n_element_nodes; ++b)
      for (unsigned int i = 0; i < 3; ++i)
        sum += mass[a * n_element_nodes + b] * v[3 * a + i] * v[3 * b + i];
  return sum;
}

} // namespace

InertiaWatch::InertiaWatch(const Scene &scene, const Discretization &discretization)
    : scene_(scene), discretization_(discretization),
      is_lumped_(scene.parameters().scheme().lumps_mass ||
                 (scene.parameters().scheme().has_inertia &&
                  scene.parameters().implicit_dynamics.mass == parameters::ImplicitDynamics::Mass::lumped)),
      lumped_(scene.bodies().size()), consistent_(lumped_) {}

void InertiaWatch::add(const SolutionState &state) {
  constexpr double max_samples = 100.;
  const double dt = state.time - time_;
  if (!is_lumped_ || !(dt > 0.) || dt < scene_.parameters().time_stepping.end_time / max_samples)
    return;
  time_ = state.time;
  duration_ += dt;
  for (std::size_t b = 0; b < lumped_.size(); ++b) {
    // Mass, momentum, and energies of both kinds: the mean motion has the same in both.
    std::vector<double> sums(6);
    for (const auto &element : discretization_.elements(b)) {
      ReferenceElement reference{};
      compute_reference_element(nodal_positions(element.cell), reference);
      ElementMass mass = compute_element_mass(reference, scene_.bodies()[b].density);
      const ElementVectors v = gather(state.velocities, element.dofs);
      sums[5] += 0.5 * square(mass, v);
      lump(mass);
      sums[4] += 0.5 * square(mass, v);
      for (std::size_t a = 0; a < n_element_nodes; ++a) {
        const double own = mass[a * n_element_nodes + a];
        sums[0] += own;
        for (unsigned int i = 0; i < 3; ++i)
          sums[1 + i] += own * v[3 * a + i];
      }
    }
    dealii::Utilities::MPI::sum(sums, discretization_.communicator(), sums);
    const double of_mean = 0.5 * (sums[1] * sums[1] + sums[2] * sums[2] + sums[3] * sums[3]) / sums[0];
    lumped_[b] += dt * (sums[4] - of_mean);
    consistent_[b] += dt * (sums[5] - of_mean);
  }
}

DiagnosticList InertiaWatch::judge(const double max_energy) const {
  constexpr double little = 0.01;
  DiagnosticList diagnostics;
  for (std::size_t b = 0; b < lumped_.size(); ++b) {
    const double ratio = lumped_[b] / consistent_[b];
    if (!(lumped_[b] > little * max_energy * duration_) || !(ratio > doubtful_ratio))
      continue;
    std::ostringstream text;
    text.precision(3);
    text << "Lumped masses have " << ratio
         << " times the kinetic energy of the bricks: the motion varies from brick to brick, as in torsion "
            "of a bar with one brick across. Periods are too long by up to "
         << 100. * (std::sqrt(ratio) - 1.) << " %";
    diagnostics.push_back(Diagnostic(diagnostic::lumped_inertia, text.str())
                              .body(scene_.bodies()[b].name)
                              .measure("ratio", ratio));
  }
  return diagnostics;
}

void InertiaWatch::save(StateWriter &writer) const {
  std::vector<double> values = {time_, duration_};
  values.insert(values.end(), lumped_.begin(), lumped_.end());
  values.insert(values.end(), consistent_.begin(), consistent_.end());
  writer.write("kinetic energies", values);
}

void InertiaWatch::load(const StateReader &reader) {
  if (!reader.has("kinetic energies"))
    return;
  const std::vector<double> values = reader.read("kinetic energies");
  const std::size_t n = lumped_.size();
  if (values.size() != 2 + 2 * n) // saved for other bodies
    return;
  time_ = values[0];
  duration_ = values[1];
  for (std::size_t b = 0; b < n; ++b) {
    lumped_[b] = values[2 + b];
    consistent_[b] = values[2 + n + b];
  }
}

} // namespace billet
