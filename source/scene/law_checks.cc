// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/law_checks.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/geometry/frame.h"
#include "billet/material/law_point.h"
#include "billet/material/user_subroutine.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace billet {

namespace {

/// Tangents with a larger relative error are wrong. Consistent ones are off by the order of the
/// step.
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
    "Young's modulus times the 'Taylor-Quinney fraction', over density and specific heat, is above 1e6 or "
    "below 200 degrees. Metals have 1e4 to 2e5. Usually the specific heat has other units than stress and "
    "density.",
    "Give 'Specific heat' in energy per mass and degree. Steel has 460 in J/(kg K), or 4.6e8 in mm, t and s");

const DiagnosticKind molten_at_start(
    "molten-at-start", Severity::warning,
    "At the temperature at which a body starts, its flow stress is less than a thousandth of that without "
    "thermal factor.",
    "Check 'Temperature' against 'Melting temperature': both have the same unit and zero");

const DiagnosticKind material_not_mirrored(
    "material-not-mirrored", Severity::warning,
    "The plastic flow of a body is not symmetric about a symmetry plane, or about the sides of its section. "
    "The material axes are neither along the plane nor normal to it. The other half would not be the mirror "
    "image of the body, and forces are wrong.",
    "Choose 'Axes' of the anisotropy along the normal of the plane, or compute the whole body");

/// Returns a point of the plane, which is not on an axis of cylindrical material axes.
dealii::Tensor<1, 3> find_point(const parameters::SymmetryPlane &plane) {
  const Frame frame = Frame::from_normal(plane.normal);
  return plane.offset * plane.normal + std::max(1., std::abs(plane.offset)) * (frame.q + 0.7 * frame.r);
}

/// Returns the norm of the difference of the stresses at a yielding point and at its mirror image
/// about a plane through it. It is relative to the norm of the stress. Returns nothing if the law
/// refuses the strains.
std::optional<double> find_asymmetry(const PointLaw &law, const double temperature, const double dt,
                                     const parameters::SymmetryPlane &plane) {
  const dealii::Tensor<1, 3> &normal = plane.normal;
  const double strain = 10. * law.flow_stress()->stress(0.) / (3. * law.elastic().shear);
  const dealii::SymmetricTensor<2, 3> identity = dealii::unit_symmetric_tensor<3>();
  // All of its components differ, so that no anisotropy is hidden.
  const dealii::SymmetricTensor<2, 3> E(
      dealii::Tensor<2, 3>({{1., 0.5, 0.4}, {0.5, -0.3, 0.7}, {0.4, 0.7, -0.6}}));
  const dealii::Tensor<2, 3> F = identity + strain * E,
                             R = identity - 2. * dealii::outer_product(normal, normal);
  LawPoint point(law, temperature, find_point(plane)), image = point;
  const auto stress = point.evaluate(F, dt), mirrored = image.evaluate(R * F * R, dt);
  if (!stress || !mirrored || !(law.equivalent_plastic_strain(point.state().data()) > 0.))
    return {};
  const auto back = dealii::symmetrize(R * dealii::Tensor<2, 3>(*mirrored) * R);
  return (dealii::deviator(*stress) - dealii::deviator(back)).norm() / dealii::deviator(*stress).norm();
}

/// Heating of a point that flows, at the start of the run.
struct Heating {
  /// Rise of the temperature by dissipated energy per volume [temperature/stress].
  double per_energy;
  double strength; ///< flow stress over that without the factors of rate and temperature
};

/// Measures the heating; returns nothing if the law does not heat or flow.
std::optional<Heating> measure_heating(const PointLaw &law, const double temperature, const double dt) {
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
  const double flow_stress = law.flow_stress()->stress(0.);
  // A law that heats far too much refuses all but tiny strains.
  for (const double plastic_strain : {1e-2, 1e-4, 1e-6, 1e-8}) {
    const double strain = plastic_strain + flow_stress / (3. * law.elastic().shear);
    dealii::Tensor<2, 3> F;
    F[0][0] = std::exp(strain);
    F[1][1] = F[2][2] = std::exp(-0.5 * strain);
    LawPoint point(law, temperature);
    if (!point.evaluate(F, dt))
      continue;
    const double flown = law.equivalent_plastic_strain(point.state().data()),
                 dissipated = point.dissipated_energy();
    if (flown > 0. && dissipated > 0.)
      return Heating{point.state()[place] / dissipated, dissipated / flown / flow_stress};
  }
  return {};
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
  constexpr double least = 200., most = 1e6; // [temperature]
  constexpr double molten = 1e-3;            // part of the flow stress
  constexpr double part = 0.01;              // of the end time
  DiagnosticList diagnostics;
  for (const Body &body : scene.bodies()) {
    if (body.temperature == nullptr)
      continue;
    const auto heating = measure_heating(*body.law, body.temperature->value(0.),
                                         part * scene.parameters().time_stepping.end_time);
    if (!heating)
      continue;
    const double rise = heating->per_energy * body.young_modulus;
    std::ostringstream text;
    text.precision(2);
    if (rise > 0. && !(rise > least && rise < most)) {
      text << "Young's modulus times the 'Taylor-Quinney fraction', over density and specific heat, is "
           << rise << " degrees";
      diagnostics.push_back(
          Diagnostic(implausible_heating, text.str()).body(body.name).measure("E / heat capacity", rise));
    } else if (heating->strength < molten) {
      text << "At 'Temperature' the flow stress is " << heating->strength
           << " of that without thermal factor";
      diagnostics.push_back(
          Diagnostic(molten_at_start, text.str()).body(body.name).measure("flow stress", heating->strength));
    }
  }
  return diagnostics;
}

DiagnosticList check_mirrored_laws(const Scene &scene) {
  constexpr double allowed = 1e-3, part = 0.01; // `part`: of the end time
  DiagnosticList diagnostics;
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    const Body &body = scene.bodies()[b];
    if (!body.law->has_plasticity())
      continue;
    for (const auto &plane : scene.parameters().bodies[b].symmetry_planes.value) {
      const auto asymmetry =
          find_asymmetry(*body.law, body.temperature != nullptr ? body.temperature->value(0.) : 0.,
                         part * scene.parameters().time_stepping.end_time, plane);
      if (!asymmetry || *asymmetry <= allowed)
        continue;
      std::ostringstream text;
      text.precision(2);
      text << "The material is not symmetric about '" << plane.text
           << "': the stress of a mirrored strain differs by " << 100. * *asymmetry << " %";
      diagnostics.push_back(
          Diagnostic(material_not_mirrored, text.str()).body(body.name).measure("asymmetry", *asymmetry));
      break;
    }
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
