// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/implicit_dynamics.h"

#include "billet/integration/time_integrator_type.h"
#include "billet/parameters/named_values.h"
#include "billet/parameters/registered.h"

#include <deal.II/base/parameter_handler.h>

namespace billet::parameters {

using dealii::ParameterHandler;
namespace Patterns = dealii::Patterns;

namespace {

const NamedValues<ImplicitDynamics::Mass> masses = {{"consistent", ImplicitDynamics::Mass::consistent},
                                                    {"lumped", ImplicitDynamics::Mass::lumped}};

} // namespace

void ImplicitDynamics::declare(ParameterHandler &prm) {
  declare_selection(
      prm, "Method", "generalised-alpha", time_integrator_types(),
      "Time integration method. Contact requires some damping of motions that the step does not resolve.");
  prm.declare_entry("Mass", "consistent", Patterns::Selection(selection(masses)),
                    "Mass matrix. consistent: that of the shape functions. lumped: its row sums at the "
                    "nodes, as in explicit scenes.");
  prm.declare_entry(
      "Error tolerance", "1e-3", Patterns::Double(),
      "Automatic steps: maximum error of the time integration in a step, as a part of the "
      "reference displacement. It is a root mean square over the mass (Zienkiewicz & Xie "
      "1991). The error cuts steps and limits their growth. 0: steps depend on the iterations only.");
  prm.declare_entry("Reference displacement", "0", Patterns::Double(),
                    "Displacement to which the error tolerance refers. 0: maximum displacement so far (root "
                    "mean square over the mass), at least a millionth of the scene's radius. Rigid-body "
                    "motion counts up to the maximum radius of gyration. [length]");
  prm.declare_entry("Maximum energy drift", "0.05", Patterns::Double(),
                    "The run fails if the energies are off balance by more than this part of the maximum "
                    "energy so far. 0: it continues, and prints a warning at 5 %.");
}

void ImplicitDynamics::parse(Reader &reader, const bool steps_are_fixed) {
  integrator = make_selected(reader, "Method", time_integrator_types());
  mass = chosen(masses, reader.text("Mass"));
  error_tolerance = reader.not_negative("Error tolerance");
  reference_displacement = reader.not_negative("Reference displacement");
  max_drift = reader.not_negative("Maximum energy drift");
  if (steps_are_fixed)
    for (const std::string key : {"Error tolerance", "Reference displacement"})
      if (reader.is_set(key))
        reader.reject(key, "no value: steps are fixed");
  if (error_tolerance == 0. && reader.is_set("Reference displacement"))
    reader.reject("Reference displacement", "no value: there is no 'Error tolerance'");
  if (steps_are_fixed)
    error_tolerance = 0.;
}

} // namespace billet::parameters
