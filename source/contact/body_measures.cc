// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/body_measures.h"

#include "billet/contact/body_surfaces.h"
#include "billet/contact/facet_contact.h"

namespace billet {

using dealii::Tensor;

Penetration BodyMeasures::penetration() const { return contact_.measures().penetration(); }
double BodyMeasures::excessive_penetration() const { return contact_.measures().excessive_penetration(); }
double BodyMeasures::closing_of_new_contacts() const { return contact_.measures().closing_of_new_contacts(); }
double BodyMeasures::max_sliding(const double expected) const {
  return contact_.measures().max_sliding(expected);
}
FrictionUse BodyMeasures::friction_use() const { return contact_.measures().friction_use(); }
std::vector<SlaveForce> BodyMeasures::slave_forces() const { return contact_.measures().slave_forces(); }
std::size_t BodyMeasures::history_size() const { return contact_.history_size(); }

StepWorks BodyMeasures::compute_step_works(const double weight) const {
  return contact_.works().compute_step_works(weight);
}

ContactLoad BodyMeasures::compute_load() const {
  const FacetContactLoad all = contact_.works().compute_load();
  ContactLoad load;
  load.force = all.force;
  load.moment = all.moment;
  load.area = has_two_passes() ? 0.5 * all.area : all.area; // both passes count it
  load.stored_energy = all.stored_energy;
  load.dissipation = all.dissipation;
  load.damping = all.damping;
  load.deepest = all.deepest;
  return load;
}

void BodyMeasures::add_resistances(const std::size_t body, std::vector<Resistance> &resistances) const {
  if (pair_.bodies[0] == pair_.bodies[1])
    return;
  contact_.measures().visit_touching([&](const Tensor<1, 3> &position, const Tensor<1, 3> &normal,
                                         const unsigned int of_node, const unsigned int of_facet) {
    for (const unsigned int side : {of_node, of_facet})
      if (pair_.bodies[side] == body)
        add_contact(position, side == of_node ? normal : -normal, false, pair_.has_friction(), resistances);
  });
}

void BodyMeasures::visit_supporting(const VisitSupporting &visit) const {
  if (pair_.bodies[0] == pair_.bodies[1])
    return;
  contact_.measures().visit_supporting(
      [&](const SupportingPoint &point, const unsigned int of, const unsigned int on) {
        visit(point, pair_.bodies[of], pair_.bodies[on]);
      });
}

std::vector<ContactNodeReport> BodyMeasures::report() const {
  std::vector<ContactNodeReport> reports;
  const auto states = contact_.measures().report();
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double area = nodes_.is_owned(surfaces_.local_nodes[i]) ? states[i].area : 0.;
    reports.push_back({nodes_.dofs(surfaces_.local_nodes[i]), states[i].status, states[i].pressure,
                       states[i].gap, states[i].slip, area, states[i].traction, states[i].penetration,
                       surfaces_.sizes[i], states[i].tangential_stiffness});
    if (has_two_passes())
      reports.back().total = states[i].total;
  }
  return reports;
}

} // namespace billet
