// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_quantity.h"

namespace billet {

HistoryQuantity whole_section_quantity();

HistoryQuantity whole_section_quantity() {
  return {"forces in the whole of a section",
          {{"NAME.force_per_width_x, NAME.force_per_width_y, NAME.force_per_width_z",
            "Plane strain: force of a tool, pair, support or load per unit of width. [force/length]"},
           {"NAME.full_circle_force_x, NAME.full_circle_force_y, NAME.full_circle_force_z",
            "Axisymmetric sections: its force over the full circle. [force]"}},
          [](const Scene &scene) {
            std::vector<std::string> columns;
            const WholeSection::Kind kind = scene.whole_section().kind;
            if (kind == WholeSection::Kind::model)
              return columns;
            std::vector<std::string> names;
            for (const auto &tool : scene.tools())
              names.push_back(column_name(tool.name()));
            for (const auto &pair : scene.body_pairs())
              names.push_back(column_name(pair.name));
            for (const NamedSupport &support : named_supports(scene))
              names.push_back(column_name(scene.bodies()[support.body].name + "." + support.name));
            for (const std::string &name : named_loads(scene))
              names.push_back(column_name(name));
            for (const std::string &name : names)
              for (const char component : {'x', 'y', 'z'})
                columns.push_back(
                    name +
                    (kind == WholeSection::Kind::per_width ? ".force_per_width_" : ".full_circle_force_") +
                    component);
            return columns;
          },
          [](const HistorySample &sample) {
            std::vector<double> values;
            if (sample.whole.kind == WholeSection::Kind::model)
              return values;
            const auto add = [&](const dealii::Tensor<1, 3> &force) {
              const dealii::Tensor<1, 3> whole = sample.whole.of(force);
              values.insert(values.end(), whole.begin_raw(), whole.end_raw());
            };
            for (const auto *loads : {&sample.state.tool_loads, &sample.state.body_pair_loads})
              for (const ContactLoad &load : *loads)
                add(load.force);
            for (const Resultant &reaction : sample.reactions.of_supports)
              add(reaction.force);
            for (const LoadResult &load : sample.reactions.of_loads)
              add(load.force);
            return values;
          }};
}

} // namespace billet
