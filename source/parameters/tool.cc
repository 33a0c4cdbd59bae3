// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/tool.h"

#include <deal.II/base/parameter_handler.h>

namespace billet::parameters {

using dealii::ParameterHandler;
namespace Patterns = dealii::Patterns;

void Motion::declare(ParameterHandler &prm) {
  prm.declare_entry("Translation", "0 ; 0 ; 0", Patterns::Anything(),
                    "Three muParser expressions of the time t and the names of amplitudes. [length]");
  prm.declare_entry("Rotation angle", "0", Patterns::Anything(),
                    "Expression of t and the names of amplitudes; right-handed about the axis. [radians]");
  prm.declare_entry("Rotation axis", "0, 0, 1", Patterns::Anything(), "Direction of the axis.");
  prm.declare_entry(
      "Centre", "0, 0, 0", Patterns::Anything(),
      "A point on the axis before the motion; moments on the tool refer to where it has moved. [length]");
}

void Motion::parse(Reader &reader) {
  const auto expressions = reader.parts("Translation");
  if (expressions.size() != 3)
    reader.reject("Translation", "three expressions, separated by semicolons");
  translation = reader.located("Translation",
                               std::array<std::string, 3>{expressions[0], expressions[1], expressions[2]});
  rotation_angle = reader.located("Rotation angle", reader.text("Rotation angle"));
  rotation_axis = reader.direction("Rotation axis");
  centre = reader.vector("Centre");
}

void Tool::declare(ParameterHandler &prm) {
  prm.declare_entry("Surface", "plane", Patterns::Selection("plane"), "Shape of the rigid surface.");
  prm.enter_subsection("Plane");
  prm.declare_entry("Point", "0, 0, 0", Patterns::Anything(), "A point of the (infinite) plane. [length]");
  prm.declare_entry("Normal", "0, 0, 1", Patterns::Anything(), "Normal out of the tool, towards the bodies.");
  prm.leave_subsection();
  prm.enter_subsection("Motion");
  Motion::declare(prm);
  prm.leave_subsection();
}

void Tool::parse(Reader &reader) {
  origin = reader.origin();
  reader.in("Plane", [&] {
    plane_point = reader.vector("Point");
    plane_normal = reader.direction("Normal");
  });
  reader.in("Motion", [&] { motion.parse(reader); });
}

void ContactPair::declare(ParameterHandler &prm) {
  prm.declare_entry("Body", "", Patterns::Anything(), "Name of the body.");
  prm.declare_entry("Boundary ids", "", Patterns::Anything(),
                    "Boundary ids of the body's faces that may touch the tool, separated by commas.");
  prm.declare_entry("Tool", "", Patterns::Anything(), "Name of the tool.");
  prm.declare_entry("Friction coefficient", "0", Patterns::Double(), "Coulomb's mu >= 0. 0: no friction.");
  prm.declare_entry("Penalty unit", "factor", Patterns::Selection("factor|absolute"),
                    "factor: penalties are multiples of E/h, Young's modulus over the facet's size; "
                    "absolute: they are pressures "
                    "per penetration.");
  prm.declare_entry("Normal penalty", "10", Patterns::Double(),
                    "k_n > 0: pressure = k_n times penetration. [1 or stress/length, see Penalty unit]");
  prm.declare_entry("Tangential penalty", "", Patterns::Anything(),
                    "k_t > 0, stiffness while sticking; empty: as the normal penalty. [1 or stress/length]");
  prm.declare_entry("Allowed initial penetration", "1e-3", Patterns::Double(),
                    "A body that starts deeper than this inside the tool is refused. [facet sizes]");
}

void ContactPair::parse(Reader &reader) {
  origin = reader.origin();
  body = reader.located("Body", reader.text("Body"));
  tool = reader.located("Tool", reader.text("Tool"));
  boundary_ids = reader.located("Boundary ids", reader.counts("Boundary ids"));
  if (boundary_ids.value.empty())
    reader.reject("Boundary ids", "at least one boundary id");
  friction_coefficient = reader.not_negative("Friction coefficient");
  penalty_unit = reader.text("Penalty unit") == "factor" ? PenaltyUnit::factor : PenaltyUnit::absolute;
  normal_penalty = reader.positive("Normal penalty");
  if (reader.text("Tangential penalty").empty())
    tangential_penalty = normal_penalty;
  else {
    const auto values = reader.numbers("Tangential penalty");
    if (values.size() != 1 || !(values[0] > 0.))
      reader.reject("Tangential penalty", "a number > 0, or nothing");
    if (friction_coefficient == 0.)
      reader.reject("Tangential penalty", "no value: the pair has no friction");
    tangential_penalty = values[0];
  }
  allowed_penetration =
      reader.located("Allowed initial penetration", reader.not_negative("Allowed initial penetration"));
}

} // namespace billet::parameters
