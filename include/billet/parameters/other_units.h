// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_OTHER_UNITS_H
#define BILLET_PARAMETERS_OTHER_UNITS_H

#include "billet/material/certificate.h"
#include "billet/parameters/scene.h"

#include <functional>
#include <string>
#include <vector>

namespace billet::parameters {

using Settings = std::vector<SceneFile::Setting>;

/// Reads the scene with more settings. Throws InputError.
using SceneReader = std::function<Scene(const Settings &more)>;

/// Returns the materials of all bodies with numbers in other units. The unit stands at the end of
/// each parameter's meaning, such as [stress] or [1/time]. Defaults are turned, too. `entries`: of
/// the scene.
///
/// A material may have no law, but a reason. This is so if a parameter has an unknown unit, is no
/// list or table of numbers, or names a file of them.
std::vector<OtherUnits> in_other_units(const Scene &scene, const std::vector<SceneFile::Entry> &entries,
                                       const SceneReader &read);

} // namespace billet::parameters

#endif
