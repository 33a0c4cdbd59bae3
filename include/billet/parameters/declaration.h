// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_DECLARATION_H
#define BILLET_PARAMETERS_DECLARATION_H

namespace dealii {
class ParameterHandler;
}

namespace billet::parameters {

/// Start of the placeholder for the name of a surface; shape and bracket follow.
constexpr const char *name_of_surface = "(name of a surface of shape ";

/// Declares all parameters that a scene may have. A placeholder such as "(name of a body)" stands
/// for subsections that users name.
void declare_every_parameter(dealii::ParameterHandler &prm);

} // namespace billet::parameters

#endif
