// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_quantity.h"

namespace billet {

HistoryQuantity tool_loads_quantity();
HistoryQuantity body_pair_loads_quantity();

namespace {

/// Names of the values of add_load().
constexpr std::array<const char *, 8> load_names = {
    "force_x",  "force_y",  "force_z",      "moment_x",
    "moment_y", "moment_z", "contact_area", "deepest_penetration"};

void add_load(const ContactLoad &load, std::vector<double> &values) {
  add_vector(load.force, values);
  add_vector(load.moment, values);
  values.push_back(load.area);
  values.push_back(load.deepest);
}

} // namespace

HistoryQuantity tool_loads_quantity() {
  return {
      "loads and places of tools",
      {{"TOOL.force_x, TOOL.force_y, TOOL.force_z",
        "Force of the tool on the bodies, over all of its pairs. [force]"},
       {"TOOL.moment_x, TOOL.moment_y, TOOL.moment_z",
        "Its moment about the centre of the tool's motion, which moves with it. [force length]"},
       {"TOOL.contact_area", "Area in contact. [length^2]"},
       {"TOOL.deepest_penetration", "Maximum penetration of nodes into the tool. [length]"},
       {"TOOL.travel_x, TOOL.travel_y, TOOL.travel_z", "Translation of the tool since the start. [length]"},
       {"TOOL.turn", "Rotation of the tool since the start. [rad]"}},
      [](const Scene &scene) {
        std::vector<std::string> columns;
        for (const auto &tool : scene.tools()) {
          const std::string name = column_name(tool.name()) + ".";
          for (const char *quantity : load_names)
            columns.push_back(name + quantity);
          for (const char *quantity : {"travel_x", "travel_y", "travel_z", "turn"})
            columns.push_back(name + quantity);
        }
        return columns;
      },
      [](const HistorySample &sample) {
        std::vector<double> values;
        for (std::size_t i = 0; i < sample.state.tool_loads.size(); ++i) {
          add_load(sample.state.tool_loads[i], values);
          add_vector(sample.state.placements[i].translation, values);
          values.push_back(sample.state.placements[i].rotation_angle);
        }
        return values;
      }};
}

HistoryQuantity body_pair_loads_quantity() {
  return {
      "loads between bodies",
      {{"PAIR.force_x, PAIR.force_y, PAIR.force_z", "Force of the pair on its first body, 'Body'. [force]"},
       {"PAIR.moment_x, PAIR.moment_y, PAIR.moment_z", "Its moment about the origin. [force length]"},
       {"PAIR.contact_area", "Area in contact. [length^2]"},
       {"PAIR.deepest_penetration", "Maximum penetration. [length]"}},
      [](const Scene &scene) {
        std::vector<std::string> columns;
        for (const auto &pair : scene.body_pairs())
          for (const char *quantity : load_names)
            columns.push_back(column_name(pair.name) + "." + quantity);
        return columns;
      },
      [](const HistorySample &sample) {
        std::vector<double> values;
        for (const ContactLoad &load : sample.state.body_pair_loads)
          add_load(load, values);
        return values;
      }};
}

} // namespace billet
