// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/contact_fields.h"
#include "billet/output/field_quantity.h"

#include <algorithm>

namespace billet {

NodalQuantity contact_quantity();

namespace {

/// Returns for each pair whether its nodes have total forces. Collective.
std::vector<int> find_two_passes(const std::vector<std::vector<ContactNodeReport>> &reports,
                                 const MPI_Comm communicator) {
  std::vector<int> flags;
  for (const auto &pair : reports)
    flags.push_back(
        std::any_of(pair.begin(), pair.end(), [](const ContactNodeReport &node) { return node.total; }));
  std::vector<int> all(flags.size());
  dealii::Utilities::MPI::max(flags, communicator, all);
  return all;
}

/// Replaces pressures and tractions of a pair, which are those of one pass, by all forces over the
/// area. Collective.
void take_total_forces(const Discretization &discretization, std::vector<ContactNodeReport> &reports) {
  Vector forces = discretization.make_additive_vector(), sums = discretization.make_additive_vector();
  for (const auto &node : reports)
    if (node.total) {
      for (unsigned int i = 0; i < 3; ++i)
        forces.add(1, &node.dofs[i], &node.total->force[i]);
      sums.add(1, &node.dofs[0], &node.total->of_pressures);
      sums.add(1, &node.dofs[1], &node.total->area);
    }
  std::array<Vector, 2> owned;
  for (unsigned int k = 0; k < 2; ++k) {
    Vector &shared = k == 0 ? forces : sums;
    shared.compress(dealii::VectorOperation::add);
    owned[k] = discretization.make_owned_vector();
    owned[k] = shared;
  }
  for (auto &node : reports) {
    if (!node.total || !discretization.owned_dofs().is_element(node.dofs[0]))
      continue;
    SurfaceForce all;
    for (unsigned int i = 0; i < 3; ++i)
      all.force[i] = owned[0](node.dofs[i]);
    all.of_pressures = owned[1](node.dofs[0]);
    all.area = owned[1](node.dofs[1]);
    node.pressure = all.pressure();
    node.traction = all.traction();
  }
}

} // namespace

std::array<Vector, 3> collect_contact_fields(const Discretization &discretization, const Solution &solution) {
  std::array<Vector, 3> owned;
  for (auto &vector : owned)
    vector = discretization.make_owned_vector();
  Vector area_sums = discretization.make_additive_vector();
  // The dofs of a node are consecutive and have one owner.
  for (const auto i : discretization.owned_dofs())
    if ((i - *discretization.owned_dofs().begin()) % 3 != 1)
      owned[1](i) = -1.;
  auto reports = solution.report_contacts();
  const std::vector<int> have_two_passes = find_two_passes(reports, discretization.communicator());
  for (std::size_t p = 0; p < reports.size(); ++p)
    if (have_two_passes[p])
      take_total_forces(discretization, reports[p]);
  for (std::size_t p = 0; p < reports.size(); ++p)
    for (const auto &node : reports[p]) {
      area_sums.add(1, &node.dofs[1], &node.area);
      if (!discretization.owned_dofs().is_element(node.dofs[0]))
        continue;
      // If several pairs share a node, the one with the smallest gap is shown.
      const bool is_shown = owned[1](node.dofs[0]) >= 0.;
      if (is_shown && owned[0](node.dofs[1]) <= node.gap)
        continue;
      owned[0](node.dofs[0]) = node.pressure;
      owned[0](node.dofs[1]) = node.gap;
      owned[0](node.dofs[2]) = node.slip;
      owned[1](node.dofs[0]) = static_cast<double>(node.status);
      owned[1](node.dofs[2]) = static_cast<double>(p);
      for (unsigned int i = 0; i < 3; ++i)
        owned[2](node.dofs[i]) = node.traction[i];
    }
  area_sums.compress(dealii::VectorOperation::add);
  Vector area_owned = discretization.make_owned_vector();
  area_owned = area_sums;
  std::array<Vector, 3> ghosted;
  for (unsigned int k = 0; k < 3; ++k) {
    owned[k].compress(dealii::VectorOperation::insert);
    if (k == 1)
      owned[k] += area_owned;
    ghosted[k] = discretization.make_ghosted_vector();
    ghosted[k] = owned[k];
  }
  return ghosted;
}

NodalQuantity contact_quantity() {
  return {"contact", "",
          [](const Scene &scene, const Discretization &discretization,
             const Solution &solution) -> std::vector<NodalField> {
            if (!scene.parameters().output.contact || !scene.capabilities().contact)
              return {};
            const auto [pressures, states, tractions] = collect_contact_fields(discretization, solution);
            return {{{"contact_pressure", "contact_gap", "contact_slip"}, false, pressures},
                    {{"contact_status", "contact_area", "contact_pair"}, false, states},
                    {{"contact_traction", "contact_traction", "contact_traction"}, true, tractions}};
          }};
}

} // namespace billet
