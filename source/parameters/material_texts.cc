// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/material_texts.h"

#include "billet/parameters/scene_file.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace billet::parameters {

namespace {

bool is_same_value(const std::string &before, const std::string &after) {
  try {
    return parse_number(before) == parse_number(after);
  } catch (const std::invalid_argument &) { // a name, a table or a file
    return before == after;
  }
}

} // namespace

MaterialTexts find_material_texts(const Scene &scene, const std::string &body) {
  std::istringstream text(scene.text);
  const SceneFile file = SceneFile::scan(text, scene.file_name);
  MaterialTexts material;
  for (const SceneFile::Entry &entry : file.entries())
    if (entry.path == SceneFile::Path{"Bodies", body, "Material"})
      material[entry.key] = entry.value;
  return material;
}

std::vector<ChangedParameter> compare_materials(const MaterialTexts &before, const MaterialTexts &after) {
  MaterialTexts all = before;
  all.insert(after.begin(), after.end());
  const auto find = [](const MaterialTexts &material, const std::string &key) -> std::string {
    const auto found = material.find(key);
    return found == material.end() ? "default" : found->second;
  };
  std::vector<ChangedParameter> changed;
  for (const auto &[key, unused] : all)
    if (const std::string then = find(before, key), now = find(after, key); !is_same_value(then, now))
      changed.push_back({key, then, now});
  return changed;
}

std::vector<std::size_t> number_materials(const Scene &scene) {
  std::vector<MaterialTexts> materials;
  std::vector<std::size_t> numbers;
  for (const Body &body : scene.bodies) {
    const MaterialTexts own = find_material_texts(scene, body.name);
    const auto same = std::find_if(materials.begin(), materials.end(), [&](const MaterialTexts &other) {
      return compare_materials(other, own).empty();
    });
    numbers.push_back(static_cast<std::size_t>(same - materials.begin()));
    if (same == materials.end())
      materials.push_back(own);
  }
  return numbers;
}

} // namespace billet::parameters
