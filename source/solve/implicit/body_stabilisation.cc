// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/body_stabilisation.h"

#include "billet/diagnostic_kinds.h"
#include "billet/forces/selected_nodes.h"
#include "billet/mechanics/element_mass.h"
#include "billet/solve/restart.h"

#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

RigidBodies::RigidBodies(const Scene &scene, const Discretization &discretization,
                         const ConstraintFilter &acts, const LoadFilter &springs_act) {
  const std::size_t n_bodies = scene.bodies().size();
  const double far = 10. * discretization.radius();
  // Both are about the scene's centre; the high ones are negative.
  std::vector<double> low(3 * n_bodies, far), high(3 * n_bodies, far);
  for (std::size_t body = 0; body < n_bodies; ++body)
    for (const auto &element : discretization.elements(body))
      for (const unsigned int v : element.cell->vertex_indices())
        for (unsigned int i = 0; i < 3; ++i) {
          const double x = element.cell->vertex(v)[i] - discretization.centre()[i];
          low[3 * body + i] = std::min(low[3 * body + i], x);
          high[3 * body + i] = std::min(high[3 * body + i], -x);
        }
  dealii::Utilities::MPI::min(low, discretization.communicator(), low);
  dealii::Utilities::MPI::min(high, discretization.communicator(), high);
  for (std::size_t body = 0; body < n_bodies; ++body) {
    RigidBodySupport::Body frame{discretization.centre(), 0.};
    for (unsigned int i = 0; i < 3; ++i) {
      frame.centre[i] += 0.5 * (low[3 * body + i] - high[3 * body + i]);
      frame.size = std::max(frame.size, -0.5 * (low[3 * body + i] + high[3 * body + i]));
    }
    frames.push_back(frame);
  }
  RigidBodySupport support(discretization.communicator(), frames, 0);
  for (const auto &entry : collect_constrained_nodes(scene, discretization, acts))
    for (std::size_t body = 0; body < n_bodies; ++body)
      for (const auto &constraint : scene.bodies()[body].constraints)
        if (std::count(entry.second.constraints.begin(), entry.second.constraints.end(), &constraint) > 0) {
          const dealii::Tensor<1, 3> normal = constraint.direction(entry.second.position);
          supported_nodes.push_back({body, entry.second.position, normal, entry.second.dofs});
          support.add_support(body, entry.second.position, normal);
        }
  for (std::size_t body = 0; body < n_bodies; ++body)
    for (const AppliedLoad &load : scene.bodies()[body].loads) {
      if (!load.load.is_spring() || !springs_act(load.times))
        continue;
      for (const auto &[node, directions] : collect_springs(load, discretization, body))
        for (const auto &direction : directions) {
          supported_nodes.push_back({body, node.position, direction, node.dofs});
          support.add_support(body, node.position, direction);
        }
    }
  if (support.find().n_free > 0)
    return;
  frames.clear();
  supported_nodes.clear();
}

namespace {

/// Returns Σ ∫ N_a dV of the undeformed elements at their nodes, in each of the three directions.
/// Collective.
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

void BodyStabilisation::prepare(const RigidBodies &bodies) {
  const std::size_t n_bodies = scene_.bodies().size();
  is_needless_.assign(n_bodies, false);
  for (std::size_t body = 0; body < n_bodies; ++body)
    is_needless_[body] = scene_.parameters().bodies[body].is_stabilised.value;
  if (bodies.are_held())
    return;
  const auto &owned = discretization_.owned_dofs();
  std::vector<ContactStabilisation::Node> nodes;
  std::vector<double> speeds(n_bodies, 0.);
  sizes_.assign(n_bodies, 0.);
  for (std::size_t body = 0; body < n_bodies; ++body) {
    RigidBodySupport support(discretization_.communicator(), {bodies.frames[body]}, 0);
    for (const auto &node : bodies.supported_nodes)
      if (node.body == body)
        support.add_support(0, node.position, node.normal);
    if (support.find().n_free == 0)
      continue;
    const double size = 2. * bodies.frames[body].size, end = scene_.parameters().time_stepping.end_time;
    speeds[body] = size / end;
    sizes_[body] = size;
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
    if (speeds[body] > 0. && is_needless_[body]) {
      stabilisation_->hold(body);
      is_needless_[body] = false;
    }
}

void BodyStabilisation::start_step(const double duration) {
  if (stabilisation_)
    stabilisation_->start_step(duration);
}

double BodyStabilisation::add_forces(const StepState &step, Vector &residual) const {
  if (!acts())
    return 0.;
  stabilisation_->add_forces(owned_values(step.trial.displacements), owned_values(step.start.displacements),
                             owned_values(residual));
  return stabilisation_->force_scale();
}

void BodyStabilisation::add_tangent(const TangentSystem &system) const {
  if (!acts())
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

std::vector<ContactStabilisation::Motion> BodyStabilisation::motions(const StepState &step) const {
  Vector rest = step.trial.supports;
  rest -= step.trial.internal;
  rest -= step.trial.contact;
  return stabilisation_->motions(owned_values(step.trial.displacements),
                                 owned_values(step.start.displacements),
                                 owned_values(static_cast<const Vector &>(rest)));
}

std::vector<std::vector<dealii::Tensor<1, 3>>> BodyStabilisation::translations(const StepState &step) const {
  std::vector<dealii::Tensor<1, 3>> in_step;
  for (const auto &motion : motions(step))
    in_step.push_back(motion.mean);
  return {stabilisation_->drifts(), in_step};
}

double BodyStabilisation::commit(const StepState &step, const RigidBodySupport::Result &support_by_contact,
                                 const double driven_work) {
  if (!stabilisation_)
    return 0.;
  std::vector<bool> is_supported;
  for (std::size_t body = 0; body < scene_.bodies().size(); ++body)
    is_supported.push_back(stabilisation_->acts_on(body) && !support_by_contact.is_free[body]);
  if (acts() && support_by_contact.unresisted.size() == 2)
    stabilisation_->add_drifts(support_by_contact.unresisted[0], motions(step),
                               support_by_contact.unresisted[1]);
  return stabilisation_->commit(owned_values(step.trial.displacements),
                                owned_values(step.start.displacements), is_supported, driven_work);
}

void BodyStabilisation::save(StateWriter &writer) const {
  if (!stabilisation_)
    return;
  Vector forces = discretization_.make_owned_vector();
  const auto values = owned_values(forces);
  for (std::size_t k = 0; k < stabilisation_->nodes().size(); ++k)
    for (std::size_t i = 0; i < 3; ++i)
      values[stabilisation_->nodes()[k].first + i] = stabilisation_->last_forces()[3 * k + i];
  writer.in("stabilisation", [&] {
    writer.write("bodies", stabilisation_->save());
    std::vector<double> drifts;
    for (const dealii::Tensor<1, 3> &drift : stabilisation_->drifts())
      drifts.insert(drifts.end(), {drift[0], drift[1], drift[2]});
    writer.write("drifts", drifts);
    save_nodal(writer, "forces", OwnedNodes(discretization_, NodeKeys(discretization_)), forces);
  });
}

void BodyStabilisation::load(StateReader &reader) {
  if (!stabilisation_ || !reader.has("stabilisation"))
    return;
  reader.in("stabilisation", [&] {
    stabilisation_->load(reader.read("bodies"));
    if (reader.has("drifts")) {
      const std::vector<double> values = reader.read("drifts");
      std::vector<dealii::Tensor<1, 3>> drifts(stabilisation_->drifts().size());
      for (std::size_t body = 0; body < drifts.size() && values.size() == 3 * drifts.size(); ++body)
        drifts[body] = dealii::Tensor<1, 3>({values[3 * body], values[3 * body + 1], values[3 * body + 2]});
      stabilisation_->set_drifts(std::move(drifts));
    }
    Vector forces = discretization_.make_owned_vector();
    load_nodal(reader, "forces", OwnedNodes(discretization_, NodeKeys(discretization_)), forces);
    std::vector<double> last;
    for (const auto &node : stabilisation_->nodes())
      for (std::size_t i = 0; i < 3; ++i)
        last.push_back(owned_values(forces)[node.first + i]);
    stabilisation_->set_last_forces(std::move(last));
  });
}

DiagnosticList BodyStabilisation::check_needless() const {
  DiagnosticList messages;
  for (std::size_t body = 0; body < is_needless_.size(); ++body)
    if (is_needless_[body])
      messages.push_back(Diagnostic(diagnostic::needless_stabilisation,
                                    "Supports and symmetry planes hold body '" + scene_.bodies()[body].name +
                                        "', which has 'Contact stabilisation = until contact'")
                             .body(scene_.bodies()[body].name));
  return messages;
}

void BodyStabilisation::judge_free_body(const std::size_t body, const FinalState &state,
                                        DiagnosticList &messages) const {
  const std::string &name = scene_.bodies()[body].name;
  const auto &free = state.support_by_contact.free;
  const std::string mode = "a rigid-body mode of body '" + name + "' at the end" +
                           (free && free->body == body ? ", with " + print(free->motion) : "");
  const double force = stabilisation_->last_force(body);
  const double part = state.forces > 0. ? force / state.forces : 0.;
  // Loads are the difference of these forces and the internal and contact forces.
  const double largest = std::max(force, state.forces_on_bodies[body]);
  const double own_part = largest > 0. ? force / largest : 0.;
  const bool is_much = part > ContactStabilisation::max_part;
  std::ostringstream text;
  text.precision(3);
  text << "Neither supports nor contact constrain " << mode << ": viscous forces bear "
       << 100. * (is_much ? part : own_part) << " % of the forces " << (is_much ? "there" : "on the body");
  if (is_much)
    messages.push_back(Diagnostic(diagnostic::stabilised_loads, text.str())
                           .body(name)
                           .time(state.time)
                           .measure("part of the forces", part));
  else if (own_part > ContactStabilisation::max_part)
    messages.push_back(Diagnostic(diagnostic::stabilised_at_end, text.str())
                           .body(name)
                           .time(state.time)
                           .measure("part of the forces on the body", own_part));
  const dealii::Tensor<1, 3> &drift = stabilisation_->drifts()[body];
  const double distance = drift.norm();
  if (!(distance > Limits::max_drift * sizes_[body]))
    return;
  RigidMotion motion{drift / distance, {}};
  for (unsigned int i = 0; i < 3; ++i)
    if (std::abs(motion.translation[i]) < Limits::no_component)
      motion.translation[i] = 0.;
  std::ostringstream moved;
  moved.precision(3);
  moved << "Loads have moved body '" << name << "' by " << distance << ", " << 100. * distance / sizes_[body]
        << " % of its size, with " << print(motion)
        << ", which neither supports nor contact constrain: only viscous forces have resisted";
  messages.push_back(Diagnostic(diagnostic::stabilised_drift, moved.str())
                         .body(name)
                         .time(state.time)
                         .measure("part of the size", distance / sizes_[body]));
}

DiagnosticList BodyStabilisation::finish(const FinalState &state) const {
  DiagnosticList messages;
  if (!stabilisation_)
    return messages;
  for (std::size_t body = 0; body < scene_.bodies().size(); ++body) {
    const std::string &name = scene_.bodies()[body].name;
    const double part = state.max_energy > 0. ? stabilisation_->work_of_motion(body) / state.max_energy : 0.;
    if (part > ContactStabilisation::max_part) {
      const double factor = part / ContactStabilisation::max_part;
      std::ostringstream text;
      text.precision(3);
      text << "The viscous forces that stabilise body '" << name << "' do " << 100. * part
           << " % of all work, " << factor << " times the allowed " << 100. * ContactStabilisation::max_part
           << " %";
      messages.push_back(Diagnostic(diagnostic::stabilisation_too_strong, text.str())
                             .body(name)
                             .time(state.time)
                             .measure("factor", factor)
                             .value("part of all work", part));
    }
    const std::vector<bool> &is_free = state.support_by_contact.is_free;
    if (stabilisation_->acts_on(body) && body < is_free.size() && is_free[body])
      judge_free_body(body, state, messages);
  }
  return messages;
}

} // namespace billet
