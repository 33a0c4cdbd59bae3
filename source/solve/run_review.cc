// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/run_review.h"

#include "billet/contact/faceted_curvature.h"
#include "billet/diagnostic_kinds.h"
#include "billet/discretization/inverted_corners.h"
#include "billet/scene/plausibility.h"
#include "billet/solve/facet_penetrations.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

RunReview::RunReview(const Scene &scene, const Discretization &discretization)
    : scene_(scene), discretization_(discretization), elements_(scene, discretization),
      inertia_(scene, discretization), contacts_(scene, discretization),
      missing_pairs_(scene, discretization), unbalanced_(scene, discretization) {}

DiagnosticList RunReview::start() const {
  return check_plausibility(scene_, discretization_.dof_handler().get_triangulation(),
                            discretization_.communicator());
}

DiagnosticList RunReview::after_step(const Solution &solution, const bool is_last) {
  DiagnosticList diagnostics = contacts_.add(solution);
  inertia_.add(solution.state());
  unbalanced_.add(solution);
  const EnergyLedger &energies = solution.state().energies;
  max_kinetic_ = std::max(max_kinetic_, energies.kinetic);
  max_internal_ = std::max(max_internal_, energies.of_elements());
  max_energy_ = std::max(max_energy_, energies.total());
  numerical_ = energies.numerical;
  if (!scene_.parameters().scheme().has_matrix) // elsewhere it is the work of stabilisation
    viscous_ = energies.viscous;
  append(diagnostics, elements_.watch(solution.state(), is_last));
  append(diagnostics, missing_pairs_.check(solution.state()));
  for (Diagnostic &inverted :
       find_inverted_corners(scene_, discretization_, solution.state().displacements, is_last))
    diagnostics.push_back(inverted.time(solution.state().time));
  append(diagnostics, check_facet_penetrations(scene_, solution));
  if (is_last)
    append(diagnostics, find_faceted_curvature(scene_, discretization_, solution.state().displacements,
                                               solution.state().time));
  constexpr double far = 3.; // sizes of the scene
  const double moved = solution.state().displacements.linfty_norm() / (2. * discretization_.radius());
  if (!scene_.parameters().scheme().has_inertia && moved > far) {
    std::ostringstream text;
    text.precision(3);
    text << "A node has moved by " << moved << " times the size of all bodies";
    diagnostics.push_back(Diagnostic(diagnostic::large_displacement, text.str())
                              .time(solution.state().time)
                              .measure("displacement / size", moved));
  }
  return diagnostics;
}

DiagnosticList RunReview::finish() const {
  DiagnosticList diagnostics = contacts_.finish();
  append(diagnostics, inertia_.judge(max_energy_));
  append(diagnostics, unbalanced_.judge());
  constexpr double much = 0.05;
  if (const double size = std::abs(numerical_); size > much * max_energy_) {
    std::ostringstream text;
    text.precision(3);
    text << "Time integration " << (numerical_ > 0. ? "dissipates " : "creates ") << 100. * size / max_energy_
         << " % of the maximum energy";
    diagnostics.push_back(Diagnostic(diagnostic::numerical_dissipation, text.str())
                              .measure("part of the largest energy", size / max_energy_));
  }
  if (viscous_ > much * max_energy_) {
    std::ostringstream text;
    text.precision(3);
    text << "Bulk viscosity dissipates " << 100. * viscous_ / max_energy_ << " % of the maximum energy";
    diagnostics.push_back(Diagnostic(diagnostic::bulk_viscosity, text.str())
                              .measure("part of the largest energy", viscous_ / max_energy_));
  }
  return diagnostics;
}

void RunReview::save(StateWriter &writer) const {
  writer.in("review", [&] {
    elements_.save(writer);
    inertia_.save(writer);
    contacts_.save(writer);
    missing_pairs_.save(writer);
    unbalanced_.save(writer);
    writer.write("energies", {max_kinetic_, max_internal_, max_energy_});
  });
}

void RunReview::load(StateReader &reader) {
  if (reader.has("review"))
    reader.in("review", [&] {
      elements_.load(reader);
      inertia_.load(reader);
      contacts_.load(reader);
      missing_pairs_.load(reader);
      unbalanced_.load(reader);
      const std::vector<double> maximum = reader.read("energies", 3);
      max_kinetic_ = maximum.at(0);
      max_internal_ = maximum.at(1);
      max_energy_ = maximum.at(2);
    });
}

} // namespace billet
