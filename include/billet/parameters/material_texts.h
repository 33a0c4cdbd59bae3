// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_MATERIAL_TEXTS_H
#define BILLET_PARAMETERS_MATERIAL_TEXTS_H

#include "billet/parameters/scene.h"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace billet::parameters {

/// Parameters of a body's material that the scene sets, with their values.
using MaterialTexts = std::map<std::string, std::string>;

MaterialTexts find_material_texts(const Scene &scene, const std::string &body);

/// Parameter with two values, "default" for one that is not set.
struct ChangedParameter {
  std::string key, before, after;
};

/// Returns the parameters whose values differ. Numbers are compared as numbers, also in lists and
/// tables, and a parameter that is not set has its default.
std::vector<ChangedParameter> compare_materials(const MaterialTexts &before, const MaterialTexts &after);

/// Returns the number of each body's material, from 0 in the order of the bodies. Bodies whose
/// materials have the same parameters have the same number.
std::vector<std::size_t> number_materials(const Scene &scene);

} // namespace billet::parameters

#endif
