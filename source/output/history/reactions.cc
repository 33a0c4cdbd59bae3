// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_quantity.h"

namespace billet {

HistoryQuantity support_reactions_quantity();
HistoryQuantity tool_pair_loads_quantity();
HistoryQuantity penetration_between_nodes_quantity();
HistoryQuantity force_balance_quantity();
HistoryQuantity inertia_quantity();
HistoryQuantity auxiliary_forces_quantity();

namespace {

constexpr std::array<const char *, 6> resultant_names = {"force_x",  "force_y",  "force_z",
                                                         "moment_x", "moment_y", "moment_z"};

} // namespace

HistoryQuantity support_reactions_quantity() {
  return {"reactions of supports",
          {{"BODY.support NAME.force_x, BODY.support NAME.force_y, BODY.support NAME.force_z",
            "Force of a support on its body. After its end, the force that fades. [force]"},
           {"BODY.support NAME.moment_x, BODY.support NAME.moment_y, BODY.support NAME.moment_z",
            "Its moment about the origin. [force length]"},
           {"BODY.symmetry plane NAME.force_x, BODY.symmetry plane NAME.force_y, BODY.symmetry plane "
            "NAME.force_z",
            "Force of a symmetry plane on its body. [force]"},
           {"BODY.symmetry plane NAME.moment_x, BODY.symmetry plane NAME.moment_y, BODY.symmetry plane "
            "NAME.moment_z",
            "Its moment about the origin. [force length]"}},
          [](const Scene &scene) {
            std::vector<std::string> columns;
            for (const NamedSupport &support : named_supports(scene))
              for (const char *quantity : resultant_names)
                columns.push_back(column_name(scene.bodies()[support.body].name + "." + support.name) + "." +
                                  quantity);
            return columns;
          },
          [](const HistorySample &sample) {
            std::vector<double> values;
            for (const Resultant &reaction : sample.reactions.of_supports) {
              add_vector(reaction.force, values);
              add_vector(reaction.moment, values);
            }
            return values;
          }};
}

HistoryQuantity tool_pair_loads_quantity() {
  return {"loads of pairs with tools",
          {{"pair PAIR.force_x, pair PAIR.force_y, pair PAIR.force_z",
            "Force of the tool on the body through this pair. [force]"},
           {"pair PAIR.moment_x, pair PAIR.moment_y, pair PAIR.moment_z",
            "Its moment about the origin. [force length]"},
           {"pair PAIR.contact_area", "Area in contact. [length^2]"},
           {"pair PAIR.deepest_penetration", "Maximum penetration. [length]"}},
          [](const Scene &scene) {
            std::vector<std::string> columns;
            for (const ContactPair &pair : scene.pairs()) {
              const std::string name = "pair " + column_name(pair.name) + ".";
              for (const char *quantity : resultant_names)
                columns.push_back(name + quantity);
              for (const char *quantity : {"contact_area", "deepest_penetration"})
                columns.push_back(name + quantity);
            }
            return columns;
          },
          [](const HistorySample &sample) {
            std::vector<double> values;
            for (const ContactLoad &load : sample.reactions.of_tool_pairs) {
              add_vector(load.force, values);
              add_vector(load.moment, values);
              values.push_back(load.area);
              values.push_back(load.deepest);
            }
            return values;
          }};
}

HistoryQuantity penetration_between_nodes_quantity() {
  return {"penetration between nodes",
          {{"pair NAME.penetration_between_nodes",
            "Largest depth of the tool in facets between their nodes, beyond that of the nodes. [length]"}},
          [](const Scene &scene) {
            std::vector<std::string> columns;
            for (const ContactPair &pair : scene.pairs())
              columns.push_back("pair " + column_name(pair.name) + ".penetration_between_nodes");
            return columns;
          },
          [](const HistorySample &sample) {
            std::vector<double> values;
            for (const FacetPenetration &penetration : sample.reactions.between_nodes)
              values.push_back(penetration.length);
            return values;
          }};
}

HistoryQuantity force_balance_quantity() {
  return {"balance of forces",
          {{"free_residual_x, free_residual_y, free_residual_z",
            "Sum of the forces that are out of balance at unconstrained nodes. [force]"},
           {"force_balance_defect", "Sum of reactions, contact forces, loads and inertia less the free "
                                    "residual, over the nodal forces: round-off."}},
          [](const Scene &) -> std::vector<std::string> {
            return {"free_residual_x", "free_residual_y", "free_residual_z", "force_balance_defect"};
          },
          [](const HistorySample &sample) -> std::vector<double> {
            const ForceBalance &balance = sample.reactions.balance;
            return {balance.free[0], balance.free[1], balance.free[2], balance.defect()};
          }};
}

HistoryQuantity inertia_quantity() {
  return {"force of inertia",
          {{"inertia_x, inertia_y, inertia_z",
            "Dynamic scenes: force of inertia of all bodies, the negative rate of their momentum. With the "
            "forces of tools, supports, symmetry planes and loads, its sum is the free residual. [force]"}},
          [](const Scene &scene) -> std::vector<std::string> {
            if (!scene.parameters().scheme().has_inertia)
              return {};
            return {"inertia_x", "inertia_y", "inertia_z"};
          },
          [](const HistorySample &sample) {
            std::vector<double> values;
            add_vector(sample.reactions.balance.inertia, values);
            return values;
          }};
}

HistoryQuantity auxiliary_forces_quantity() {
  return {
      "auxiliary forces",
      {{"auxiliary_force_x, auxiliary_force_y, auxiliary_force_z",
        "Static scenes: force of contact stabilisation, and of the imbalance that fades after a restart or "
        "a refinement. [force]"}},
      [](const Scene &scene) -> std::vector<std::string> {
        if (scene.parameters().scheme().has_inertia)
          return {};
        return {"auxiliary_force_x", "auxiliary_force_y", "auxiliary_force_z"};
      },
      [](const HistorySample &sample) {
        std::vector<double> values;
        dealii::Tensor<1, 3> force = sample.reactions.balance.loads;
        for (const LoadResult &load : sample.reactions.of_loads)
          force -= load.force;
        add_vector(force, values);
        return values;
      }};
}

} // namespace billet
