// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/body_stabilisation.h"

#include "billet/diagnostic_kinds.h"
#include "billet/discretization/boundary_facets.h"
#include "billet/mechanics/element_mass.h"
#include "billet/solve/restart.h"

#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <sstream>

namespace billet {

namespace {

/// Calls visit(facet, corner, direction) for this rank's springs that support the body during the whole run.
template <class Visit>
void visit_springs(const Body &body, const Discretization &discretization, const std::size_t index,
                   const Visit &visit) {
  for (const AppliedLoad &load : body.loads) {
    const dealii::Tensor<1, 3> any({1., 0., 0.});
    if (!load.times.always() || load.load.supports(any).empty())
      continue;
    for (const auto &facet : collect_boundary_facets(discretization, index, load.boundary_ids))
      for (const auto &direction : load.load.supports(facet.area_vector() / facet.area_vector().norm()))
        for (unsigned int corner = 0; corner < 4; ++corner)
          visit(facet, corner, direction);
  }
}

} // namespace

RigidBodies::RigidBodies(const Scene &scene, const Discretization &discretization, const HoldFilter &acts) {
  const std::size_t n_bodies = scene.bodies().size();
  const double far = 10. * discretization.radius();
  std::vector<double> low(3 * n_bodies, far), high(3 * n_bodies, far); // about the scene's centre, negative
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
  for (const auto &entry : collect_held_nodes(scene, discretization, acts))
    for (std::size_t body = 0; body < n_bodies; ++body)
      for (const auto &hold : scene.bodies()[body].holds)
        if (std::count(entry.second.holds.begin(), entry.second.holds.end(), &hold) > 0) {
          const dealii::Tensor<1, 3> normal = hold.direction(entry.second.position);
          supported_nodes.push_back({body, entry.second.position, normal, entry.second.dofs});
          support.add_support(body, entry.second.position, normal);
        }
  for (std::size_t body = 0; body < n_bodies; ++body)
    visit_springs(scene.bodies()[body], discretization, body,
                  [&](const BoundaryFacet &facet, const unsigned int corner, const auto &direction) {
                    supported_nodes.push_back({body, facet.corners[corner], direction, facet.dofs[corner]});
                    support.add_support(body, facet.corners[corner], direction);
                  });
  if (support.find().n_free > 0)
    return;
  frames.clear();
  supported_nodes.clear();
}

namespace {

/// Returns Σ ∫ N_a dV of the undeformed elements at their nodes, in each of the three directions. Collective.
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
  for (std::size_t body = 0; body < n_bodies; ++body) {
    RigidBodySupport support(discretization_.communicator(), {bodies.frames[body]}, 0);
    for (const auto &node : bodies.supported_nodes)
      if (node.body == body)
        support.add_support(0, node.position, node.normal);
    if (support.find().n_free == 0)
      continue;
    const double size = 2. * bodies.frames[body].size, end = scene_.parameters().time_stepping.end_time;
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

double BodyStabilisation::commit(const StepState &step, const std::vector<bool> &is_free,
                                 const double driven_work) {
  if (!stabilisation_)
    return 0.;
  std::vector<bool> is_supported;
  for (std::size_t body = 0; body < scene_.bodies().size(); ++body)
    is_supported.push_back(stabilisation_->acts_on(body) && !is_free[body]);
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
    save_nodal(writer, "forces", OwnedNodes(discretization_, NodeKeys(discretization_)), forces);
  });
}

void BodyStabilisation::load(StateReader &reader) {
  if (!stabilisation_ || !reader.has("stabilisation"))
    return;
  reader.in("stabilisation", [&] {
    stabilisation_->load(reader.read("bodies"));
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

DiagnosticList BodyStabilisation::finish(const double time, const double max_energy, const double forces,
                                         const RigidBodySupport::Result &support_by_contact) const {
  DiagnosticList messages;
  if (!stabilisation_)
    return messages;
  for (std::size_t body = 0; body < scene_.bodies().size(); ++body) {
    const std::string &name = scene_.bodies()[body].name;
    const double part = max_energy > 0. ? stabilisation_->work_of_motion(body) / max_energy : 0.;
    if (part > ContactStabilisation::max_part) {
      const double factor = part / ContactStabilisation::max_part;
      std::ostringstream text;
      text.precision(3);
      text << "The viscous forces that stabilise body '" << name << "' do " << 100. * part
           << " % of all work, " << factor << " times the allowed " << 100. * ContactStabilisation::max_part
           << " %";
      messages.push_back(Diagnostic(diagnostic::stabilisation_too_strong, text.str())
                             .body(name)
                             .time(time)
                             .measure("factor", factor)
                             .value("part of all work", part));
    }
    if (!stabilisation_->acts_on(body) || body >= support_by_contact.is_free.size() ||
        !support_by_contact.is_free[body])
      continue;
    const std::string what = "Neither supports nor contact constrain a rigid-body mode of body '" + name +
                             "' at the end" +
                             (support_by_contact.free && support_by_contact.free->body == body
                                  ? ", with " + print(support_by_contact.free->motion)
                                  : "");
    const double force_part = forces > 0. ? stabilisation_->last_force(body) / forces : 0.;
    if (force_part > ContactStabilisation::max_part) {
      std::ostringstream text;
      text.precision(3);
      text << what << ": viscous forces bear " << 100. * force_part << " % of the forces there";
      messages.push_back(Diagnostic(diagnostic::stabilised_loads, text.str())
                             .body(name)
                             .time(time)
                             .measure("part of the forces", force_part));
    } else
      messages.push_back(Diagnostic(diagnostic::stabilised_at_end, what + ": only viscous forces resist it")
                             .body(name)
                             .time(time));
  }
  return messages;
}

} // namespace billet
