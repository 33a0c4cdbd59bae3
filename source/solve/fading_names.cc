// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/fading_names.h"

#include "billet/discretization/support_reactions.h"

#include <algorithm>
#include <sstream>

namespace billet {

namespace {

using Indices = std::vector<std::optional<std::size_t>>;

std::vector<std::string> names_of_supports(const Scene &scene) {
  std::vector<std::string> names;
  for (const NamedSupport &support : named_supports(scene))
    names.push_back(scene.bodies()[support.body].name + "." + support.name);
  return names;
}

std::vector<std::string> names_of_pairs(const Scene &scene) {
  std::vector<std::string> names;
  for (const ContactPair &pair : scene.pairs())
    names.push_back(pair.name);
  return names;
}

/// Returns the names, one a line.
std::string lines_of(const Indices &indices, const std::vector<std::string> &names) {
  std::string lines;
  for (const std::optional<std::size_t> &index : indices)
    lines += (index ? names[*index] : std::string()) + "\n";
  return lines;
}

Indices find_names(const std::string &lines, const std::vector<std::string> &names) {
  Indices indices;
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);) {
    const auto found = std::find(names.begin(), names.end(), line);
    if (found == names.end())
      indices.emplace_back();
    else
      indices.emplace_back(found - names.begin());
  }
  return indices;
}

} // namespace

void save_fading_supports(StateWriter &writer, const Scene &scene, const Indices &supports) {
  if (!supports.empty())
    writer.write_text("fading supports", lines_of(supports, names_of_supports(scene)));
}

Indices load_fading_supports(const StateReader &reader, const Scene &scene, const std::size_t n) {
  Indices supports;
  if (reader.has("fading supports"))
    supports = find_names(reader.read_text("fading supports"), names_of_supports(scene));
  supports.resize(n);
  return supports;
}

void save_fading_pairs(StateWriter &writer, const Scene &scene, const Indices &pairs) {
  writer.write_text("fading pairs", lines_of(pairs, names_of_pairs(scene)));
}

std::vector<FadingPair> load_fading_pairs(const StateReader &reader, const Scene &scene) {
  std::vector<FadingPair> pairs;
  for (const std::optional<std::size_t> &pair :
       find_names(reader.read_text("fading pairs"), names_of_pairs(scene)))
    pairs.push_back({pair, fading_rows(pairs.size())});
  return pairs;
}

std::string fading_rows(const std::size_t index) { return "fading of pair " + std::to_string(index); }

} // namespace billet
