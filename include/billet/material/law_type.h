// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_LAW_TYPE_H
#define BILLET_MATERIAL_LAW_TYPE_H

#include "billet/material/elasticity.h"

#include <string>

namespace billet {

/// Laws that are not made of an elasticity and a hardening law. Scenes name them by 'Law'. A new
/// one is a file in source/material/ with a function that returns its type, and its name in the
/// table of law_type.cc. PointLaw::name() is the name of the type.
TypeTable<SharedLaw> &law_types();

/// Returns name and description of a law for users; the name alone if 'Law' selects it.
std::string describe_law(const PointLaw &law);

} // namespace billet

#endif
