// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/law_checks.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/material/law_point.h"
#include "billet/material/user_subroutine.h"

#include <cmath>
#include <optional>
#include <sstream>

namespace billet {

namespace {

/// Tangents with a larger relative error are wrong. Consistent ones are off by the order of the step.
constexpr double allowed_error = 0.05;

const DiagnosticKind idle_subroutines(
    "idle-subroutines", Severity::warning,
    "The library of a material subroutine has further subroutines of Abaqus that this program does not call.",
    "Give what they set in the scene, such as 'Initial state variables' in place of SDVINI");

const DiagnosticKind energies_not_separated(
    "energies-not-separated", Severity::note,
    "A material subroutine returns no stored energy. All work of its stresses counts as elastic energy, also "
    "the plastic one.",
    "Compute SSE, and SPD or SCD, in a UMAT; enerInternNew and enerInelasNew in a VUMAT");

const DiagnosticKind subroutine_note("subroutine-note", Severity::note,
                                     "A material subroutine gives a note by STDB_ABQERR or XPLB_ABQERR.",
                                     "See the source or the manual of the library");

const DiagnosticKind
    subroutine_warning("subroutine-warning", Severity::warning,
                       "A material subroutine gives a warning by STDB_ABQERR or XPLB_ABQERR.",
                       "See the source or the manual of the library");

const DiagnosticKind subroutine_error(
    "subroutine-error", Severity::warning,
    "A material subroutine gives an error by STDB_ABQERR or XPLB_ABQERR with level -2, after "
    "which the analysis continues. Level -3 ends the run.",
    "See the source or the manual of the library; results may be wrong");

const DiagnosticKind implausible_heating(
    "implausible-heating", Severity::warning,
    "Plastic work heats the material by more than 20,000 or less than 0.05 degrees per strain of 1. Metals "
    "warm by 5 to 1,000 degrees. Usually the specific heat has other units than stress and density.",
    "Give 'Specific heat' in energy per mass and degree. Steel has 460 in J/(kg K), or 4.6e8 in mm, t and s");

/// Returns the rise of the temperature per plastic strain; nothing if the law does not heat or flow.
std::optional<double> measure_heating(const PointLaw &law, const double temperature, const double dt) {
  constexpr double plastic_strain = 0.01;
  std::size_t place = 0;
  bool is_found = false;
  for (const StateField &field : law.fields()) {
    is_found = field.name == "temperature rise";
    if (is_found)
      break;
    place += field.n_components;
  }
  if (!is_found || !law.has_plasticity())
    return {};
  const double strain = plastic_strain + law.flow_stress()->stress(0.) / (3. * law.elastic().shear);
  dealii::Tensor<2, 3> F;
  F[0][0] = std::exp(strain);
  F[1][1] = F[2][2] = std::exp(-0.5 * strain);
  LawPoint point(law, temperature);
  if (!point.evaluate(F, dt))
    return {};
  const double flown = law.equivalent_plastic_strain(point.state().data());
  return flown > 0. ? std::optional<double>(point.state()[place] / flown) : std::nullopt;
}

Diagnostic describe_tangent(const UserSubroutine &law, const TangentError &found) {
  std::ostringstream text;
  text.precision(2);
  text << "The tangent of " << law.title() << " is off by " << 100. * found.error << " % at a strain of "
       << found.strain << ", by differences of its stress";
  const bool is_unsymmetric = !(found.asymmetry <= allowed_error);
  if (is_unsymmetric)
    text << "; it is unsymmetric by " << 100. * found.asymmetry << " %, and only its symmetric part counts";
  Diagnostic diagnostic(diagnostic::wrong_tangent, text.str());
  diagnostic.measure("relative error", found.error);
  if (is_unsymmetric)
    diagnostic.advice(
        "Set 'Unsymmetric tangent = true' in Material; if the tangent is meant to be symmetric, "
        "correct it in the source of the library");
  return diagnostic;
}

/// Compares the tangents of the law with its stress.
void check_tangent(const Scene &scene, const Body &body, const UserSubroutine &law,
                   DiagnosticList &diagnostics) {
  const TangentError found =
      find_tangent_error(*body.law, scene.parameters().time_stepping.initial_step,
                         body.temperature != nullptr ? body.temperature->value(0.) : 0.);
  if (law.refusal().is_final)
    throw SolutionFailure(Diagnostic(diagnostic::solution_failed, law.refusal().what)
                              .body(body.name)
                              .advice("Correct the library; 'billet --certify' tries it out"));
  if (!(found.error <= allowed_error))
    diagnostics.push_back(describe_tangent(law, found).body(body.name));
}

} // namespace

DiagnosticList check_user_laws(const Scene &scene) {
  DiagnosticList diagnostics;
  for (const Body &body : scene.bodies()) {
    const auto *const law = find_user_subroutine(*body.law);
    if (law == nullptr)
      continue;
    if (!law->idle_subroutines().empty())
      diagnostics.push_back(Diagnostic(idle_subroutines, "The library of " + law->title() + " has " +
                                                             law->idle_subroutines() +
                                                             ", which the program does not call")
                                .body(body.name));
    if (!law->computes_energies())
      diagnostics.push_back(Diagnostic(energies_not_separated, law->title() +
                                                                   " returns no stored energy: all work of "
                                                                   "its stresses counts as elastic energy")
                                .body(body.name));
    if (scene.parameters().scheme().has_matrix)
      check_tangent(scene, body, *law, diagnostics);
  }
  append(diagnostics, describe(take_subroutine_messages()));
  return diagnostics;
}

DiagnosticList check_heating(const Scene &scene) {
  constexpr double least = 0.05, most = 2e4;
  constexpr double part = 0.01; // of the end time, and of strain
  DiagnosticList diagnostics;
  for (const Body &body : scene.bodies()) {
    if (body.temperature == nullptr)
      continue;
    const auto rise = measure_heating(*body.law, body.temperature->value(0.),
                                      part * scene.parameters().time_stepping.end_time);
    if (!rise || *rise == 0. || (*rise > least && *rise < most))
      continue;
    std::ostringstream text;
    text.precision(2);
    text << "The material warms by " << part * *rise << " degrees at a plastic strain of " << part;
    diagnostics.push_back(
        Diagnostic(implausible_heating, text.str()).body(body.name).measure("rise per strain", *rise));
  }
  return diagnostics;
}

DiagnosticList describe(const std::vector<SubroutineMessage> &messages) {
  DiagnosticList diagnostics;
  for (const SubroutineMessage &message : messages)
    diagnostics.push_back(Diagnostic(message.level == 1    ? subroutine_note
                                     : message.level == -1 ? subroutine_warning
                                                           : subroutine_error,
                                     message.text)
                              .topic(message.format));
  return diagnostics;
}

} // namespace billet
