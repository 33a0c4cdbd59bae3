// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_quantity.h"

#include <algorithm>
#include <stdexcept>

namespace billet {

HistoryQuantity step_quantity();
HistoryQuantity solver_quantity();
HistoryQuantity tool_loads_quantity();
HistoryQuantity body_pair_loads_quantity();
std::vector<HistoryQuantity> energy_quantities();
HistoryQuantity momenta_quantity();
HistoryQuantity support_reactions_quantity();
HistoryQuantity tool_pair_loads_quantity();
HistoryQuantity penetration_between_nodes_quantity();
HistoryQuantity force_balance_quantity();
HistoryQuantity energy_ratio_quantity();
HistoryQuantity probes_quantity();
HistoryQuantity whole_section_quantity();
HistoryQuantity mesh_error_quantity();
HistoryQuantity loads_quantity();
HistoryQuantity inertia_quantity();
HistoryQuantity auxiliary_forces_quantity();

HistoryQuantities::HistoryQuantities(const std::vector<HistoryQuantity> &quantities) {
  for (const HistoryQuantity &quantity : quantities)
    add(quantity);
}

void HistoryQuantities::add(const HistoryQuantity &quantity) {
  for (const HistoryQuantity &other : quantities_)
    if (other.name == quantity.name)
      throw std::logic_error("the quantity '" + quantity.name + "' of the history is registered twice");
  if (quantity.meanings.empty())
    throw std::logic_error("the quantity '" + quantity.name + "' of the history has no meaning");
  quantities_.push_back(quantity);
}

HistoryQuantities &history_quantities() {
  static HistoryQuantities quantities = [] {
    HistoryQuantities all(
        {step_quantity(), solver_quantity(), tool_loads_quantity(), body_pair_loads_quantity()});
    for (const HistoryQuantity &energy : energy_quantities())
      all.add(energy);
    all.add(momenta_quantity());
    // Programs that read a history rely on its columns: later ones stand behind those above.
    all.add(support_reactions_quantity());
    all.add(tool_pair_loads_quantity());
    all.add(force_balance_quantity());
    all.add(energy_ratio_quantity());
    all.add(probes_quantity());
    all.add(whole_section_quantity());
    all.add(mesh_error_quantity());
    all.add(penetration_between_nodes_quantity());
    all.add(loads_quantity());
    all.add(inertia_quantity());
    all.add(auxiliary_forces_quantity());
    return all;
  }();
  return quantities;
}

std::string column_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](const char c) { return c == ',' || c == '"'; }, '_');
  return name;
}

void add_vector(const dealii::Tensor<1, 3> &vector, std::vector<double> &values) {
  for (unsigned int c = 0; c < 3; ++c)
    values.push_back(vector[c]);
}

} // namespace billet
