// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/rigid_contact.h"

#include "billet/contact/tool_checkpoint.h"

namespace billet {

RigidContact::RigidContact(const Scene &scene, const std::size_t pair, const Discretization &discretization)
    : ContactInterface(scene, scene.pairs()[pair]), parts_(scene, scene.pairs()[pair], discretization),
      penalties_(parts_), measures_(parts_), checks_(parts_), drive_(parts_) {}

RigidContact::RigidContact(const Scene &scene, const std::size_t pair, const Discretization &discretization,
                           const ContactTangent tangent)
    : RigidContact(scene, pair, discretization) {
  with_matrix_.emplace(parts_, tangent);
}

RigidContact::RigidContact(const Scene &scene, const std::size_t pair, const LocalNodes &nodes)
    : RigidContact(scene, pair, nodes.discretization()) {
  without_matrix_.emplace(parts_, nodes);
}

void RigidContact::start_step(const ContactStep &step) {
  parts_.step.placement_n = step.tools_at_start[tool()];
  parts_.step.placement = step.tools_at_end[tool()];
  parts_.step.duration = step.duration;
  parts_.step.allowed_part = parts_.allowed_part(step.end);
}

void RigidContact::set_friction_account(const double start_weight, const FrictionAccounting &accounting) {
  if (parts_.friction)
    parts_.friction->set_account(start_weight, accounting);
}

void RigidContact::link_neighbours(std::deque<RigidContact> &contacts) {
  for (auto &contact : contacts)
    for (const auto &other : contacts)
      if (&other != &contact && other.body() == contact.body())
        contact.parts_.neighbours.add(other.parts_.step);
}

void RigidContact::save(StateWriter &writer, const NodeKeys &keys) const {
  save_tool_contact(parts_, penalties_, writer, keys);
}

void RigidContact::load(const StateReader &reader, const NodeKeys &keys) {
  load_tool_contact(reader, keys, parts_, penalties_);
}

} // namespace billet
