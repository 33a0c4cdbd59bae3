// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/rigid_contact.h"

#include "billet/contact/tool_checkpoint.h"
#include "billet/contact/tool_paths.h"

#include <vector>

namespace billet {

using dealii::Tensor;

RigidContact::RigidContact(const Scene &scene, const std::size_t pair, const Discretization &discretization,
                           const ContactTangent tangent)
    : ContactInterface(scene, scene.pairs()[pair]), parts_(scene, scene.pairs()[pair], discretization),
      penalties_(parts_), measures_(parts_), checks_(parts_), drive_(parts_), bounds_(parts_),
      forces_(parts_) {
  set_tangent(tangent);
}

void RigidContact::start_step(const ContactStep &step) {
  parts_.step.placement_n = step.tools_at_start[tool()];
  parts_.step.placement = step.tools_at_end[tool()];
  parts_.step.duration = step.duration;
  parts_.step.allowed_part = parts_.pair.overlap.allowed_part(step.end);
}

void RigidContact::set_friction_account(const double start_weight, const bool is_static) {
  if (parts_.friction)
    parts_.friction->set_account(start_weight, is_static);
}

void RigidContact::link_neighbours(std::deque<RigidContact> &contacts) {
  for (auto &contact : contacts)
    for (const auto &other : contacts)
      if (&other != &contact && other.body() == contact.body())
        contact.parts_.neighbours.add(other.parts_.step);
}

void RigidContact::set_tangent(const ContactTangent tangent) {
  evaluation_ = make_tool_evaluation(parts_, tangent);
  tangents_ = make_tool_tangents(parts_, tangent);
}

void RigidContact::add_forces(Vector &residual) const {
  visit_areas(parts_, [&](const unsigned int i, const double area) {
    parts_.slaves.add_to_dofs(i, -area * parts_.states[i].traction, residual);
  });
}

double RigidContact::find_free_part(const ContactPath &path) const {
  return find_free_part_of_nodes(parts_, path);
}

void RigidContact::bind(const LocalNodes &nodes) {
  BoundNodes &bound = parts_.bound;
  bound.local.clear();
  bound.is_owned.clear();
  for (std::size_t i = 0; i < parts_.slaves.n_mesh_nodes; ++i) {
    bound.local.push_back(nodes.find(parts_.slaves.nodes[i].dofs[0]));
    bound.is_owned.push_back(nodes.is_owned(bound.local.back()));
  }
  bound.is_owned.resize(parts_.slaves.nodes.size(), true);
}

void RigidContact::save(StateWriter &writer, const NodeKeys &keys) const {
  save_tool_contact(parts_, penalties_, writer, keys);
}

void RigidContact::load(const StateReader &reader, const NodeKeys &keys) {
  load_tool_contact(reader, keys, parts_, penalties_);
}

template <class DisplacementOf>
void RigidContact::begin_at(const ContactStep &step, const DisplacementOf &displacement_of) {
  std::vector<Tensor<1, 3>> displacements;
  for (std::size_t i = 0; i < parts_.slaves.n_mesh_nodes; ++i)
    displacements.push_back(displacement_of(i));
  parts_.begin(step, displacements);
}

void RigidContact::begin(const ContactStep &step, const Vector &displacements) {
  begin_at(step, [&](const std::size_t i) { return parts_.slaves.nodes[i].displacement_in(displacements); });
}

void RigidContact::begin(const ContactStep &step, const NodalVectors &displacements) {
  begin_at(step, [&](const std::size_t i) { return parts_.bound.vector_of(i, displacements); });
}

} // namespace billet
