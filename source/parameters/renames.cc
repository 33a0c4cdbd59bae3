// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/renames.h"

#include <algorithm>

namespace billet {

const std::vector<Rename> &renames() {
  static const std::vector<Rename> table = {
      {{"Bodies", "*"},
       "Stabilise",
       "Contact stabilisation",
       {{"no", "none"}, {"until touched", "until contact"}}},
      {{"Bodies", "*", "Material"}, "Kinematics", "Elasticity", {}},
      {{"Tools", "*", "Surfaces", "*"}, "Sharp angle", "Feature angle", {}},
      {{"Tools", "*", "Motion"}, "Removed at", "Removal time", {}},
      {{"Contact pairs", "*"}, "Edges", "Edge contact", {}},
      {{"Contact pairs", "*"}, "Penalty of", "Reference stiffness", {}},
      {{"Contact pairs", "*"}, "Largest shear stress", "Maximum shear stress", {}},
      {{"Contact pairs", "*"}, "Decay", "Decay coefficient", {}},
      {{"Time stepping"}, "Smallest step", "Minimum step", {}},
      {{"Time stepping"}, "Largest step", "Maximum step", {}},
      {{"Time stepping"}, "Few iterations", "Growth iterations", {}},
      {{"Time stepping"}, "Many iterations", "Shrink iterations", {}},
      {{"Explicit dynamics"}, "Largest drift", "Maximum energy drift", {}},
      {{"Explicit dynamics"}, "Instructions", "Instruction set", {}},
      {{"Implicit dynamics"}, "Largest drift", "Maximum energy drift", {}},
      {{"Solver"}, "Most iterations", "Maximum iterations", {}},
      {{"Solver"}, "Most augmentations", "Maximum augmentations", {}},
      {{"Solver"}, "Most linear iterations", "Maximum linear iterations", {}},
      {{"Solver"}, "Forcing", "Forcing term", {}},
      {{"Output"}, "Every steps", "Step interval", {}},
      {{"Output", "Checkpoint"}, "Every steps", "Step interval", {}},
  };
  return table;
}

namespace {

bool matches(const std::vector<std::string> &pattern, const std::vector<std::string> &path) {
  return std::equal(pattern.begin(), pattern.end(), path.begin(), path.end(),
                    [](const std::string &expected, const std::string &name) {
                      return expected == "*" || expected == name;
                    });
}

} // namespace

CurrentNames current_names(const std::vector<std::string> &path, const std::string &key,
                           const std::string &value) {
  const auto rename = std::find_if(renames().begin(), renames().end(), [&](const Rename &candidate) {
    return (key == candidate.old_key || key == candidate.key) && matches(candidate.path, path);
  });
  if (rename == renames().end())
    return {key, value};
  const auto renamed_value = std::find_if(rename->values.begin(), rename->values.end(),
                                          [&](const auto &names) { return names.first == value; });
  return {rename->key, renamed_value == rename->values.end() ? value : renamed_value->second};
}

} // namespace billet
