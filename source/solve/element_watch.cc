// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/element_watch.h"

#include "billet/diagnostic_kinds.h"
#include "billet/discretization/body_volumes.h"
#include "billet/material/user_subroutine.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

namespace {

bool is_of_taper(const ElementEnergies &energies) {
  constexpr double much = 0.5;
  return energies.tapered > much * (energies.used + energies.tapered - energies.accurate);
}

/// Subroutines of users do not tell whether they have plasticity.
bool may_yield(const PointLaw &law) { return law.has_plasticity() || find_user_subroutine(law) != nullptr; }

/// Advice to take the element that neither locks nor is soft.
std::string use_assumed_strain() {
  return std::string("Use 'Element = ") + BrickElement::assumed_strain.name() + "'";
}

/// Returns advice for a body whose elements are too stiff; never an element that is as stiff.
std::string advise_on_stiffness(const ElementFormulation &formulation, const ElementEnergies &energies) {
  return is_of_taper(energies) || !formulation.element.may_lock_in_bending()
             ? "Use bricks whose opposite edges are parallel, also in plan, or bricks shorter relative to "
               "their thickness"
             : use_assumed_strain();
}

constexpr std::size_t n_energies = 9;

void add_numbers(const ElementEnergies &energies, std::vector<double> &values) {
  values.insert(values.end(),
                {energies.used, energies.one_point, energies.accurate, energies.hourglass, energies.plastic,
                 energies.tapered, energies.plastic_within, energies.beyond_yield, energies.face_stress});
}
ElementEnergies energies_in(const std::vector<double> &values, const std::size_t body) {
  const double *own = &values[n_energies * body];
  ElementEnergies energies;
  energies.used = own[0];
  energies.one_point = own[1];
  energies.accurate = own[2];
  energies.hourglass = own[3];
  energies.plastic = own[4];
  energies.tapered = own[5];
  energies.plastic_within = own[6];
  energies.beyond_yield = own[7];
  energies.face_stress = own[8];
  return energies;
}

} // namespace

ElementWatch::ElementWatch(const Scene &scene, const Discretization &discretization)
    : scene_(scene), discretization_(discretization), volumes_(measure_body_volumes(discretization)),
      energies_(scene.bodies().size()) {
  for (const Body &body : scene.bodies())
    comparisons_.emplace_back(body.law, body.formulation);
}

void ElementWatch::compare(const SolutionState &state) {
  std::vector<double> sums, face_stresses;
  for (std::size_t b = 0; b < comparisons_.size(); ++b) {
    ElementEnergies energies;
    for (const auto &element : discretization_.elements(b))
      comparisons_[b].compare(nodal_positions(element.cell), gather(state.displacements, element.dofs),
                              energies);
    add_numbers(energies, sums);
    face_stresses.push_back(energies.face_stress);
  }
  dealii::Utilities::MPI::sum(sums, discretization_.communicator(), sums);
  dealii::Utilities::MPI::max(face_stresses, discretization_.communicator(), face_stresses);
  for (std::size_t b = 0; b < comparisons_.size(); ++b) {
    energies_[b] = energies_in(sums, b);
    energies_[b].face_stress = face_stresses[b];
  }
  compared_time_ = state.time;
}

bool ElementWatch::counts(const std::size_t body) const {
  constexpr double rounding = 1e-9, part = 0.01;
  double all = 0.;
  for (const auto &energies : energies_)
    all += energies.used;
  return energies_[body].used > part * all &&
         energies_[body].used > rounding * rounding * scene_.bodies()[body].young_modulus * volumes_[body];
}

double ElementWatch::factor_of(const std::size_t body) const {
  // The deformation theory is an estimate once a body yields: there the stiffer of both references
  // counts.
  ElementEnergies energies = energies_[body];
  if (may_yield(*scene_.bodies()[body].law))
    energies.accurate = std::max(energies.accurate, energies.one_point);
  return energies.used > 0. ? energies.factor() : 1.;
}

bool ElementWatch::is_doubtful(const std::size_t body) const {
  // Accurate elements are never called soft.
  const bool may_be_soft = scene_.bodies()[body].formulation.element.may_be_soft();
  const double factor = factor_of(body);
  return counts(body) && (factor > doubtful_factor || (may_be_soft && factor * doubtful_factor < 1.));
}

DiagnosticList ElementWatch::judge(const bool is_first) const {
  DiagnosticList diagnostics;
  for (std::size_t b = 0; b < energies_.size(); ++b) {
    const double factor = factor_of(b);
    const bool is_stiff = factor > doubtful_factor;
    const ElementFormulation &formulation = scene_.bodies()[b].formulation;
    if (!is_doubtful(b))
      continue;
    // Plastic hinges and inertia reduce the effect of this factor.
    const bool has_yield = may_yield(*scene_.bodies()[b].law);
    std::ostringstream text;
    text.precision(3);
    text << "Elements 'Element = " << formulation.element.name() << "' ";
    if (is_stiff)
      text << "are " << factor
           << " times too stiff for this deformation: forces are too large, or displacements too small, by "
           << (has_yield                   ? "up to"
               : is_of_taper(energies_[b]) ? "about"
                                           : "at least")
           << " this factor";
    else // no bound and no direction: skewed bricks may still be too stiff
      text << "store " << 1. / factor
           << " times less energy in this deformation than exact elements: the error of forces or "
              "displacements may reach this factor";
    Diagnostic message(is_first   ? diagnostic::element_unfit_at_start
                       : is_stiff ? diagnostic::element_too_stiff
                                  : diagnostic::element_too_soft,
                       text.str());
    message.body(scene_.bodies()[b].name).time(compared_time_).measure("factor", factor);
    const std::string advice =
        is_stiff ? advise_on_stiffness(formulation, energies_[b]) : use_assumed_strain();
    message.advice(is_first ? "If it remains until the end: " + advice : advice);
    diagnostics.push_back(message);
  }
  return diagnostics;
}

DiagnosticList ElementWatch::judge_bending() const {
  constexpr double of_hourglass_modes = 0.1, of_yielding = 0.1, of_flow_within = 0.05, of_dissipation = 0.3,
                   of_faces = 0.1;
  DiagnosticList diagnostics;
  for (std::size_t b = 0; b < energies_.size(); ++b) {
    const ElementEnergies &energies = energies_[b];
    const bool has_plasticity = scene_.bodies()[b].law->has_plasticity();
    // An element without such modes, or whose comparison does not compute the dissipation, adds
    // zeros.
    const bool is_hourglass = energies.hourglass > of_hourglass_modes * energies.used &&
                              energies.plastic > of_yielding * energies.used;
    const bool is_between_points =
        energies.plastic_within > of_flow_within * energies.used &&
        std::abs(energies.plastic - energies.plastic_within) > of_dissipation * energies.plastic_within;
    const bool is_at_faces = has_plasticity && energies.beyond_yield > of_faces * energies.used;
    if (!counts(b) || !(is_hourglass || is_between_points || is_at_faces))
      continue;
    std::ostringstream text;
    text.precision(3);
    text << "The body yields in bending within single elements: ";
    std::pair<const char *, double> measure;
    if (is_hourglass) {
      measure = {"part", energies.hourglass / energies.used};
      text << 100. * measure.second
           << " % of the energy is in hourglass modes, whose stabilisation has one yield stress for the "
              "whole element. Forces are too large, and springback is wrong";
    } else if (is_between_points) {
      measure = {"part", energies.plastic / energies.plastic_within};
      text << "their points capture " << 100. * measure.second
           << " % of the plastic dissipation between them, which is "
           << 100. * energies.plastic_within / energies.used
           << " % of the energy. Forces or displacements, and springback, are wrong";
    } else {
      measure = {"stress", energies.face_stress};
      text << "the elastic stress at the faces of bricks is up to " << measure.second
           << " times the yield stress, and that at their points is below it. Such bricks hold "
           << 100. * energies.beyond_yield / energies.used
           << " % of the energy, and are too stiff: the plastic flow near their faces is missing";
    }
    Diagnostic message(diagnostic::plastic_bending_coarse, text.str());
    message.body(scene_.bodies()[b].name).time(compared_time_).measure(measure.first, measure.second);
    message.advice(is_hourglass ? "Use four or more bricks through the thickness, and shorter ones where the "
                                  "bend is sharpest"
                   : !scene_.parameters().scheme().has_matrix ||
                           !scene_.bodies()[b].formulation.element.has_layers()
                       ? "Use two or more bricks through the thickness"
                       : "Use two or more bricks through the thickness, or 'Points through thickness = 5'");
    diagnostics.push_back(message);
  }
  return diagnostics;
}

DiagnosticList ElementWatch::judge_probes() const {
  constexpr double of_hourglass_modes = 0.1;
  std::vector<std::string> readers(energies_.size()); // by body
  for (const auto &probe : scene_.parameters().probes)
    if (probe.probe.reads(ProbeQuantity::Kind::stress)) {
      std::string &names = readers[scene_.parameters().body_index(probe)];
      names += (names.empty() ? "'" : ", '") + probe.name + "'";
    }
  DiagnosticList diagnostics;
  for (std::size_t b = 0; b < energies_.size(); ++b) {
    const double part = energies_[b].used > 0. ? energies_[b].hourglass / energies_[b].used : 0.;
    if (readers[b].empty() || !scene_.bodies()[b].formulation.element.is_stabilised() || !counts(b) ||
        !(part > of_hourglass_modes))
      continue;
    std::ostringstream text;
    text.precision(3);
    text << "The stress of one-point elements is that of their middle, and " << 100. * part
         << " % of the energy is in their hourglass modes. The bending stress is missing in the probes "
         << readers[b];
    Diagnostic message(diagnostic::probe_without_bending, text.str());
    message.body(scene_.bodies()[b].name).time(compared_time_).measure("part", part);
    message.advice(use_assumed_strain() + ", or four or more bricks through the thickness");
    diagnostics.push_back(message);
  }
  return diagnostics;
}

DiagnosticList ElementWatch::watch(const SolutionState &state, const bool is_last) {
  constexpr double still_loaded = 0.5;
  const EnergyLedger &ledger = state.energies;
  const double energy = ledger.of_elements();
  const bool is_static = !scene_.parameters().scheme().has_inertia, is_first = compared_energy_ == 0.;
  // In springback the largest load counts; dynamic steps are many and short.
  constexpr double growth_in_statics = 1.1, growth_in_motion = 2.;
  const double growth = is_static ? growth_in_statics : growth_in_motion;
  if (std::isfinite(energy) && energy > 0. &&
      (energy > growth * compared_energy_ ||
       (is_last && energy >= (is_static ? still_loaded * max_energy_ : compared_energy_)))) {
    compare(state);
    compared_energy_ = energy;
  }
  max_energy_ = std::isfinite(energy) ? std::max(max_energy_, energy) : max_energy_;
  if (is_last) {
    DiagnosticList diagnostics = judge(false);
    append(diagnostics, judge_bending());
    append(diagnostics, judge_probes());
    return diagnostics;
  }
  return is_static && is_first && compared_energy_ > 0. ? judge(true) : DiagnosticList();
}

double ElementWatch::error() const {
  bool is_any_doubtful = false;
  double used = 0., accurate = 0.;
  for (std::size_t b = 0; b < energies_.size(); ++b) {
    used += energies_[b].used;
    accurate += energies_[b].used / factor_of(b);
    is_any_doubtful = is_any_doubtful || is_doubtful(b);
  }
  return is_any_doubtful && accurate > 0. ? std::abs(used / accurate - 1.) : 0.;
}

void ElementWatch::save(StateWriter &writer) const {
  std::vector<double> values = {compared_energy_, compared_time_, max_energy_};
  for (const auto &energies : energies_)
    add_numbers(energies, values);
  writer.write("element energies", values);
}

void ElementWatch::load(const StateReader &reader) {
  std::vector<double> values = reader.read("element energies");
  if (values.size() != 3 + n_energies * energies_.size()) // saved for other bodies
    return;
  compared_energy_ = values[0];
  compared_time_ = values[1];
  max_energy_ = values[2];
  values.erase(values.begin(), values.begin() + 3);
  for (std::size_t b = 0; b < energies_.size(); ++b)
    energies_[b] = energies_in(values, b);
}

} // namespace billet
