// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/material_texts.h"

#include "billet/parameters/scene_file.h"

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace billet::parameters {

namespace {

/// Returns the words of a value: lists and tables may be written with any blanks.
std::vector<std::string> split_words(const std::string &value) {
  std::string spaced;
  for (const char c : value)
    spaced += c == ',' || c == ':' || c == ';' ? std::string{' ', c, ' '} : std::string{c};
  std::istringstream stream(spaced);
  return {std::istream_iterator<std::string>(stream), std::istream_iterator<std::string>()};
}

bool is_same_word(const std::string &before, const std::string &after) {
  try {
    return parse_number(before) == parse_number(after);
  } catch (const std::invalid_argument &) { // a name or a separator
    return before == after;
  }
}

bool is_same_value(const std::string &before, const std::string &after) {
  const std::vector<std::string> then = split_words(before), now = split_words(after);
  return std::equal(then.begin(), then.end(), now.begin(), now.end(), is_same_word);
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
  dealii::ParameterHandler defaults;
  Material::declare(defaults);
  const auto find = [&](const MaterialTexts &material, const std::string &key) -> std::string {
    const auto found = material.find(key);
    return found != material.end() ? found->second : defaults.get(key);
  };
  const auto show = [](const MaterialTexts &material, const std::string &key) -> std::string {
    const auto found = material.find(key);
    return found != material.end() ? found->second : "default";
  };
  std::vector<ChangedParameter> changed;
  for (const auto &[key, unused] : all)
    if (!is_same_value(find(before, key), find(after, key)))
      changed.push_back({key, show(before, key), show(after, key)});
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
