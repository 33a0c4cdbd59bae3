// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene_fault.h"

#include "billet/diagnostic_kinds.h"

#include <nlohmann/json.hpp>

#include <utility>

namespace billet {

Diagnostic with_fault(Diagnostic error, const SceneFault &fault) {
  const nlohmann::json data = {{"kind", static_cast<int>(fault.kind)},
                               {"suggestion", fault.suggestion},
                               {"depends on", fault.depends_on}};
  const auto bytes = nlohmann::json::to_cbor(data); // which holds any bytes of a name
  return error.data({bytes.begin(), bytes.end()});
}

Diagnostic scene_error(const std::string &text, const SceneFault &fault) {
  return with_fault(Diagnostic(diagnostic::bad_input, text), fault);
}

SceneFault fault_of(const Diagnostic &error) {
  const std::string &bytes = error.data();
  if (bytes.empty())
    return {};
  const nlohmann::json data = nlohmann::json::from_cbor(bytes.begin(), bytes.end());
  return {static_cast<SceneFault::Kind>(data.at("kind").get<int>()), data.at("suggestion").get<std::string>(),
          data.at("depends on").get<std::vector<std::string>>()};
}

} // namespace billet
