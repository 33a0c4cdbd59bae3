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

} // namespace

DiagnosticList check_user_laws(const Scene &scene) {
  DiagnosticList diagnostics;
  if (!scene.parameters().scheme().has_matrix)
    return diagnostics;
  for (const Body &body : scene.bodies()) {
    const auto *const law = dynamic_cast<const ExplainsRefusals *>(body.law.get());
    if (law == nullptr)
      continue;
    const TangentError found =
        find_tangent_error(*body.law, scene.parameters().time_stepping.initial_step,
                           body.temperature != nullptr ? body.temperature->value(0.) : 0.);
    if (law->refusal().is_final)
      throw SolutionFailure(Diagnostic(diagnostic::solution_failed, law->refusal().what)
                                .body(body.name)
                                .advice("Correct the library; 'billet --certify' tries it out"));
    if (found.error <= allowed_error)
      continue;
    std::ostringstream text;
    text.precision(2);
    text << "The tangent of " << law->title() << " is off by " << 100. * found.error << " % at a strain of "
         << found.strain << ", by differences of its stress";
    diagnostics.push_back(Diagnostic(diagnostic::wrong_tangent, text.str())
                              .body(body.name)
                              .measure("relative error", found.error));
  }
  return diagnostics;
}

} // namespace billet
