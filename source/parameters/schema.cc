// SPDX-License-Identifier: LGPL-2.1-or-later
// JSON Schema of scenes, from the same declarations as the descriptions of parameters.
#include "billet/parameters/declaration.h"
#include "billet/parameters/scene.h"

#include <deal.II/base/parameter_handler.h>

#include <nlohmann/json.hpp>

#include <ostream>
#include <regex>
#include <sstream>

namespace billet::parameters {

namespace {

using Json = nlohmann::ordered_json;

/// Adds the type and range of a ParameterHandler pattern, such as "[Double 0...MAX_DOUBLE
/// (inclusive)]".
void add_type(const std::string &pattern, Json &schema) {
  std::smatch match;
  static const std::regex selection(R"(^\[Selection (.*) \]$)"),
      range(R"(^\[(Double|Integer)(?: range)? ([-+.\deE]+|-?MAX_DOUBLE)\.\.\.([-+.\deE]+|MAX_DOUBLE))");
  if (std::regex_search(pattern, match, selection)) {
    schema["type"] = "string";
    std::istringstream names(match[1].str());
    for (std::string name; std::getline(names, name, '|');)
      schema["enum"].push_back(name);
  } else if (pattern.rfind("[Bool", 0) == 0)
    schema["type"] = "boolean";
  else if (pattern.rfind("[Double", 0) == 0 || pattern.rfind("[Integer", 0) == 0) {
    schema["type"] = pattern[1] == 'D' ? "number" : "integer";
    if (std::regex_search(pattern, match, range))
      for (const unsigned int end : {2U, 3U})
        if (match[end].str().find("MAX") == std::string::npos)
          schema[end == 2 ? "minimum" : "maximum"] = std::stod(match[end].str());
  } else
    schema["type"] = "string";
}

/// Returns the default as a JSON value of the schema's type.
Json typed(const std::string &value, const Json &schema) {
  const std::string type = schema["type"];
  if (type == "boolean")
    return value == "true";
  if (type == "string")
    return value;
  std::size_t end = 0;
  try {
    const double number = std::stod(value, &end);
    if (end == value.size())
      return type == "integer" ? Json(static_cast<long long>(number)) : Json(number);
  } catch (const std::exception &) { // infinite, or not a number
  }
  return value;
}

Json schema_of(const Json &declared) {
  Json schema;
  if (declared.contains("default_value") && declared["default_value"].is_string()) {
    add_type(declared["pattern_description"], schema);
    schema["default"] = typed(declared["default_value"], schema);
    schema["description"] = declared["documentation"];
    return schema;
  }
  schema["type"] = "object";
  schema["properties"] = Json::object();
  schema["additionalProperties"] = false;
  Json of_shapes = Json::array();
  for (const auto &[name, entry] : declared.items()) {
    if (name.rfind(name_of_surface, 0) == 0)
      of_shapes.push_back(schema_of(entry));
    else if (name.rfind("(name of ", 0) == 0) // a name of the user's choice
      schema["additionalProperties"] = schema_of(entry);
    else
      schema["properties"][name] = schema_of(entry);
  }
  if (!of_shapes.empty())
    schema["additionalProperties"] = {{"anyOf", of_shapes}};
  return schema;
}

} // namespace

void print_schema(std::ostream &stream) {
  dealii::ParameterHandler prm;
  declare_every_parameter(prm);
  std::stringstream text;
  prm.print_parameters(text, dealii::ParameterHandler::JSON | dealii::ParameterHandler::KeepDeclarationOrder);
  Json schema;
  schema["$schema"] = "http://json-schema.org/draft-07/schema#";
  schema["title"] = "A scene of billet";
  schema.update(schema_of(Json::parse(text)));
  stream << schema.dump(1) << "\n";
}

} // namespace billet::parameters
