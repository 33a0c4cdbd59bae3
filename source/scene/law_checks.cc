// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/law_checks.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/material/law_point.h"
#include "billet/material/law_refusal.h"

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

Diagnostic describe_tangent(const ExplainsRefusals &law, const TangentError &found) {
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
void check_tangent(const Scene &scene, const Body &body, const ExplainsRefusals &law,
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
    const auto *const law = dynamic_cast<const ExplainsRefusals *>(body.law.get());
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
  return diagnostics;
}

} // namespace billet
