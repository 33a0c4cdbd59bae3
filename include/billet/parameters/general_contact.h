// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_GENERAL_CONTACT_H
#define BILLET_PARAMETERS_GENERAL_CONTACT_H

#include "billet/parameters/reader.h"

#include <string>
#include <vector>

namespace dealii {
class ParameterHandler;
}

namespace billet::parameters {

/// Declares 'Contact' and the subsection 'General contact'.
void declare_general_contact(dealii::ParameterHandler &prm);

/// Adds the contact pairs that 'Contact = all' stands for. They are those of all exterior faces of
/// each body with those of each other body, with themselves, and with each tool. A pair that the
/// scene has itself replaces the one of the same bodies, or body and tool. It takes the values that
/// it does not set from 'General contact'.
///
/// Does nothing without 'Contact = all', and leaves errors to check_general_contact(). Returns the
/// names of the new pairs.
std::vector<std::string> add_general_contact(SceneFile &file);

/// Refuses values of 'General contact' that nothing uses, and exclusions of what the scene does not
/// have.
void check_general_contact(Reader &reader, const SceneFile &file);

} // namespace billet::parameters

#endif
