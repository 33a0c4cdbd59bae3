// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_DECLARATION_H
#define BILLET_PARAMETERS_DECLARATION_H

namespace dealii {
class ParameterHandler;
}

namespace billet::parameters {

/// Begins the name that stands for any surface's; the shape and a bracket follow.
constexpr const char *name_of_surface = "(name of a surface of shape ";

/// Declares all parameters that a scene may have. Subsections that users name have a name that says so, such
/// as
/// "(name of a body)".
void declare_every_parameter(dealii::ParameterHandler &prm);

} // namespace billet::parameters

#endif
