// SPDX-License-Identifier: LGPL-2.1-or-later
// Bodies that viscous forces hold until contact does.
#include "billet/diagnostic_kinds.h"
#include "billet/mechanics/element_mass.h"
#include "billet/solve/quasi_static.h"

#include <deal.II/lac/full_matrix.h>

#include <Epetra_Vector.h>

#include <algorithm>
#include <sstream>

namespace billet {

namespace {

dealii::ArrayView<const double> view(const Vector &vector) {
  const Epetra_Vector &values = *vector.trilinos_vector()(0);
  return {values.Values(), static_cast<std::size_t>(values.MyLength())};
}

/// Σ ∫ N_a dV of the undeformed elements at their nodes, in each of the three directions. Collective.
Vector nodal_volumes(const Discretization &discretization, const std::size_t body) {
  Vector sum = discretization.make_additive_vector();
  for (const auto &element : discretization.elements(body)) {
    ReferenceElement reference{};
    compute_reference_element(nodal_positions(element.cell), reference);
    ElementMass volume = compute_element_mass(reference, 1.);
    lump(volume);
    ElementVectors volumes{};
    for (unsigned int i = 0; i < n_element_nodes; ++i)
      for (unsigned int c = 0; c < 3; ++c)
        volumes[3 * i + c] = volume[i * n_element_nodes + i];
    sum.add(n_element_dofs, element.dofs.data(), volumes.data());
  }
  sum.compress(dealii::VectorOperation::add);
  Vector result = discretization.make_owned_vector();
  result = sum;
  return result;
}

} // namespace

void QuasiStatic::prepare_stabilisation() {
  const std::size_t n_bodies = scene_.bodies().size();
  needs_no_stabilisation_.assign(n_bodies, false);
  for (std::size_t body = 0; body < n_bodies; ++body)
    needs_no_stabilisation_[body] = scene_.parameters().bodies[body].is_stabilised.value;
  if (motion_ || body_frames_.empty())
    return;
  const auto &owned = discretization_.owned_dofs();
  std::vector<ContactStabilisation::Node> nodes;
  std::vector<double> speeds(n_bodies, 0.);
  for (std::size_t body = 0; body < n_bodies; ++body) {
    RigidBodySupport support(discretization_.communicator(), {body_frames_[body]}, 0);
    for (const auto &node : supported_nodes_)
      if (node.body == body)
        support.add_support(0, node.position, node.normal);
    if (support.find().n_free == 0)
      continue;
    const double size = 2. * body_frames_[body].size, end = scene_.parameters().time_stepping.end_time;
    speeds[body] = size / end;
    const Vector volumes = nodal_volumes(discretization_, body);
    for (std::size_t first = 0; first < owned.n_elements(); first += 3)
      if (const DofIndex dof = owned.nth_index_in_set(first); volumes(dof) > 0.)
        nodes.push_back(
            {body, first,
             ContactStabilisation::damping(scene_.bodies()[body].young_modulus, size, end, volumes(dof))});
  }
  stabilisation_ =
      std::make_unique<ContactStabilisation>(discretization_.communicator(), speeds, std::move(nodes));
  for (std::size_t body = 0; body < n_bodies; ++body)
    if (speeds[body] > 0. && needs_no_stabilisation_[body]) {
      stabilisation_->hold(body);
      needs_no_stabilisation_[body] = false;
    }
}

void QuasiStatic::add_stabilisation(Vector &residual) {
  if (!stabilisation_ || !stabilisation_->acts())
    return;
  Epetra_Vector &values = *residual.trilinos_vector()(0);
  stabilisation_->add_forces(
      view(trial_), view(u_n_),
      dealii::ArrayView<double>(values.Values(), static_cast<std::size_t>(values.MyLength())));
  force_scale_ = std::max(force_scale_, stabilisation_->force_scale());
}

void QuasiStatic::add_stabilisation_tangent(const TangentSystem &system) const {
  if (!stabilisation_ || !stabilisation_->acts())
    return;
  const auto &owned = discretization_.owned_dofs();
  dealii::FullMatrix<double> matrix(3, 3);
  std::vector<DofIndex> dofs(3);
  for (const auto &node : stabilisation_->nodes()) {
    for (unsigned int i = 0; i < 3; ++i) {
      dofs[i] = owned.nth_index_in_set(node.first + i);
      matrix(i, i) = stabilisation_->stiffness(node);
    }
    system.add(matrix, dofs);
  }
}

void QuasiStatic::commit_stabilisation() {
  if (!stabilisation_)
    return;
  std::vector<bool> is_supported;
  for (std::size_t body = 0; body < scene_.bodies().size(); ++body)
    is_supported.push_back(stabilisation_->acts_on(body) && !support_by_contact_.is_free[body]);
  double driven_work = 0.;
  for (const std::size_t tool : unknown_tools_)
    driven_work += scene_.tools()[tool].load(time_) * last_offset_increments_[tool];
  state_.energies.viscous += stabilisation_->commit(view(trial_), view(u_n_), is_supported, driven_work);
}

void QuasiStatic::save_stabilisation(StateWriter &writer) const {
  if (!stabilisation_)
    return;
  Vector forces = discretization_.make_owned_vector();
  Epetra_Vector &values = *forces.trilinos_vector()(0);
  for (std::size_t k = 0; k < stabilisation_->nodes().size(); ++k)
    for (std::size_t i = 0; i < 3; ++i)
      values[static_cast<int>(stabilisation_->nodes()[k].first + i)] =
          stabilisation_->last_forces()[3 * k + i];
  writer.in("stabilisation", [&] {
    writer.write("bodies", stabilisation_->save());
    save_nodal(writer, "forces", OwnedNodes(discretization_, NodeKeys(discretization_)), forces);
  });
}

void QuasiStatic::load_stabilisation(StateReader &reader) {
  if (!stabilisation_ || !reader.has("stabilisation"))
    return;
  reader.in("stabilisation", [&] {
    stabilisation_->load(reader.read("bodies"));
    Vector forces = discretization_.make_owned_vector();
    load_nodal(reader, "forces", OwnedNodes(discretization_, NodeKeys(discretization_)), forces);
    std::vector<double> last;
    for (const auto &node : stabilisation_->nodes())
      for (std::size_t i = 0; i < 3; ++i)
        last.push_back(view(forces)[node.first + i]);
    stabilisation_->set_last_forces(std::move(last));
  });
}

DiagnosticList QuasiStatic::initial_diagnostics() const {
  DiagnosticList messages = RigidContact::check_small_tools(contacts_);
  for (std::size_t body = 0; body < needs_no_stabilisation_.size(); ++body)
    if (needs_no_stabilisation_[body])
      messages.push_back(Diagnostic(diagnostic::needless_stabilisation,
                                    "Supports and symmetry planes hold body '" + scene_.bodies()[body].name +
                                        "', which is stabilised until it is touched")
                             .body(scene_.bodies()[body].name));
  return messages;
}

DiagnosticList QuasiStatic::check_stabilisation() const {
  DiagnosticList messages;
  if (!stabilisation_)
    return messages;
  for (std::size_t body = 0; body < scene_.bodies().size(); ++body) {
    const std::string &name = scene_.bodies()[body].name;
    const double part = largest_energy_ > 0. ? stabilisation_->work_of_motion(body) / largest_energy_ : 0.;
    if (part > ContactStabilisation::max_part) {
      const double factor = part / ContactStabilisation::max_part;
      std::ostringstream text;
      text.precision(3);
      text << "The viscous forces that stabilise body '" << name << "' did " << 100. * part
           << " % of all work, " << factor << " times the allowed " << 100. * ContactStabilisation::max_part
           << " %";
      messages.push_back(Diagnostic(diagnostic::stabilisation_too_strong, text.str())
                             .body(name)
                             .time(state_.time)
                             .measure("factor", factor)
                             .value("part of all work", part));
    }
    if (!stabilisation_->acts_on(body) || body >= support_by_contact_.is_free.size() ||
        !support_by_contact_.is_free[body])
      continue;
    const std::string what = "Neither supports nor contact resist a rigid-body mode of body '" + name +
                             "' at the end" +
                             (support_by_contact_.free && support_by_contact_.free->body == body
                                  ? ", with " + print(support_by_contact_.free->motion)
                                  : "");
    const double forces = std::max(internal_forces_n_.l2_norm(), contact_forces_n_.l2_norm());
    const double force_part = forces > 0. ? stabilisation_->last_force(body) / forces : 0.;
    if (force_part > ContactStabilisation::max_part) {
      std::ostringstream text;
      text.precision(3);
      text << what << ": viscous forces bear " << 100. * force_part << " % of the forces there";
      messages.push_back(Diagnostic(diagnostic::stabilised_loads, text.str())
                             .body(name)
                             .time(state_.time)
                             .measure("part of the forces", force_part));
    } else
      messages.push_back(Diagnostic(diagnostic::stabilised_at_end, what + ": only viscous forces do")
                             .body(name)
                             .time(state_.time));
  }
  return messages;
}

} // namespace billet
