// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/tool_matrix_contact.h"

#include "billet/contact/tool_paths.h"
#include "billet/contact/tool_springs.h"

#include <vector>

namespace billet {

ToolMatrixContact::ToolMatrixContact(RigidContactParts &parts, const ContactTangent tangent) : parts_(parts) {
  set_tangent(tangent);
}

void ToolMatrixContact::set_tangent(const ContactTangent tangent) {
  evaluation_ = make_tool_evaluation(parts_, tangent);
  tangents_ = make_tool_tangents(parts_, tangent);
}

void ToolMatrixContact::update(const Vector &displacements) {
  evaluation_->run(displacements);
  parts_.count_changes();
}

void ToolMatrixContact::add_forces(Vector &residual) const {
  visit_areas(parts_, [&](const unsigned int i, const double area) {
    parts_.slaves.add_to_dofs(i, -area * parts_.states[i].traction, residual);
  });
}

double ToolMatrixContact::find_free_part(const ContactPath &path) const {
  return find_free_part_of_nodes(parts_, path);
}

void ToolMatrixContact::begin(const ContactStep &step, const Vector &displacements) {
  std::vector<dealii::Tensor<1, 3>> of_nodes;
  for (std::size_t i = 0; i < parts_.slaves.n_mesh_nodes; ++i)
    of_nodes.push_back(parts_.slaves.nodes[i].displacement_in(displacements));
  parts_.begin(step, of_nodes);
}

} // namespace billet
