// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/general_contact.h"

#include "billet/nearest_name.h"
#include "billet/parameters/tool.h"
#include "billet/registered_type.h"

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>

namespace billet::parameters {

namespace {

using Path = SceneFile::Path;

constexpr const char *switch_key = "Contact", *section = "General contact", *pairs_section = "Contact pairs",
                     *exclusions_key = "Exclusions", *self_key = "Self-contact";

/// A body and what its faces touch: a tool, another body, or the body itself.
struct Partners {
  std::string body, other;
  bool is_with_tool;

  bool is_with_itself() const { return !is_with_tool && body == other; }
  /// Whether both are the same, in whatever order.
  bool operator==(const Partners &second) const {
    return is_with_tool == second.is_with_tool &&
           ((body == second.body && other == second.other) ||
            (!is_with_tool && body == second.other && other == second.body));
  }
};

/// Two names, or one alone, whose second is empty: all pairs of this body or tool.
using Exclusion = std::array<std::string, 2>;

bool excludes(const Exclusion &exclusion, const Partners &partners) {
  const auto &[first, second] = exclusion;
  if (second.empty())
    return partners.body == first || partners.other == first;
  return (partners.body == first && partners.other == second) ||
         (partners.body == second && partners.other == first);
}

/// Returns the exclusions of a text 'a : b ; c'. Parts of the wrong form are left out, and noted.
std::vector<Exclusion> parse_exclusions(const std::string &text, std::vector<std::string> &faulty) {
  std::vector<Exclusion> exclusions;
  for (const auto &part : dealii::Utilities::split_string_list(text, ';')) {
    if (part.empty())
      continue;
    const auto names = dealii::Utilities::split_string_list(part, ':');
    if (names.size() > 2 || part.back() == ':' || std::count(names.begin(), names.end(), "") > 0)
      faulty.push_back(part);
    else
      exclusions.push_back({names[0], names.size() > 1 ? names[1] : ""});
  }
  return exclusions;
}

/// Returns the partners of a pair of the scene; the other is empty if the pair has none.
Partners partners_of(const SceneFile &file, const std::string &pair) {
  const Path path = {pairs_section, pair};
  const std::string tool = file.value(path, "Tool", "");
  return {file.value(path, "Body", ""), tool.empty() ? file.value(path, "Second body", "") : tool,
          !tool.empty()};
}

/// Returns the Young's modulus that a body sets; 0 if it sets no number.
double young_modulus(const SceneFile &file, const std::string &body) {
  try {
    return parse_number(file.value({"Bodies", body, "Material"}, "Young modulus", "0"));
  } catch (const std::invalid_argument &) { // reported when the body is read
    return 0.;
  }
}

/// Returns two bodies, the softer one first where both moduli are known: its nodes are the slaves
/// in one pass. Those of a much stiffer body let the soft one through between them.
Partners soft_before_stiff(const SceneFile &file, const std::string &body, const std::string &other) {
  const double modulus = young_modulus(file, body), of_other = young_modulus(file, other);
  return of_other > 0. && of_other < modulus ? Partners{other, body, false} : Partners{body, other, false};
}

/// Returns all partners of the scene that 'General contact' does not exclude.
std::vector<Partners> all_partners(const SceneFile &file) {
  std::vector<std::string> faulty;
  const auto exclusions = parse_exclusions(file.value({section}, exclusions_key, ""), faulty);
  const std::string with_itself = file.value({section}, self_key, "true");
  const bool has_self_contact = with_itself == "true" || with_itself == "yes";
  std::vector<Partners> all;
  const auto add = [&](const Partners &partners) {
    const bool is_excluded =
        (partners.is_with_itself() && !has_self_contact) ||
        std::any_of(exclusions.begin(), exclusions.end(),
                    [&](const Exclusion &exclusion) { return excludes(exclusion, partners); });
    if (!is_excluded)
      all.push_back(partners);
  };
  const std::vector<std::string> bodies = file.names_below({"Bodies"});
  for (auto body = bodies.begin(); body != bodies.end(); ++body) {
    for (const auto &tool : file.names_below({"Tools"}))
      add({*body, tool, true});
    for (auto other = body; other != bodies.end(); ++other)
      add(soft_before_stiff(file, *body, *other));
  }
  return all;
}

/// Returns the parameters of a printed list of them.
std::vector<std::string> keys_of(void (*declare)(dealii::ParameterHandler &)) {
  dealii::ParameterHandler prm;
  declare(prm);
  std::ostringstream printed;
  prm.print_parameters(printed, dealii::ParameterHandler::ShortPRM);
  std::istringstream text(printed.str());
  std::vector<std::string> keys;
  const SceneFile file = SceneFile::scan(text, "");
  for (const auto &entry : file.entries())
    keys.push_back(entry.key);
  return keys;
}

bool contains(const std::vector<std::string> &keys, const std::string &key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// Returns the parameters, among them this one, that make sense together only: a pair that sets one
/// of them takes none from 'General contact'.
std::vector<std::string> group_of(const std::string &key) {
  std::vector<std::string> friction = {"Friction law"};
  for (const auto &type : friction_law_types())
    for (const auto &parameter : type.parameters)
      friction.push_back(parameter.key);
  // The tangential penalty needs friction, and has the unit of the normal penalty.
  std::vector<std::string> tangential = friction;
  const std::vector<std::string> penalties = {"Penalty unit", "Normal penalty", "Tangential penalty"};
  tangential.insert(tangential.end(), penalties.begin(), penalties.end());
  if (key == "Tangential penalty")
    return tangential;
  const std::vector<std::vector<std::string>> groups = {
      friction, penalties, {"Facets", "Edge contact", "Smoothing"}, {"Initial penetration", "Ramp time"}};
  for (const auto &group : groups)
    if (contains(group, key))
      return group;
  return {key};
}

/// Gives a pair all exterior faces and the values of 'General contact', where it sets nothing
/// itself.
void complete(SceneFile &file, const std::string &pair, const std::vector<SceneFile::Entry> &values) {
  const Path path = {pairs_section, pair};
  const Partners partners = partners_of(file, pair);
  const std::string where = file.where(path);
  if (!file.is_set(path, "Boundary ids"))
    file.add_entry(path, "Boundary ids", "all", where);
  if (!partners.is_with_tool && !partners.is_with_itself() && !file.is_set(path, "Second boundary ids"))
    file.add_entry(path, "Second boundary ids", "all", where);
  const std::vector<std::string> of_bodies = keys_of(&ContactPair::declare_values_of_bodies);
  std::vector<SceneFile::Entry> taken;
  for (const auto &entry : values) {
    const std::vector<std::string> group = group_of(entry.key);
    const bool is_of_no_use = (partners.is_with_tool && contains(of_bodies, entry.key)) ||
                              (partners.is_with_itself() && entry.key == "Passes" && entry.value == "one");
    if (!is_of_no_use && std::none_of(group.begin(), group.end(),
                                      [&](const std::string &key) { return file.is_set(path, key); }))
      taken.push_back(entry);
  }
  for (const auto &entry : taken)
    file.copy_entry(entry, path);
}

void check_exclusions(Reader &reader, const SceneFile &file) {
  std::vector<std::string> faulty;
  const auto exclusions = parse_exclusions(reader.text(exclusions_key), faulty);
  if (!faulty.empty())
    reader.reject(exclusions_key,
                  "'name : name' or 'name', separated by semicolons, with names of bodies and "
                  "tools, not '" +
                      faulty.front() + "'");
  const std::vector<std::string> bodies = file.names_below({"Bodies"});
  std::vector<std::string> known = bodies;
  for (const auto &tool : file.names_below({"Tools"}))
    known.push_back(tool);
  std::string list;
  for (const auto &name : known)
    list += (list.empty() ? "" : ", ") + name;
  for (const auto &exclusion : exclusions) {
    bool are_known = true;
    for (const auto &name : exclusion)
      if (!name.empty() && !contains(known, name)) {
        are_known = false;
        const std::string advice = did_you_mean(name, known);
        reader.note_errors([&] {
          throw InputError(reader.origin(exclusions_key) + " names '" + name + "'" +
                           (advice.empty() ? "; allowed" : advice + " Allowed") +
                           " are bodies and tools: " + list);
        });
      }
    if (!are_known)
      continue;
    if (!exclusion[1].empty() && !contains(bodies, exclusion[0]) && !contains(bodies, exclusion[1]))
      throw InputError(reader.origin(exclusions_key) + " names '" + exclusion[0] + " : " + exclusion[1] +
                       "', which are tools; allowed are pairs with a body, since tools do not touch each "
                       "other");
    for (const auto &pair : file.names_below({pairs_section}))
      if (excludes(exclusion, partners_of(file, pair)))
        throw InputError(reader.origin(exclusions_key) + " names '" + exclusion[0] +
                         (exclusion[1].empty() ? "" : " : " + exclusion[1]) +
                         "'; allowed is what has no contact pair, but the scene has '" + pair + "' (" +
                         file.where({pairs_section, pair}) + ")");
  }
}

} // namespace

void declare_general_contact(dealii::ParameterHandler &prm) {
  prm.declare_entry(
      switch_key, "pairs", dealii::Patterns::Selection("pairs|all"),
      "pairs: what touches is in 'Contact pairs'. all: the exterior faces of all bodies touch "
      "each other, themselves and all tools, except those on symmetry planes. Of two bodies the "
      "softer one is 'Body'. A contact pair of the scene replaces that of the same two.");
  prm.enter_subsection(section);
  prm.declare_entry(
      exclusions_key, "", dealii::Patterns::Anything(),
      "What does not touch with 'Contact = all', separated by semicolons. Two names of bodies or tools, such "
      "as 'sheet : punch', exclude their contact. One name twice, such as 'sheet : sheet', excludes "
      "self-contact. One name alone excludes all contact of this body or tool.");
  prm.declare_entry(self_key, "true", dealii::Patterns::Bool(),
                    "Whether the faces of a body touch each other with 'Contact = all'.");
  ContactPair::declare_values(prm);
  prm.leave_subsection();
}

std::vector<std::string> add_general_contact(SceneFile &file) {
  if (file.value({}, switch_key, "pairs") != "all")
    return {};
  const std::vector<std::string> keys = keys_of(&ContactPair::declare_values);
  std::vector<SceneFile::Entry> values;
  for (const auto &entry : file.entries())
    if (entry.path == Path{section} && contains(keys, entry.key))
      values.push_back(entry);

  std::vector<std::string> names = file.names_below({pairs_section}), added;
  std::vector<Partners> of_scene;
  for (const auto &name : names) {
    of_scene.push_back(partners_of(file, name));
    complete(file, name, values);
  }
  const std::string where = file.where({}, switch_key);
  for (const auto &partners : all_partners(file)) {
    if (std::find(of_scene.begin(), of_scene.end(), partners) != of_scene.end())
      continue;
    const std::string base = partners.body + " on " + (partners.is_with_itself() ? "itself" : partners.other);
    std::string name = base;
    for (unsigned int i = 2; contains(names, name); ++i)
      name = base + " " + std::to_string(i);
    names.push_back(name);
    added.push_back(name);
    const Path path = {pairs_section, name};
    file.add_subsection(path, where);
    file.add_entry(path, "Body", partners.body, where);
    file.add_entry(path, partners.is_with_tool ? "Tool" : "Second body", partners.other, where);
    complete(file, name, values);
  }
  return added;
}

void check_general_contact(Reader &reader, const SceneFile &file) {
  const bool is_general = reader.text(switch_key) == "all";
  reader.in(section, [&] {
    const SceneFile::Entry *entry = file.first_entry({section});
    if (!is_general && entry != nullptr)
      reader.reject(entry->key, std::string("no value: only '") + switch_key + " = all' uses it");
    if (is_general)
      check_exclusions(reader, file);
  });
}

} // namespace billet::parameters
