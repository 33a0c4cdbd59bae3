// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/explicit_forces.h"

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

void clear(NodalVectors &vectors, const std::vector<unsigned int> &nodes) {
  for (const unsigned int node : nodes)
    std::fill_n(&vectors[std::size_t{nodal_stride} * node], nodal_stride, 0.);
}

/// Marks the nodes on boundaries of elements of any rank by 1 in their first component. Collective.
NodalVectors mark_boundaries(const LocalNodes &nodes, const std::size_t n_bodies) {
  const Discretization &discretization = nodes.discretization();
  NodalVectors is_at_boundary = nodes.make_vectors();
  for (std::size_t b = 0; b < n_bodies; ++b)
    for (std::size_t e = 0; e < nodes.elements(b).size(); ++e) {
      const auto &cell = discretization.elements(b)[e].cell;
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary())
          for (unsigned int v = 0; v < 4; ++v)
            is_at_boundary[std::size_t{nodal_stride} *
                           nodes.elements(b)[e][dealii::GeometryInfo<3>::face_to_cell_vertices(f, v)]] = 1.;
    }
  nodes.sum_shared(is_at_boundary);
  return is_at_boundary;
}

} // namespace

ExplicitForces::ExplicitForces(const Scene &scene, const LocalNodes &nodes, const ExplicitElements &elements,
                               const double contact_resolution)
    : nodes_(nodes), loads_(scene, nodes, elements.lumped_masses()), of_loads_(scene, nodes, loads_),
      bound_factor_(contact_resolution * contact_resolution), forces_(nodes.make_vectors()),
      external_(forces_), bounds_(forces_) {
  find_touched_nodes(scene);
}

void ExplicitForces::find_touched_nodes(const Scene &scene) {
  bool has_accelerations = false, has_loads = false;
  has_bounds_ = !scene.pairs().empty() || !scene.body_pairs().empty();
  bool may_let_go = false, has_bounded_nodes = false;
  for (const auto &body : scene.bodies()) {
    for (const Constraint &constraint : body.constraints) {
      may_let_go = may_let_go || std::isfinite(constraint.times.until);
      // Selected nodes may be inside.
      has_accelerations = has_accelerations || (constraint.nodes && std::isfinite(constraint.times.until));
    }
    for (const auto &load : body.loads) {
      has_loads = true;
      has_accelerations = has_accelerations || !load.load.acts_on_faces() || load.nodes;
      has_bounded_nodes = has_bounded_nodes || (load.nodes && load.load.limits_steps());
      has_bounds_ = has_bounds_ || load.load.limits_steps();
    }
  }
  // All other forces act there.
  const NodalVectors is_touched = mark_boundaries(nodes_, scene.bodies().size());
  // Forces of removed tools and of supports fade.
  const bool may_be_loaded = has_loads || may_let_go || !scene.tools().empty();
  for (unsigned int node = 0; node < nodes_.size(); ++node) {
    const bool touched = is_touched[std::size_t{nodal_stride} * node] > 0.;
    if (has_accelerations || (may_be_loaded && touched))
      loaded_nodes_.push_back(node);
    if (has_bounds_ && (touched || has_bounded_nodes))
      bounded_nodes_.push_back(node);
  }
}

Explanation ExplicitForces::add_contact_forces(const ExplicitClock &clock, const ExplicitMotion &motion,
                                               Contacts &contacts, ExplicitTools &tools,
                                               ExplicitWorks &works) {
  Explanation passage;
  tools.clear_loads();
  const std::vector<Placement> before = tools.placements_before(), now = tools.placements_now();
  const double t = clock.time(), duration = clock.since_forces();
  const ContactStep step{t - duration, t, duration, before, now};
  for (auto &contact : contacts) {
    contact.start_step(step);
    contact.without_matrix().update(motion.displacements());
    if (passage.empty() && contact.checks().lets_nodes_through())
      passage = contact.checks().describe_passage();
    const ContactLoad load = contact.without_matrix().add_forces(forces_, bounds_);
    if (const auto &tool = contact.rigid_tool())
      tools.add_load(contact, *tool, load);
    works.friction += load.dissipation;
    works.external += load.ramp_work;
    contact.without_matrix().add_crossings(crossings_);
    contact.commit();
  }
  return passage;
}

ExplicitForces::Failure ExplicitForces::compute(const ExplicitClock &clock, const ExplicitMotion &motion,
                                                ExplicitElements &elements, Contacts &contacts,
                                                ExplicitTools &tools, ExplicitWorks &works) {
  clear(bounds_, bounded_nodes_);
  clear(external_, loaded_nodes_);
  crossings_ = Crossings();
  Failure failure;
  const NodalVectors &u = motion.displacements(), &v = motion.velocities();
  loads_.follow(u);
  try {
    motion.check();
    tools.remove_due(clock.time(), contacts, works.external); // at the start of a run
    tools.add_fading(clock.time(), loaded_nodes_, external_);
    motion.add_fading(clock.time(), external_);
    element_step_ = elements.add_forces({u.data(), v.data(), forces_.data()}, clock, works);
    of_loads_.evaluate(clock.time(), u, v, external_);
  } catch (const SolutionFailure &) { // of this rank
    failure = std::current_exception();
  }
  // Contact communicates between ranks, also if one has failed.
  if (const Explanation passage = add_contact_forces(clock, motion, contacts, tools, works);
      !failure && !passage.empty())
    failure = std::make_exception_ptr(clock.failure(passage));
  if (failure)
    element_step_ = -1.;
  for (const unsigned int node : bounded_nodes_)
    bounds_[std::size_t{nodal_stride} * node] *= bound_factor_;
  loads_.add_bounds(bounds_);
  for (const unsigned int node : loaded_nodes_)
    add_vector(forces_.data(), node, get_vector(external_.data(), node));
  nodes_.sum_shared(forces_);
  if (has_bounds_)
    nodes_.sum_shared(bounds_);
  return failure;
}

StepBounds ExplicitForces::bounds(const std::vector<double> &inverse_masses) const {
  StepBounds bounds{element_step_, 0., 0.};
  for (const unsigned int node : bounded_nodes_) {
    const double *of_node = &bounds_[std::size_t{nodal_stride} * node];
    bounds.frequency_square = std::max(bounds.frequency_square, of_node[0] * inverse_masses[node]);
    bounds.damping_rate = std::max(bounds.damping_rate, of_node[1] * inverse_masses[node]);
  }
  return bounds;
}

double ExplicitForces::frequency_square_at(const NodalVectors &displacements,
                                           const std::vector<Placement> &placements, Contacts &contacts,
                                           const std::vector<double> &inverse_masses) {
  NodalVectors ignored = nodes_.make_vectors(), bounds = nodes_.make_vectors();
  const ContactStep step{0., 0., 0., placements, placements};
  for (auto &contact : contacts) {
    contact.start_step(step);
    contact.without_matrix().update(displacements);
    contact.without_matrix().add_forces(ignored, bounds);
  }
  nodes_.sum_shared(bounds);
  double maximum = 0.;
  for (const unsigned int node : bounded_nodes_)
    maximum =
        std::max(maximum, bound_factor_ * bounds[std::size_t{nodal_stride} * node] * inverse_masses[node]);
  return maximum;
}

double ExplicitForces::max_stiffness() const {
  double maximum = 0.;
  for (const unsigned int node : bounded_nodes_)
    maximum = std::max(maximum, bounds_[std::size_t{nodal_stride} * node]);
  return maximum;
}

} // namespace billet
