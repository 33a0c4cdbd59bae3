// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/other_units.h"

#include "billet/errors.h"
#include "billet/registered_type.h"

#include <deal.II/base/function_parser.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace billet::parameters {

namespace {

/// Other units, in parts of the first ones: numbers of lengths become so many times as large.
constexpr double length_factor = 1e3, mass = 1e-3, duration = 1e3, temperature = 1.8,
                 stress = mass / (length_factor * duration * duration),
                 energy = stress * length_factor * length_factor * length_factor;

/// Unit and default of a parameter.
struct Dimensional {
  std::string unit, default_value;
};

/// Returns the parameters of a material that have a unit, by name.
std::map<std::string, Dimensional> dimensional_parameters() {
  dealii::ParameterHandler prm;
  Material::declare(prm);
  std::stringstream text;
  prm.print_parameters(text, dealii::ParameterHandler::JSON);
  std::map<std::string, Dimensional> found;
  const nlohmann::json declared = nlohmann::json::parse(text);
  for (const auto &[name, entry] : declared.items()) {
    const std::string meaning = entry.value("documentation", "");
    const auto begin = meaning.rfind('[');
    if (begin != std::string::npos && !meaning.empty() && meaning.back() == ']')
      found[name] = {meaning.substr(begin + 1, meaning.size() - begin - 2), entry.value("default_value", "")};
  }
  return found;
}

/// Returns the factor of numbers with this unit. Throws std::invalid_argument if it is unknown.
double factor_of(const std::string &unit) {
  static const std::map<std::string, double> known = {{"length", length_factor}, {"mass", mass},
                                                      {"time", duration},        {"temperature", temperature},
                                                      {"stress", stress},        {"energy", energy}};
  if (unit == "-")
    return 1.;
  static const std::regex name("[A-Za-z_]+");
  for (auto word = std::sregex_iterator(unit.begin(), unit.end(), name); word != std::sregex_iterator();
       ++word)
    if (known.count(word->str()) == 0)
      throw std::invalid_argument("has the unit [" + unit + "]");
  dealii::FunctionParser<1> factor(1);
  factor.initialize("unused", unit, known);
  return factor.value(dealii::Point<1>());
}

/// Returns a list of numbers "a, b", or a table "a : b, c : d" with units for each column, in other
/// units. Throws std::invalid_argument.
std::string turned(const std::string &value, const std::string &unit) {
  std::vector<double> factors;
  for (const std::string &column : dealii::Utilities::split_string_list(unit, ':'))
    factors.push_back(factor_of(column));
  std::ostringstream text;
  text.precision(17);
  bool is_first = true;
  for (const std::string &row : dealii::Utilities::split_string_list(value, ',')) {
    const auto cells = dealii::Utilities::split_string_list(row, ':');
    if (cells.size() != factors.size())
      throw std::invalid_argument("is no list of numbers");
    text << (is_first ? "" : ", ");
    is_first = false;
    for (std::size_t c = 0; c < cells.size(); ++c)
      text << (c == 0 ? "" : " : ") << factors[c] * parse_number(cells[c]);
  }
  return text.str();
}

/// Whether a parameter names a file of numbers.
bool is_file(const std::string &name) {
  const std::string ending = " file";
  return name.size() > ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

/// Whether the material of a scene takes a parameter, which it refuses if its law does not use it.
bool takes(const SceneReader &read, const SceneFile::Setting &setting) {
  try {
    read({setting});
    return true;
  } catch (const InputError &) {
    return false;
  }
}

} // namespace

std::vector<OtherUnits> in_other_units(const Scene &scene, const std::vector<SceneFile::Entry> &entries,
                                       const SceneReader &read) {
  const auto dimensional = dimensional_parameters();
  std::vector<OtherUnits> result;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const SceneFile::Path path = {"Bodies", scene.bodies[b].name, "Material"};
    std::map<std::string, std::string> given;
    for (const SceneFile::Entry &entry : entries)
      if (entry.path == path)
        given[entry.key] = entry.value;
    Settings settings;
    OtherUnits other;
    for (const auto &[name, value] : given)
      if (is_file(name) && !value.empty())
        other.why_not = "'" + name + "' has numbers in a file";
    other.stress = stress;
    other.time = duration;
    other.temperature = temperature;
    for (const auto &[name, parameter] : dimensional) {
      const auto written = given.find(name);
      SceneFile::Setting setting{"Bodies/" + path[1] + "/Material/" + name,
                                 written != given.end() ? written->second : parameter.default_value,
                                 "other units"};
      try {
        const bool is_default = written == given.end();
        if (setting.value.empty() || (is_default && (setting.value == "0" || !takes(read, setting))))
          continue;
        setting.value = name == "Temperature" ? "(" + setting.value + ")*" + std::to_string(temperature)
                                              : turned(setting.value, parameter.unit);
        settings.push_back(setting);
      } catch (const std::invalid_argument &error) {
        other.why_not = "'" + name + "' " + error.what();
      }
    }
    if (other.why_not.empty())
      other.law = read(settings).bodies.at(b).material.law;
    result.push_back(std::move(other));
  }
  return result;
}

} // namespace billet::parameters
