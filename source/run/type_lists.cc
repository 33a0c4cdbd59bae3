// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/type_lists.h"

#include "billet/errors.h"
#include "billet/friction/friction_law.h"
#include "billet/geometry/cad_file.h"
#include "billet/geometry/surface_type.h"
#include "billet/integration/time_integrator_type.h"
#include "billet/loads/load.h"
#include "billet/material/anisotropy.h"
#include "billet/material/elasticity.h"
#include "billet/material/hardening.h"
#include "billet/material/law_type.h"
#include "billet/material/rate_factor.h"
#include "billet/material/thermal_factor.h"
#include "billet/material/volumetric_law.h"
#include "billet/mechanics/element_type.h"
#include "billet/nearest_name.h"
#include "billet/output/field_quantity.h"
#include "billet/output/history_quantity.h"
#include "billet/parameters/primitives.h"
#include "billet/probes/probe.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <sstream>

namespace billet {

namespace {

using Json = nlohmann::ordered_json;

/// Entry of a list.
struct Named {
  struct Parameter {
    std::string key, default_value, meaning;
  };

  std::string name, meaning;
  std::string how; ///< how a scene file names it, "set Shape = torus"
  std::vector<Parameter> parameters;
  std::vector<parameters::Primitive::Boundary> boundaries;
};

/// Types that scene files can name in one place.
struct TypeList {
  std::string name, meaning;
  std::function<std::vector<Named>()> entries;
};

template <class Table> void add_types(const Table &table, const std::string &key, std::vector<Named> &all) {
  for (const auto &type : table) {
    Named entry{type.name, type.meaning, "set " + key + " = " + type.name, {}, {}};
    for (const TypeParameter &parameter : type.parameters)
      entry.parameters.push_back({parameter.key, parameter.default_value, parameter.meaning});
    all.push_back(entry);
  }
}

/// Returns the entries of a function that returns a table of registered types.
template <class Table> std::function<std::vector<Named>()> types_of(Table &(*table)(), const char *key) {
  return [table, key] {
    std::vector<Named> all;
    add_types(table(), key, all);
    return all;
  };
}

std::vector<Named> list_primitives() {
  std::vector<Named> all;
  for (const auto &primitive : parameters::primitives()) {
    const bool is_section = primitive.dimension == 2;
    Named entry{primitive.name,
                primitive.meaning,
                std::string(is_section ? "set Source = extruded primitive; " : "") +
                    "set Primitive = " + primitive.name + "; set Arguments = " + primitive.usage(),
                {},
                primitive.boundaries};
    for (const auto &argument : primitive.arguments)
      entry.parameters.push_back(
          {argument.name, argument.default_value.value_or("necessary"), argument.meaning});
    if (is_section) {
      unsigned int largest = 0;
      for (const auto &boundary : primitive.boundaries)
        largest = std::max(largest, boundary.id);
      entry.boundaries.push_back({largest + 1, "bottom, z = 0"});
      entry.boundaries.push_back({largest + 2, "top, z = Height"});
    }
    all.push_back(entry);
  }
  return all;
}

std::vector<Named> list_materials() {
  std::vector<Named> all;
  add_types(law_types(), "Law", all);
  add_types(elasticity_types(), "Elasticity", all);
  add_types(volumetric_law_types(), volumetric_law_key, all);
  add_types(hardening_types(), "Hardening", all);
  add_types(rate_factor_types(), "Rate factor", all);
  add_types(thermal_factor_types(), "Thermal factor", all);
  add_types(anisotropy_types(), "Anisotropy", all);
  return all;
}

std::string unit_of(const std::string &unit) { return unit.empty() ? "" : " [" + unit + "]"; }

std::vector<Named> list_fields() {
  std::vector<Named> all;
  for (const NodalQuantity &quantity : field_quantities().nodal())
    all.push_back({quantity.name, "At the nodes." + unit_of(quantity.unit), "", {}, {}});
  for (const ElementQuantity &quantity : field_quantities().of_elements()) {
    std::string components;
    for (const auto &component : quantity.components)
      components += (components.empty() ? "" : ", ") + component;
    all.push_back(
        {quantity.name, "In the elements: " + components + "." + unit_of(quantity.unit), "", {}, {}});
  }
  return all;
}

std::vector<Named> list_history() {
  std::vector<Named> all;
  for (const HistoryQuantity &quantity : history_quantities()) {
    all.push_back({quantity.name, "Columns of history.csv.", "", {}, {}});
    for (const HistoryColumns &columns : quantity.meanings)
      all.back().parameters.push_back({columns.names, "", columns.meaning});
  }
  return all;
}

const std::vector<TypeList> &type_lists() {
  static const std::vector<TypeList> lists = {
      {"primitives", "bodies that need no mesh file: 'Bodies / NAME / Mesh'", &list_primitives},
      {"materials", "laws, elasticity, hardening, factors and anisotropy: 'Bodies / NAME / Material'",
       &list_materials},
      {"elements", "formulations of bricks: 'Bodies / NAME'", types_of(&element_types, "Element")},
      {"loads", "loads on bodies: 'Bodies / NAME / Loads / NAME'", types_of(&load_types, "Type")},
      {"surfaces", "surfaces of tools: 'Tools / NAME / Surfaces / NAME'", types_of(&surface_types, "Shape")},
      {"friction", "friction laws: 'Contact pairs / NAME'", types_of(&friction_law_types, "Friction law")},
      {"integrators", "time integrators: 'Implicit dynamics'", types_of(&time_integrator_types, "Method")},
      {"probes", "quantities at points, paths and sets: 'Probes / NAME'", types_of(&probe_types, "Type")},
      {"fields", "quantities of field output", &list_fields},
      {"history", "quantities of the history", &list_history}};
  return lists;
}

/// Prints a text in lines of at most 100 columns. The first line begins with `line`, the others
/// with blanks.
void print_wrapped(std::ostream &stream, const std::string &text, std::string line,
                   const std::size_t indent) {
  constexpr std::size_t width = 100;
  std::istringstream words(text);
  bool is_first = true;
  for (std::string word; words >> word; is_first = false) {
    if (!is_first && line.size() + 1 + word.size() > width) {
      stream << line << "\n";
      line = std::string(indent, ' ');
      is_first = true;
    }
    line += (is_first ? "" : " ") + word;
  }
  stream << line << "\n";
}

/// Prints a text behind `first`, with the same indent in all lines. If `first` leaves it too little
/// space, it has lines of its own.
void print_indented(std::ostream &stream, const std::string &text, std::string first,
                    const std::size_t indent) {
  constexpr std::size_t max_width = 70;
  if (first.size() > max_width) {
    const std::size_t begin = first.find_first_not_of(' ');
    print_wrapped(stream, first.substr(begin), std::string(begin, ' '), begin + 2);
    first.clear();
  }
  first.resize(std::max(first.size() + (first.empty() ? 0 : 2), indent), ' ');
  print_wrapped(stream, text, first, indent);
}

void print(std::ostream &stream, const Named &entry) {
  stream << entry.name << "\n";
  print_indented(stream, entry.meaning, "", 4);
  if (!entry.how.empty())
    print_wrapped(stream, entry.how, "    ", 8);
  std::size_t width = 0;
  for (const auto &parameter : entry.parameters)
    width = std::max(width, parameter.key.size() + 3 + parameter.default_value.size());
  for (const auto &parameter : entry.parameters)
    print_indented(stream, parameter.meaning,
                   entry.how.empty() ? "      " + parameter.key
                                     : "      " + parameter.key + " = " + parameter.default_value,
                   std::min<std::size_t>(8 + width, 50));
  std::string faces;
  for (const auto &boundary : entry.boundaries)
    faces += (faces.empty() ? "" : "; ") + std::to_string(boundary.id) + " " + boundary.meaning;
  if (!faces.empty())
    print_indented(stream, faces, "      Boundary ids:", 8);
  stream << "\n";
}

Json as_object(const Named &entry) {
  Json object = {{"name", entry.name}, {"meaning", entry.meaning}};
  if (!entry.how.empty())
    object["use"] = entry.how;
  object["parameters"] = Json::array();
  for (const auto &parameter : entry.parameters)
    object["parameters"].push_back(
        {{"name", parameter.key}, {"default", parameter.default_value}, {"meaning", parameter.meaning}});
  if (!entry.boundaries.empty())
    object["boundary ids"] = Json::array();
  for (const auto &boundary : entry.boundaries)
    object["boundary ids"].push_back({{"id", boundary.id}, {"meaning", boundary.meaning}});
  return object;
}

/// Throws InputError that names the known names.
[[noreturn]] void refuse(const std::string &name, const std::string &what,
                         const std::vector<std::string> &known) {
  std::string all;
  for (const auto &one : known)
    if (all.empty() || one != known.front()) // sections and bodies share names
      all += (all.empty() ? "" : ", ") + one;
  throw InputError("command line: '" + name + "' is no " + what + "; allowed is one of: " + all +
                   did_you_mean(name, known));
}

/// Prints the faces of CAD files, with their numbers in scenes.
void print_faces(std::ostream &stream, const std::vector<std::string> &files, const bool as_json) {
  Json array = Json::array();
  for (const std::string &file : files) {
    const std::vector<CadFace> faces = list_cad_faces(file);
    if (!as_json)
      stream << file << ": " << faces.size() << " faces; coordinates in mm\n";
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const auto &[low, high] = faces[i].box;
      if (as_json) {
        array.push_back({{"file", file},
                         {"number", i + 1},
                         {"kind", faces[i].kind},
                         {"least", {low[0], low[1], low[2]}},
                         {"largest", {high[0], high[1], high[2]}},
                         {"neighbours", faces[i].neighbours}});
        continue;
      }
      const auto rounded = [](const double x) { return std::abs(x) < 1e-6 ? 0. : x; };
      std::ostringstream number, line;
      number << std::setw(6) << i + 1 << "  ";
      line << faces[i].kind;
      for (unsigned int c = 0; c < 3; ++c)
        line << ", "
             << "xyz"[c] << " " << rounded(low[c]) << " to " << rounded(high[c]);
      for (const std::size_t neighbour : faces[i].neighbours)
        line << (neighbour == faces[i].neighbours.front() ? "; beside " : ", ") << neighbour;
      print_wrapped(stream, line.str(), number.str(), 10);
    }
  }
  if (as_json)
    stream << array.dump(1) << "\n";
}

void print_lists(std::ostream &stream, const bool as_json) {
  Json array = Json::array();
  for (const TypeList &list : type_lists()) {
    array.push_back({{"name", list.name}, {"meaning", list.meaning}});
    if (!as_json)
      print_indented(stream, list.meaning, list.name, 14);
  }
  if (as_json)
    stream << array.dump(1) << "\n";
  else
    stream << "\nbillet --list LIST shows all of a list, billet --list LIST NAME one entry, and\n"
              "billet --list faces FILE.step the faces of a CAD file.\n";
}

} // namespace

void print_types(std::ostream &stream, const std::vector<std::string> &names, const bool as_json) {
  if (names.empty()) {
    print_lists(stream, as_json);
    return;
  }
  if (names.front() == "faces") {
    if (names.size() == 1)
      throw InputError("command line: '--list faces' names no file; allowed are STEP and IGES files");
    print_faces(stream, {names.begin() + 1, names.end()}, as_json);
    return;
  }
  std::vector<std::string> known;
  const TypeList *found = nullptr;
  for (const TypeList &list : type_lists()) {
    known.push_back(list.name);
    if (list.name == names.front())
      found = &list;
  }
  if (found == nullptr)
    refuse(names.front(), "list", known);
  const std::vector<Named> entries = found->entries();
  known.clear();
  for (const Named &entry : entries)
    if (std::find(known.begin(), known.end(), entry.name) == known.end())
      known.push_back(entry.name);
  for (std::size_t i = 1; i < names.size(); ++i)
    if (std::find(known.begin(), known.end(), names[i]) == known.end())
      refuse(names[i], "entry of the list '" + found->name + "'", known);
  if (!as_json && names.size() == 1)
    stream << found->name << ": " << found->meaning << "\n\n";
  Json array = Json::array();
  for (const Named &entry : entries)
    if (names.size() == 1 || std::find(names.begin() + 1, names.end(), entry.name) != names.end()) {
      if (as_json)
        array.push_back(as_object(entry));
      else
        print(stream, entry);
    }
  if (as_json)
    stream << array.dump(1) << "\n";
}

} // namespace billet
