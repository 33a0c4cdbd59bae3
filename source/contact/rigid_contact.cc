// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/rigid_contact.h"

#include "billet/discretization/boundary_facets.h"
#include "billet/discretization/supports.h"

#include <deal.II/base/array_view.h>
#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace billet {

using dealii::Tensor;

namespace {

/// Width of the zone beyond the edge of a tool's surface in which its pressure fades [facet sizes].
constexpr double fading_width = 0.05;

/// Returns the maximum penetration up to which the spring energy acts on current areas in explicit scenes.
/// The excess acts on a fixed area: that of the last step in which the node was not so deep. The limit is 0
/// for hardening springs, so that energy is conserved where the normal jumps, as at an edge of the tool.
double depth_on_current_areas(const ContactPoint &node) {
  return std::isinf(node.hardening_depth) ? 0.1 * node.spacing : 0.;
}

/// Returns the maximum curvature of a surface whose normal has this gradient.
double largest_curvature(const dealii::Tensor<2, 3> &turning) {
  const auto principal = dealii::eigenvalues(dealii::symmetrize(turning));
  return std::max(std::abs(principal[0]), std::abs(principal[2]));
}

} // namespace

RigidContact::RigidContact(const Scene &scene, const std::size_t pair, const Discretization &discretization,
                           const ContactTangent tangent)
    : ContactInterface(scene, scene.pairs()[pair]), pair_(scene.pairs()[pair]),
      tool_(scene.tools()[pair_.tool]), communicator_(discretization.communicator()), tangent_(tangent),
      has_inertia_(scene.parameters().is_dynamic()), is_explicit_(scene.parameters().is_explicit()),
      slaves_(pair_, tool_, discretization, scene.bodies()[pair_.body].young_modulus,
              has_inertia_ && !is_explicit_ ? 0. : touching_gap) {
  max_stiffening_ = slaves_.max_stiffening;
  max_tangential_stiffening_ = slaves_.max_tangential_stiffening;
  if (!has_inertia_) {
    const std::set<DofIndex> fixed = collect_fixed_nodes(scene, discretization);
    for (auto &node : slaves_.nodes)
      node.is_fixed = fixed.count(node.dofs[0]) > 0;
  }
  placement_n_ = placement_ = tool_.placement(0.);
  states_.resize(slaves_.nodes.size());
  if (pair_.has_friction())
    friction_n_.resize(slaves_.nodes.size());
  const BoundingBox &box = tool_.surface().bounding_box();
  double tool_size = 0.;
  for (unsigned int i = 0; i < 3; ++i)
    for (const double end : {box.low[i], box.high[i]})
      tool_size = std::max(tool_size, std::isfinite(end) ? std::abs(end) : 0.);
  for (std::size_t i = 0; i < slaves_.nodes.size(); ++i) {
    const auto X = placement_.to_tool(slaves_.nodes[i].reference);
    const auto projection = tool_.surface().project(X);
    states_[i].position = slaves_.nodes[i].reference;
    states_[i].gap = slaves_.nodes[i].gap_n = projection.gap;
    if (projection.exists &&
        ((pair_.overlap.is_allowed && projection.gap < 0.) || pair_.overlap.closes(projection.gap))) {
      slaves_.nodes[i].initial_depth = -projection.gap;
      states_[i].gap = slaves_.nodes[i].gap_n = 0.;
    }
    slaves_.nodes[i].patch = projection.patch;
    const double curvature = projection.turning.norm();
    if (curvature > 0.)
      tool_reach_ = std::max(tool_reach_, std::min(1. / curvature, tool_size));
    if (!friction_n_.empty())
      friction_n_[i].tool_position = X;
  }
  friction_ = friction_n_;
  double max_size = 0.;
  for (const auto &node : slaves_.nodes)
    max_size = std::max(max_size, node.size);
  thin_tool_ = ThinToolWatch::make(tool_.surface(), dealii::Utilities::MPI::max(max_size, communicator_));
  if (is_explicit_ && !pair_.input->has_own_penalty && thin_tool_)
    slaves_.harden_springs(thin_tool_->thickness());
  for (auto &node : slaves_.nodes)
    node.given = node.stiffness;
  remember_positions();
  remember_pressures();
  memory_.set(slaves_.nodes.size() * (sizeof(ContactPoint) + sizeof(ToolContactState)) +
              slaves_.facets.size() * sizeof(ContactFacet));
  friction_memory_.set(2 * friction_.size() * sizeof(FrictionHistory));
}

void RigidContact::start_step(const ContactStep &step) {
  placement_n_ = step.tools_at_start[pair_.tool];
  placement_ = step.tools_at_end[pair_.tool];
  duration_ = step.duration;
  allowed_part_ = pair_.overlap.allowed_part(step.end);
}

void RigidContact::remove_tool() {
  is_removed_ = true;
  for (auto &state : states_)
    state = ToolContactState();
  for (auto &history : friction_)
    history = FrictionHistory();
  friction_n_ = friction_;
}

template <class DisplacementOf> void RigidContact::update_states(const DisplacementOf &displacement_of) {
  if (is_removed_)
    return;
  Usage::count(Capability::contact, slaves_.nodes.size());
  Usage::count_if(!friction_.empty(), Capability::friction, friction_.size());
  choose_friction(pair_.friction, [&](const auto &law) {
    const auto update_state = [&](const std::size_t i, const Tensor<1, 3> &position) {
      states_[i] = evaluate(law, i, position, friction_.empty() ? nullptr : &friction_[i]);
      slaves_.nodes[i].patch = states_[i].patch;
    };
    for (std::size_t i = 0; i < slaves_.n_mesh_nodes; ++i)
      update_state(i, slaves_.nodes[i].reference + displacement_of(i));
    for (auto &divided : slaves_.divided) {
      if (is_far(divided))
        continue;
      divided.may_touch = false;
      for (std::size_t i = divided.first_point; i < divided.first_point + divided.n_points; ++i) {
        update_state(i, slaves_.at(i, [&](const std::size_t parent) { return states_[parent].position; }));
        divided.may_touch = divided.may_touch || states_[i].status != ContactStatus::open;
      }
    }
  });
}

double RigidContact::stiffness_ahead(const std::size_t i) const {
  const double gap = states_[i].gap;
  return slaves_.nodes[i].spring().slope(std::max(0., -gap) + std::max(0., slaves_.nodes[i].gap_n - gap));
}

bool RigidContact::is_far(DividedFacet &divided) {
  if (divided.may_touch)
    return false;
  // Gaps are distances: no gap in the facet is less than that of the nearest corner minus the distance to it.
  std::array<const ToolContactState *, 4> corners{};
  double least = std::numeric_limits<double>::infinity(), approach = 0., size = 0.;
  for (unsigned int a = 0; a < 4; ++a) {
    const ContactPoint &node = slaves_.nodes[divided.corners[a]];
    corners[a] = &states_[divided.corners[a]];
    if (corners[a]->is_behind)
      return false;
    least = std::min(least, corners[a]->gap);
    approach = std::max(approach, node.gap_n - corners[a]->gap);
    size = std::max(size, node.size);
  }
  const double way = 0.5 * std::max((corners[3]->position - corners[0]->position).norm(),
                                    (corners[2]->position - corners[1]->position).norm());
  const double gap = least - way;
  if (!(gap > near_gap * size + near_steps * approach))
    return false;
  for (std::size_t i = divided.first_point; i < divided.first_point + divided.n_points; ++i) {
    ToolContactState &state = states_[i];
    state.position = slaves_.at(i, [&](const std::size_t parent) { return states_[parent].position; });
    state.gap = gap;
    if (!friction_.empty()) // it was also open before
      friction_[i].tool_position = placement_.to_tool(state.position);
  }
  return true;
}

void RigidContact::update(const Vector &displacements) {
  update_states([&](const std::size_t i) {
    Tensor<1, 3> displacement;
    for (unsigned int c = 0; c < 3; ++c)
      displacement[c] = displacements(slaves_.nodes[i].dofs[c]);
    return displacement;
  });
}

void RigidContact::bind(const LocalNodes &nodes) {
  local_nodes_.clear();
  is_owned_.clear();
  for (std::size_t i = 0; i < slaves_.n_mesh_nodes; ++i) {
    local_nodes_.push_back(nodes.find(slaves_.nodes[i].dofs[0]));
    is_owned_.push_back(nodes.is_owned(local_nodes_.back()));
  }
  is_owned_.resize(slaves_.nodes.size(), true);
}

void RigidContact::update(const NodalVectors &displacements) {
  update_states([&](const std::size_t i) { return get_vector(displacements.data(), local_nodes_[i]); });
}

void RigidContact::introduce(std::deque<RigidContact> &contacts) {
  for (auto &contact : contacts)
    for (const auto &other : contacts)
      if (&other != &contact && other.body() == contact.body())
        contact.others_.push_back(&other);
}

bool RigidContact::is_near_another(const Tensor<1, 3> &position, const double near,
                                   const std::optional<Tensor<1, 3>> &facing) const {
  constexpr double alike = 0.5; // cosine
  return std::any_of(others_.begin(), others_.end(), [&](const RigidContact *other) {
    if (other->is_removed_)
      return false;
    const auto projection = other->tool_.surface().project(other->placement_.to_tool(position));
    return projection.exists && std::abs(projection.gap) < near &&
           (!facing || *facing * (other->placement_.rotation * projection.normal) > alike);
  });
}

bool RigidContact::has_node_on_border(const Tensor<1, 3> &position) const {
  constexpr double same = 1e-8, near = 0.1; // facet sizes
  for (std::size_t i = 0; i < slaves_.nodes.size(); ++i) {
    const double size = slaves_.nodes[i].size;
    if (is_removed_ || (states_[i].position - position).norm() > same * size)
      continue;
    const Tensor<1, 3> x = placement_.to_tool(position);
    const auto here = tool_.surface().project(x, slaves_.nodes[i].patch);
    if (states_[i].share < 1.)
      return true;
    if (std::abs(here.gap) > size)
      continue;
    const Frame along = Frame::from_normal(here.normal);
    for (const auto &way : {along.q, -along.q, along.r, -along.r})
      if (tool_.surface().project(x + near * size * way, slaves_.nodes[i].patch).exists != here.exists)
        return true;
  }
  return false;
}

bool RigidContact::misses(const ContactPoint &node, const Tensor<1, 3> &position, const Tensor<1, 3> &on_tool,
                          const RigidSurface::Projection &projection) const {
  if (!has_inertia_)
    return false;
  if (projection.exists) // and it has not come through from the front of the surface before it
    return node.is_behind && projection.gap - lift_of(node) < 0. &&
           projection.gap - projection.normal * (on_tool - node.behind_at) < 0.;
  if (!projection.is_behind)
    return false;
  if (node.is_behind)
    return true;
  constexpr double far = 2.; // facet sizes: a node farther away passes this zone first
  const double width = fading_width * node.size;
  const double along_squared = projection.gap * projection.gap - projection.beyond * projection.beyond;
  return projection.beyond >= width && projection.beyond < far * node.size &&
         std::sqrt(std::max(0., along_squared)) + lift_of(node) > width &&
         !is_near_another(position, node.size);
}

template <class Law>
ToolContactState RigidContact::evaluate(const Law &law, const std::size_t i, const Tensor<1, 3> &position,
                                        FrictionHistory *history) const {
  const ContactPoint &node = slaves_.nodes[i];
  ToolContactState state;
  state.position = position;
  const Tensor<1, 3> on_tool = placement_.to_tool(position);
  auto projection = tool_.surface().project(on_tool, node.patch);
  const double width = fading_width * node.size;
  state.is_behind = misses(node, position, on_tool, projection);
  state.is_passed = state.is_behind && projection.exists;
  const bool fades = !state.is_behind && !projection.exists && projection.beyond < width &&
                     !is_near_another(position, node.size, placement_.rotation * projection.normal);
  EdgeFading fading{};
  if (fades) {
    RigidSurface::Border border = tool_.surface().border(on_tool, projection.patch, width);
    projection = {true, border.normal, border.gap, border.turning, projection.patch};
    border.normal = placement_.rotation * border.normal;
    border.outward = placement_.rotation * border.outward;
    border.spreading = placement_.rotation * border.spreading * dealii::transpose(placement_.rotation);
    fading = compute_edge_fading(border, width, node.spring(), border.gap - lift_of(node));
    state.share = fading.share;
    state.fading_stiffness = fading.stiffness;
  }
  state.gap = projection.gap - lift_of(node);
  if (state.is_passed) // distance to the front
    state.gap = -state.gap;
  state.patch = projection.patch;
  // A node that starts on the tool counts as touching: its stiffness may be the only constraint of the body.
  // With inertia the body needs no constraint, and a stiffness without a force would mislead Newton's method
  // at lift-off. The node then counts only while its lift-off is within round-off.
  const double on_it = node.touching_gap;
  const double rounding = 1e-13 * node.size + 4. * std::numeric_limits<double>::epsilon() * position.norm();
  const bool rests = node.gap_n <= on_it && state.gap <= std::min(on_it, node.gap_n + rounding);
  const bool touches = projection.exists && !state.is_behind && (state.gap < 0. || rests);
  if (touches) {
    state.normal = placement_.rotation * projection.normal;
    state.turning = placement_.rotation * projection.turning * dealii::transpose(placement_.rotation);
  }
  if constexpr (std::is_same_v<Law, Frictionless>) {
    if (touches) {
      const double penalty = state.share * node.spring().secant(std::max(-state.gap, 0.));
      const FrameTraction t = compute_frictionless_traction(penalty, state.gap);
      state.status = t.status;
      state.pressure = t.pressure;
      state.traction = t.pressure * state.normal;
      state.tangent = penalty * dealii::outer_product(state.normal, state.normal);
      if (tangent_ == ContactTangent::exact)
        state.tangent -= t.pressure * state.turning;
    }
  } else {
    const FrictionHistory &history_n = friction_n_[i];
    if (touches)
      apply_friction(law, node, state, fades ? &fading : nullptr, history_n, *history);
    else {
      if (history_n.is_active) { // its spring is released
        state.normal = placement_.rotation * projection.normal;
        const auto along = [&](const Tensor<1, 3> &axis) {
          return (placement_.rotation * (dealii::transpose(placement_n_.rotation) * axis)) *
                 (position - placement_.to_space(history_n.tool_position));
        };
        const double part = !is_static_ || !knows_pressures_
                                ? 1.
                                : part_before_leaving(pressed_n_[i].depth, along(history_n.frame.n));
        state.friction = compute_friction_account(
            {history_n.tangential, {}, {along(history_n.frame.q), along(history_n.frame.r)}, false, part},
            friction_rule(node));
      }
      history->is_active = false;
      history->tangential = {};
      history->slip = history_n.slip;
      history->slip_rate = 0.;
    }
    history->tool_position = on_tool;
  }
  if (fades && touches) { // all except friction is pressure
    state.pressure = (state.pressure * state.normal + fading.push).norm();
    state.traction += fading.push;
    state.tangent += fading.tangent;
  }
  return state;
}

void RigidContact::apply_friction(const FrictionLaw &law, const ContactPoint &node, ToolContactState &state,
                                  const EdgeFading *fading, const FrictionHistory &history_n,
                                  FrictionHistory &history) const {
  history.frame = history_n.is_active
                      ? history_n.frame.transported(
                            placement_.rotation * dealii::transpose(placement_n_.rotation), state.normal)
                      : Frame::from_normal(state.normal);
  const Frame &Z = history.frame;
  const std::array<Tensor<1, 3>, 3> axes{Z.q, Z.r, Z.n};

  // Displacement over the step relative to the tool's material point that was at the node (eq. (33), with the
  // tool's motion).
  const Tensor<1, 3> displacement = state.position - placement_.to_space(history_n.tool_position);
  TangentialIncrement increment{{displacement * Z.q, displacement * Z.r}};
  increment.per_time = duration_ > 0. ? 1. / duration_ : 0.;
  increment.rate = history_n.slip_rate;

  // A node that enters within the step has slid along the tool only for the part φ = g/(g − g_n) of it.
  ContactStiffness stiffness = node.stiffness;
  stiffness.normal = state.share * node.spring().secant(std::max(-state.gap, 0.));
  double fraction = 1., relative_slope = 0.; // (∂φ/∂g)/φ
  if (!history_n.is_active && node.gap_n > node.touching_gap && state.gap < 0.) {
    fraction = state.gap / (state.gap - node.gap_n);
    stiffness.tangential *= fraction;
    relative_slope = node.gap_n / (state.gap * (node.gap_n - state.gap));
  }
  // The frame rotates with the normal, δn = H δx:
  //   δΔg_q = q·δx − (Δ·n) q·Hδx + Δg_r spin·Hδx,  δΔg_r = r·δx − (Δ·n) r·Hδx − Δg_q spin·Hδx.
  const Tensor<1, 3> Hq = state.turning * Z.q, Hr = state.turning * Z.r, Hs = state.turning * Z.spin;
  if (tangent_ == ContactTangent::exact) {
    const double along = displacement * Z.n;
    const std::array<Tensor<1, 3>, 2> gradient{
        Z.q - along * Hq + increment.value[1] * Hs + increment.value[0] * relative_slope * Z.n,
        Z.r - along * Hr - increment.value[0] * Hs + increment.value[1] * relative_slope * Z.n};
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        increment.gradient[i][j] = gradient[i] * axes[j];
  }
  const auto i = static_cast<std::size_t>(&node - slaves_.nodes.data());
  const FrameTraction t = compute_traction(law, stiffness, tangent_, state.gap,
                                           base_.empty() ? history_n.tangential : base_[i], increment);

  state.status = t.status;
  state.pressure = t.pressure;
  state.traction = t.tangential[0] * Z.q + t.tangential[1] * Z.r + t.pressure * Z.n;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      state.tangent += t.tangent[i][j] * dealii::outer_product(axes[i], axes[j]);
  if (tangent_ == ContactTangent::exact) // −(t_q δq + t_r δr + p δn)
    state.tangent += dealii::outer_product(Z.n, t.tangential[0] * Hq + t.tangential[1] * Hr) -
                     dealii::outer_product(t.tangential[0] * Z.r - t.tangential[1] * Z.q, Hs) -
                     t.pressure * state.turning;
  if (fading)
    state.tangent -=
        dealii::outer_product(t.pressure_slope[0] * Z.q + t.pressure_slope[1] * Z.r, fading->pressure_slope);

  history.is_active = true;
  history.tangential = t.tangential;
  state.slip_increment = fraction * std::hypot(t.slip[0], t.slip[1]);
  state.tangential_energy = 0.5 * (t.tangential[0] * t.tangential[0] + t.tangential[1] * t.tangential[1]) /
                            node.stiffness.tangential;
  double limit_n = 0.;
  if (is_static_ && knows_pressures_ && state.slip_increment > 0. && t.pressure > 0.)
    limit_n = std::hypot(t.tangential[0], t.tangential[1]) * pressed_n_[i].pressure / t.pressure;
  state.friction = compute_friction_account(
      {history_n.tangential, t.tangential, increment.value, true, fraction, limit_n}, friction_rule(node));
  history.slip = history_n.slip + state.slip_increment;
  history.slip_rate =
      increment.per_time > 0. ? state.slip_increment * increment.per_time : history_n.slip_rate;
}

CornerStates RigidContact::states_of(const ContactFacet &facet) const {
  return {&states_[facet.nodes[0]], &states_[facet.nodes[1]], &states_[facet.nodes[2]],
          &states_[facet.nodes[3]]};
}

template <class Visit> void RigidContact::for_each_touching(const Visit &visit) const {
  for (const auto &facet : slaves_.facets) {
    const CornerStates states = states_of(facet);
    if (!any_touches(states))
      continue;
    const ProjectedAreas areas = compute_projected_areas(states, false);
    for (unsigned int a = 0; a < 4; ++a)
      if (states[a]->status != ContactStatus::open)
        visit(facet, a, areas.areas[a]);
  }
}

template <class Add> void RigidContact::for_each_area(const Add &add) const {
  for_each_touching([&](const ContactFacet &facet, const unsigned int corner, const double area) {
    if (area > 0.)
      add(facet.nodes[corner], area);
  });
}

template <class Add> void RigidContact::for_each_counted_area(const Add &add) const {
  for_each_touching([&](const ContactFacet &facet, const unsigned int corner, const double area) {
    const double counted = springs_of(facet.nodes[corner]).counted_area(area, facet.shallow_areas[corner]);
    if (counted > 0.)
      add(facet.nodes[corner], counted);
  });
}

template <class Add> void RigidContact::for_each_near(const Add &add) const {
  for (unsigned int i = 0; i < slaves_.nodes.size(); ++i) {
    const ContactPoint &node = slaves_.nodes[i];
    const double gap = states_[i].gap;
    // The step in which a node enters must be short enough already, and equal steps conserve energy best.
    const bool is_near = gap < near_gap * node.size || gap + near_steps * (gap - node.gap_n) < 0.;
    if (states_[i].status == ContactStatus::open && gap >= 0. && is_near && is_owned_[i])
      add(i, node.spacing * node.spacing);
  }
}

std::vector<SlaveForce> RigidContact::slave_forces() const {
  std::vector<SlaveForce> result(states_.size());
  for (std::size_t i = 0; i < states_.size(); ++i)
    result[i].status = states_[i].status;
  for_each_area(
      [&](const unsigned int i, const double area) { result[i].force += area * states_[i].traction; });
  return result;
}

void RigidContact::add_forces(Vector &residual) const {
  for_each_area([&](const unsigned int i, const double area) {
    slaves_.add_to_dofs(i, -area * states_[i].traction, residual);
  });
}

ContactLoad RigidContact::add_forces(NodalVectors &forces, NodalVectors &bounds) {
  ContactLoad load;
  for (auto &facet : slaves_.facets)
    add_forces(facet, forces, bounds, load);
  for_each_near([&](const unsigned int i, const double area) {
    // w (Σ w_b v_b)² <= w Σ w_b v_b²
    slaves_.for_each_parent(i, [&](const unsigned int parent, const double weight) {
      bounds[std::size_t{nodal_stride} * local_nodes_[parent]] +=
          weight * (area * std::max(stiffness_ahead(i), slaves_.nodes[i].stiffness.tangential));
    });
  });
  add_friction(load, false);
  return load;
}

void RigidContact::add_crossings(Crossings &crossings) const {
  if (is_removed_ || duration_ == 0.)
    return;
  for (std::size_t i = 0; i < slaves_.nodes.size(); ++i)
    if (is_owned_[i]) {
      const ContactPoint &node = slaves_.nodes[i];
      const double moved = states_[i].gap - node.gap_n;
      crossings.add(node.spring().slope(moved) * node.spacing * node.spacing, states_[i].gap, moved);
    }
}

void RigidContact::add_start_crossings(Crossings &crossings, const NodalVectors &velocities,
                                       const double step) const {
  for (std::size_t i = 0; i < slaves_.nodes.size(); ++i) {
    const ContactPoint &node = slaves_.nodes[i];
    const Tensor<1, 3> v = slaves_.at(
        i, [&](const std::size_t parent) { return get_vector(velocities.data(), local_nodes_[parent]); });
    if (!is_owned_[i] || std::abs(states_[i].gap) >= 2. * step * v.norm())
      continue;
    const auto projection = tool_.surface().project(placement_.to_tool(states_[i].position), node.patch);
    const double moved = step * (v * (placement_.rotation * projection.normal));
    crossings.add(node.spring().slope(moved) * node.spacing * node.spacing, states_[i].gap, moved);
  }
}

double RigidContact::stored_energy(const std::size_t i) const {
  // Multipliers do not stretch springs.
  const double gap = states_[i].gap + slaves_.nodes[i].lift; // except the allowed penetration
  return states_[i].share * slaves_.nodes[i].spring().energy(gap) +
         (pair_.is_augmented() ? 0. : states_[i].tangential_energy);
}

SpringEnergy RigidContact::springs_of(const std::size_t i, const double energy) const {
  const double limit = slaves_.nodes[i].spring().energy(depth_on_current_areas(slaves_.nodes[i]));
  return is_explicit_ ? SpringEnergy::split(energy, limit) : SpringEnergy::on_one_area(energy);
}

void RigidContact::add_forces(ContactFacet &facet, NodalVectors &forces, NodalVectors &bounds,
                              ContactLoad &load) {
  const CornerStates states = states_of(facet);
  std::array<double, 4> areas{}, energies{};
  double depth = 0.;     // of the corner with the maximum energy
  double hardening = 1.; // of the stiffest spring
  for (unsigned int a = 0; a < 4; ++a)
    if (states[a]->status != ContactStatus::open) {
      const SpringEnergy springs = springs_of(facet.nodes[a]);
      if (!springs.is_split())
        facet.shallow_areas[a] = SpringEnergy::no_area; // set below
      energies[a] = springs.on_current_area;
      const double stiffness = slaves_.nodes[facet.nodes[a]].stiffness.normal;
      depth = std::max(depth, 2. * springs.total / stiffness);
      hardening = std::max(hardening, stiffness_ahead(facet.nodes[a]) / stiffness);
    }
  if (!any_touches(states))
    return;
  depth = std::sqrt(depth);
  std::array<Tensor<1, 3>, 4> by_area; // −Σ_a e_a ∂A_a/∂x_b
  for (const auto &point : facet_points()) {
    const auto [g_1, g_2] = point.tangents([&](const unsigned int a) { return states[a]->position; });
    const Tensor<1, 3> area_vector = dealii::cross_product_3d(g_1, g_2);
    Tensor<1, 3> m;
    for (unsigned int a = 0; a < 4; ++a) {
      const double facing =
          states[a]->status != ContactStatus::open ? -(area_vector * states[a]->normal) : 0.;
      if (facing <= 0.)
        continue;
      areas[a] += point.N[a] * facing;
      m += point.N[a] * energies[a] * states[a]->normal;
      by_area[a] += point.N[a] * energies[a] * (states[a]->turning * area_vector);
    }
    const Tensor<1, 3> by_xi = dealii::cross_product_3d(g_2, m), by_eta = dealii::cross_product_3d(m, g_1);
    for (unsigned int b = 0; b < 4; ++b)
      by_area[b] += point.N_xi[b] * by_xi + point.N_eta[b] * by_eta;
  }
  for (unsigned int b = 0; b < 4; ++b) {
    const std::size_t i = facet.nodes[b];
    const auto add_bound = [&](const double bound) {
      slaves_.for_each_parent(i, [&](const unsigned int parent, const double weight) {
        bounds[std::size_t{nodal_stride} * local_nodes_[parent]] += weight * bound;
      });
    };
    Tensor<1, 3> force = by_area[b];
    load.force += force;
    load.moment += dealii::cross_product_3d(states[b]->position - placement_.moved_centre(), force);
    add_bound(hardening * slaves_.nodes[i].stiffness.normal *
              std::min(depth, depth_on_current_areas(slaves_.nodes[i])) * (slaves_.nodes[i].spacing + depth));
    if (states[b]->status != ContactStatus::open) {
      if (facet.shallow_areas[b] == SpringEnergy::no_area)
        facet.shallow_areas[b] = areas[b];
      force += add_to_load(load, facet, b, areas[b]);
      add_bound(springs_of(i).max_area(areas[b], facet.shallow_areas[b]) *
                (std::max(stiffness_ahead(i), slaves_.nodes[i].stiffness.tangential) +
                 states[b]->fading_stiffness));
    }
    slaves_.for_each_parent(i, [&](const unsigned int parent, const double weight) {
      add_vector(forces.data(), local_nodes_[parent], weight * force);
    });
  }
}

double RigidContact::largest_spring() const {
  double largest = 0.;
  for (const auto &node : slaves_.nodes)
    largest =
        std::max(largest, std::max(node.stiffness.normal, node.stiffness.tangential) * node.size * node.size);
  return largest;
}

double RigidContact::stiffness_against_tool() const {
  double sum = 0.;
  const auto add = [&](const unsigned int i, const double area) {
    const ToolContactState &state = states_[i];
    const Tensor<1, 3> n = // undefined for open nodes
        state.status != ContactStatus::open
            ? state.normal
            : placement_.rotation *
                  tool_.surface().project(placement_.to_tool(state.position), slaves_.nodes[i].patch).normal;
    const Tensor<1, 3> a =
        tool_.control() == Tool::Control::moment
            ? dealii::cross_product_3d(tool_.rotation_axis(), state.position - placement_.moved_centre())
            : tool_.force_direction();
    const double normal = a * n;
    sum += area * stiffness_ahead(i) * normal * normal;
    if (pair_.has_friction())
      sum += area * slaves_.nodes[i].stiffness.tangential * (a * a - normal * normal);
  };
  if (is_removed_ || !tool_.is_driven())
    return sum;
  for_each_touching([&](const ContactFacet &facet, const unsigned int corner, const double area) {
    add(facet.nodes[corner], springs_of(facet.nodes[corner]).max_area(area, facet.shallow_areas[corner]));
  });
  for_each_near(add);
  return sum;
}

void RigidContact::add_tangent(const TangentSystem &system) const {
  dealii::FullMatrix<double> facet_matrix(12, 12);
  std::vector<DofIndex> dofs(12);
  for (std::size_t f = 0; f < slaves_.n_whole_facets; ++f) {
    const ContactFacet &facet = slaves_.facets[f];
    if (!compute_facet_tangent(facet, facet_matrix))
      continue;
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        dofs[3 * a + i] = slaves_.nodes[facet.nodes[a]].dofs[i];
    system.add(facet_matrix, dofs);
  }
  for (const auto &divided : slaves_.divided)
    add_divided_tangent(divided, system);
}

void RigidContact::add_divided_tangent(const DividedFacet &divided, const TangentSystem &system) const {
  dealii::FullMatrix<double> of_part(12, 12), of_facet(12, 12);
  bool touches = false;
  for (std::size_t f = divided.first_part; f < divided.first_part + divided.n_parts; ++f) {
    const ContactFacet &part = slaves_.facets[f];
    if (!compute_facet_tangent(part, of_part))
      continue;
    touches = true;
    // Weights of the facet's corners for each corner of the part.
    std::array<std::array<double, 4>, 4> weights{};
    for (unsigned int p = 0; p < 4; ++p)
      slaves_.for_each_parent(part.nodes[p], [&](const unsigned int parent, const double weight) {
        for (unsigned int a = 0; a < 4; ++a)
          if (divided.corners[a] == parent)
            weights[p][a] = weight;
      });
    for (unsigned int p = 0; p < 4; ++p)
      for (unsigned int q = 0; q < 4; ++q)
        for (unsigned int a = 0; a < 4; ++a)
          for (unsigned int b = 0; b < 4; ++b) {
            const double weight = weights[p][a] * weights[q][b];
            if (weight > 0.)
              for (unsigned int i = 0; i < 3; ++i)
                for (unsigned int j = 0; j < 3; ++j)
                  of_facet(3 * a + i, 3 * b + j) += weight * of_part(3 * p + i, 3 * q + j);
          }
  }
  if (!touches)
    return;
  std::vector<DofIndex> dofs(12);
  for (unsigned int a = 0; a < 4; ++a)
    for (unsigned int i = 0; i < 3; ++i)
      dofs[3 * a + i] = slaves_.nodes[divided.corners[a]].dofs[i];
  system.add(of_facet, dofs);
}

bool RigidContact::compute_facet_tangent(const ContactFacet &facet,
                                         dealii::FullMatrix<double> &matrix) const {
  if (!any_touches(states_of(facet)))
    return false;
  matrix = 0.;
  if (tangent_ == ContactTangent::numerical)
    add_numerical_tangent(facet, matrix);
  else
    add_closed_tangent(facet, matrix);
  return true;
}

void RigidContact::add_closed_tangent(const ContactFacet &facet, dealii::FullMatrix<double> &matrix) const {
  const bool exact = tangent_ == ContactTangent::exact;
  const ProjectedAreas areas = compute_projected_areas(states_of(facet), exact);
  for (unsigned int a = 0; a < 4; ++a) {
    const ToolContactState &state = states_[facet.nodes[a]];
    const Tensor<1, 3> turned = exact ? state.turning * areas.normal_derivatives[a] : Tensor<1, 3>();
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j) {
        matrix(3 * a + i, 3 * a + j) += areas.areas[a] * state.tangent[i][j] - state.traction[i] * turned[j];
        if (exact)
          for (unsigned int b = 0; b < 4; ++b)
            matrix(3 * a + i, 3 * b + j) -= state.traction[i] * areas.derivatives[a][b][j];
      }
  }
}

void RigidContact::add_numerical_tangent(const ContactFacet &facet,
                                         dealii::FullMatrix<double> &matrix) const {
  choose_friction(pair_.friction, [&](const auto &law) {
    FrictionHistory ignored;
    for (unsigned int b = 0; b < 4; ++b) {
      const ContactPoint &node = slaves_.nodes[facet.nodes[b]];
      const double h = 1e-7 * node.size;
      for (unsigned int j = 0; j < 3; ++j)
        for (const double sign : {1., -1.}) {
          Tensor<1, 3> position = states_[facet.nodes[b]].position;
          position[j] += sign * h;
          const ToolContactState moved = evaluate(law, facet.nodes[b], position, &ignored);
          CornerStates states = states_of(facet);
          states[b] = &moved;
          const ProjectedAreas areas = compute_projected_areas(states, false);
          for (unsigned int a = 0; a < 4; ++a)
            for (unsigned int i = 0; i < 3; ++i)
              matrix(3 * a + i, 3 * b + j) -= sign / (2. * h) * areas.areas[a] * states[a]->traction[i];
        }
    }
  });
}

void RigidContact::add_tool_push(const Placement &after, Vector &forces) const {
  for_each_area([&](const unsigned int i, const double area) {
    const ToolContactState &state = states_[i];
    const Tensor<1, 3> motion = after.to_space(placement_.to_tool(state.position)) - state.position;
    slaves_.add_to_dofs(i, area * (state.tangent * motion), forces);
  });
}

double RigidContact::add_tool_derivatives(const ToolRate &rate, Vector &column, Vector &row) const {
  double power_slope = 0.;
  dealii::FullMatrix<double> K(12, 12);
  for (const auto &facet : slaves_.facets) {
    if (!compute_facet_tangent(facet, K))
      continue;
    const ProjectedAreas areas = compute_projected_areas(states_of(facet), false);
    std::array<Tensor<1, 3>, 4> v, F;
    for (unsigned int a = 0; a < 4; ++a) {
      const ToolContactState &state = states_[facet.nodes[a]];
      v[a] = rate.translation +
             dealii::cross_product_3d(rate.rotation, state.position - placement_.moved_centre());
      F[a] = areas.areas[a] * state.traction;
    }
    for (unsigned int a = 0; a < 4; ++a) {
      Tensor<1, 3> along = dealii::cross_product_3d(rate.rotation, F[a]); // ∂F_a/∂s
      Tensor<1, 3> power = dealii::cross_product_3d(F[a], rate.rotation); // ∂P/∂u_a: ω × x · F = x · F × ω
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int b = 0; b < 4; ++b)
          for (unsigned int j = 0; j < 3; ++j) {
            along[i] += K(3 * a + i, 3 * b + j) * v[b][j];
            power[i] -= v[b][j] * K(3 * b + j, 3 * a + i);
          }
      power_slope += v[a] * along;
      // The arm rotates with the tool about a fixed centre: ω × v adds no further term.
      slaves_.add_to_dofs(facet.nodes[a], -along, column);
      slaves_.add_to_dofs(facet.nodes[a], power, row);
    }
  }
  return power_slope;
}

double RigidContact::distance_to_touch(const Tensor<1, 3> &direction) const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto &node : slaves_.nodes) {
    const ToolContactState &state = states_[static_cast<std::size_t>(&node - slaves_.nodes.data())];
    const auto projection = tool_.surface().project(placement_.to_tool(state.position), node.patch);
    const double approach = placement_.rotation * projection.normal * direction;
    if (!is_removed_ && projection.exists && approach > 1e-6)
      least = std::min(least, projection.gap / approach);
  }
  return least;
}

void RigidContact::add_resistances(const std::size_t body, std::vector<Resistance> &resistances) const {
  if (body != pair_.body)
    return;
  for (const auto &state : states_)
    if (state.status != ContactStatus::open)
      add_contact(state.position, state.normal, tool_.control() == Tool::Control::force, pair_.has_friction(),
                  resistances);
}

void RigidContact::visit_supporting(const VisitSupporting &visit) const {
  for (const auto &state : states_)
    if (state.status != ContactStatus::open)
      visit(make_supporting_point(state.position, state.normal, pair_.friction.get(), state.status,
                                  state.traction),
            pair_.body, pair_.body);
}

RigidContact::Grip RigidContact::grip(const ToolRate &rate) const {
  Grip grip;
  for_each_area([&](const unsigned int i, const double area) {
    const ToolContactState &state = states_[i];
    const Tensor<1, 3> v = rate.translation + dealii::cross_product_3d(
                                                  rate.rotation, state.position - placement_.moved_centre());
    const double along_normal = state.normal * v, force = area * state.pressure;
    const double weight = force * (v - along_normal * state.normal).norm();
    grip.touching += weight;
    grip.slipping += state.status == ContactStatus::slip ? weight : 0.;
    grip.power_of_pressure += force * along_normal;
  });
  return grip;
}

void RigidContact::commit() {
  for (std::size_t i = 0; i < slaves_.nodes.size(); ++i) {
    slaves_.nodes[i].gap_n = states_[i].gap;
    slaves_.nodes[i].is_behind = states_[i].is_behind;
    if (states_[i].is_behind)
      slaves_.nodes[i].behind_at = placement_.to_tool(states_[i].position);
    has_nodes_behind_ = has_nodes_behind_ || states_[i].is_passed;
  }
  for (std::size_t i = 0; i < slaves_.nodes.size(); ++i) {
    ContactPoint &node = slaves_.nodes[i];
    if (states_[i].status == ContactStatus::open) { // it returns without an offset
      node.gap_n += node.lift;
      node.lift = 0.;
    }
    node.lift_n = node.lift;
  }
  base_.clear();
  friction_n_ = friction_;
  remember_positions();
  if (!friction_.empty() && !is_explicit_)
    for (auto &facet : slaves_.facets) {
      const CornerStates states = states_of(facet);
      facet.friction_areas =
          any_touches(states) ? compute_projected_areas(states, false).areas : std::array<double, 4>{};
    }
  remember_pressures();
  if (is_explicit_) // only after the springs' energy is released
    for (auto &facet : slaves_.facets)
      for (unsigned int a = 0; a < 4; ++a)
        if (states_[facet.nodes[a]].status == ContactStatus::open)
          facet.shallow_areas[a] = SpringEnergy::no_area;
}

void RigidContact::remember_pressures() {
  allowed_part_n_ = allowed_part_;
  if (is_explicit_)
    return;
  knows_pressures_ = true;
  pressed_n_.resize(slaves_.nodes.size());
  for (std::size_t i = 0; i < slaves_.nodes.size(); ++i) {
    const ToolContactState &state = states_[i];
    PressureHistory &history = pressed_n_[i];
    history.pressure = state.pressure;
    // Multipliers are no penetration.
    history.depth = state.pressure > 0. ? std::max(0., -(state.gap + slaves_.nodes[i].lift)) : 0.;
    history.normal = dealii::transpose(placement_.rotation) * state.normal;
    history.position = placement_.to_tool(state.position);
  }
}

template <class NormalOf> std::vector<double> RigidContact::areas_along(const NormalOf &normal_of) const {
  std::vector<double> areas(slaves_.nodes.size(), 0.);
  for (const auto &facet : slaves_.facets) {
    const CornerStates states = states_of(facet);
    for (const auto &point : facet_points()) {
      const Tensor<1, 3> area_vector =
          point.area_vector([&](const unsigned int a) { return states[a]->position; });
      for (unsigned int a = 0; a < 4; ++a)
        areas[facet.nodes[a]] += point.N[a] * std::max(0., -(area_vector * normal_of(facet.nodes[a])));
    }
  }
  return areas;
}

StepWorks RigidContact::compute_step_works(const double weight) const {
  StepWorks works;
  const bool has_moved = !is_removed_ && knows_pressures_ &&
                         std::any_of(states_.begin(), states_.end(), [this](const ToolContactState &state) {
                           const auto i = static_cast<std::size_t>(&state - states_.data());
                           return (state.pressure > 0.) != (pressed_n_[i].pressure > 0.) ||
                                  (state.pressure > 0. && allowed_part_ != allowed_part_n_ &&
                                   slaves_.nodes[i].initial_depth > 0.);
                         });
  if (has_moved) {
    const auto normal_of = [&](const std::size_t i) {
      return states_[i].pressure > 0. ? states_[i].normal : placement_.rotation * pressed_n_[i].normal;
    };
    const std::vector<double> areas = areas_along(normal_of);
    for (std::size_t i = 0; i < slaves_.nodes.size(); ++i) {
      const ToolContactState &state = states_[i];
      const PressureHistory &before = pressed_n_[i];
      if (!(state.pressure > 0.) && !(before.pressure > 0.))
        continue;
      const double ramp_depth = (allowed_part_n_ - allowed_part_) * slaves_.nodes[i].initial_depth;
      const double closing =
          ramp_depth - normal_of(i) * (state.position - placement_.to_space(before.position));
      const double depth = state.pressure > 0. ? std::max(0., -(state.gap + slaves_.nodes[i].lift)) : 0.;
      works.add(before.pressure * areas[i], state.pressure * areas[i], before.depth, depth, closing,
                ramp_depth, weight);
    }
  }
  if (pair_.has_friction() && is_static_ && !is_removed_) // the same on all ranks
    visit_friction(presses_at_both_ends(),
                   [&](const FrictionAccount &account, const double area_n, const double area) {
                     works.touching -= account.taken_beyond(area_n, area) - account.missed(area_n);
                   });
  works.touching = dealii::Utilities::MPI::sum(works.touching, communicator_);
  works.ramp = dealii::Utilities::MPI::sum(works.ramp, communicator_);
  return works;
}

void RigidContact::restart() {
  for (auto &node : slaves_.nodes)
    node.lift = node.lift_n;
  base_.clear();
}

void RigidContact::augment() {
  Usage::count(Capability::augmentation, slaves_.nodes.size());
  augmentation_memory_.set(2 * slaves_.nodes.size() * sizeof(ContactPoint::lift));
  for (std::size_t i = 0; i < slaves_.nodes.size(); ++i)
    slaves_.nodes[i].lift = slaves_.nodes[i].is_fixed ? 0.
                            : states_[i].share == 1. ? states_[i].pressure / slaves_.nodes[i].stiffness.normal
                                                     : states_[i].share * std::max(0., -states_[i].gap);
  base_.clear();
  for (std::size_t i = 0; i < friction_.size(); ++i)
    base_.push_back(friction_n_[i].is_active && !slaves_.nodes[i].is_fixed ? friction_[i].tangential
                                                                           : friction_n_[i].tangential);
}

void RigidContact::scale_penalties(const double normal, const double tangential) {
  stiffening_ *= normal;
  tangential_stiffening_ *= tangential;
  for (auto &node : slaves_.nodes) {
    if (node.is_fixed) // only its spring gives its force
      continue;
    node.stiffness = {stiffening_ * node.given.normal, tangential_stiffening_ * node.given.tangential};
    node.lift /= normal;
    node.gap_n += node.lift_n * (1. - 1. / normal);
    node.lift_n /= normal;
  }
}

void RigidContact::stiffen_under_load(const double normal, const double tangential) {
  scale_penalties(normal, tangential);
  for (std::size_t i = 0; i < slaves_.nodes.size(); ++i) {
    ContactPoint &node = slaves_.nodes[i];
    if (node.is_fixed || !(states_[i].pressure > 0.))
      continue;
    node.initial_depth -= (1. - 1. / normal) * states_[i].gap;
    states_[i].gap /= normal;
    node.gap_n /= normal;
    if (knows_pressures_)
      pressed_n_[i].depth /= normal;
  }
}

Penetration RigidContact::penetration() const {
  Penetration deepest;
  for (std::size_t i = 0; i < slaves_.nodes.size(); ++i)
    if (states_[i].pressure > 0. && states_[i].share == 1. && !slaves_.nodes[i].is_fixed)
      deepest.add(std::abs(states_[i].gap + slaves_.nodes[i].lift), slaves_.nodes[i].size);
  return deepest;
}

double RigidContact::excessive_penetration() const {
  double largest = 0.;
  for (std::size_t i = 0; i < slaves_.nodes.size(); ++i)
    if (states_[i].pressure > 0. && states_[i].share == 1. && !slaves_.nodes[i].is_fixed)
      largest = std::max(largest, std::abs(states_[i].gap + slaves_.nodes[i].lift) / slaves_.nodes[i].reach);
  return largest;
}

double RigidContact::closing_of_new_contacts() const {
  double largest = 0.;
  if (!knows_pressures_)
    return largest;
  for (std::size_t i = 0; i < slaves_.nodes.size(); ++i) {
    const ToolContactState &state = states_[i];
    const PressureHistory &before = pressed_n_[i];
    if (state.pressure > 0. && !(before.pressure > 0.))
      largest = std::max(largest, state.normal * (placement_.to_space(before.position) - state.position) /
                                      slaves_.nodes[i].size);
  }
  return largest;
}

bool RigidContact::has_touching_nodes() const {
  return std::any_of(states_.begin(), states_.end(),
                     [](const ToolContactState &state) { return state.status != ContactStatus::open; });
}

double RigidContact::elastic_slip(const std::size_t i) const {
  if (!(states_[i].pressure > 0.) || states_[i].status != ContactStatus::stick || friction_.empty() ||
      !friction_n_[i].is_active || slaves_.nodes[i].is_fixed)
    return 0.;
  const auto &from = base_.empty() ? friction_n_[i].tangential : base_[i];
  return std::hypot(friction_[i].tangential[0] - from[0], friction_[i].tangential[1] - from[1]) /
         slaves_.nodes[i].stiffness.tangential;
}

double RigidContact::augmentation_gap() const {
  double worst = penetration().of_facet;
  for (std::size_t i = 0; i < slaves_.nodes.size(); ++i)
    worst = std::max(worst, elastic_slip(i) / slaves_.nodes[i].size);
  return worst;
}

ContactSprings RigidContact::compute_springs() const {
  ContactSprings springs;
  springs.normal.of_nodes.resize(slaves_.nodes.size());
  springs.tangential.of_nodes.resize(slaves_.nodes.size());
  for_each_counted_area([&](const unsigned int i, const double area) {
    const ToolContactState &state = states_[i];
    if (slaves_.nodes[i].is_fixed)
      return;
    springs.add(i, area * state.traction, state.normal,
                area * slaves_.nodes[i].stiffness.normal * std::abs(state.gap + slaves_.nodes[i].lift),
                area * slaves_.nodes[i].stiffness.tangential * elastic_slip(i));
  });
  return springs;
}

Tensor<1, 3> RigidContact::add_to_load(ContactLoad &load, const ContactFacet &facet,
                                       const unsigned int corner, const double area) const {
  const std::size_t i = facet.nodes[corner];
  const ToolContactState &state = states_[i];
  const SpringEnergy springs = springs_of(i);
  const double counted = springs.counted_area(area, facet.shallow_areas[corner]);
  if (!(counted > 0.))
    return {};
  const Tensor<1, 3> force = counted * state.traction;
  load.force += force;
  load.moment += dealii::cross_product_3d(state.position - placement_.moved_centre(), force);
  load.area += area;
  load.stored_energy += springs.on_areas(area, facet.shallow_areas[corner]);
  if (is_explicit_)
    load.dissipation += state.friction.dissipated(counted, counted);
  load.deepest = std::max(load.deepest, -(state.gap + slaves_.nodes[i].lift));
  return force;
}

ContactLoad RigidContact::compute_load() const {
  const bool hands_over = is_static_ && pair_.has_friction() && presses_at_both_ends();
  return sum_over_ranks(local_load(hands_over), communicator_);
}

bool RigidContact::presses_at_both_ends() const {
  const auto has_pressure = [](const auto &state) { return state.pressure > 0.; };
  const bool pressed_n = knows_pressures_ && std::any_of(pressed_n_.begin(), pressed_n_.end(), has_pressure),
             presses = std::any_of(states_.begin(), states_.end(), has_pressure);
  std::vector<int> ends{pressed_n ? 1 : 0, presses ? 1 : 0};
  dealii::Utilities::MPI::max(ends, communicator_, ends);
  return ends[0] + ends[1] == 2;
}

ContactLoad RigidContact::local_load(const bool hands_over) const {
  ContactLoad load;
  for_each_touching([&](const ContactFacet &facet, const unsigned int corner, const double area) {
    add_to_load(load, facet, corner, area);
  });
  add_friction(load, hands_over);
  return load;
}

FrictionRule RigidContact::friction_rule(const ContactPoint &node) const {
  // Multipliers do not stretch springs.
  const bool stores = !pair_.is_augmented();
  return {node.stiffness.tangential, start_weight_, is_static_, stores, stores};
}

void RigidContact::add_friction(ContactLoad &load, const bool hands_over) const {
  if (friction_.empty())
    return;
  if (is_explicit_) {
    add_released(load);
    return;
  }
  visit_friction(hands_over, [&](const FrictionAccount &account, const double area_n, const double area) {
    load.dissipation += account.dissipated(area_n, area);
    load.damping += area * account.damping;
  });
}

template <class Visit> void RigidContact::visit_friction(const bool hands_over, const Visit &visit) const {
  for (const auto &facet : slaves_.facets) {
    const CornerStates states = states_of(facet);
    const std::array<double, 4> areas =
        any_touches(states) ? compute_projected_areas(states, false).areas : std::array<double, 4>{};
    for (unsigned int a = 0; a < 4; ++a)
      visit(hands_over ? states[a]->friction.handed_over() : states[a]->friction, facet.friction_areas[a],
            areas[a]);
  }
}

void RigidContact::add_released(ContactLoad &load) const {
  const auto is_released = [](const ToolContactState &state) {
    return state.status == ContactStatus::open && state.friction.dissipation_n != 0.;
  };
  if (std::none_of(states_.begin(), states_.end(), is_released))
    return;
  for (const auto &facet : slaves_.facets) {
    const CornerStates states = states_of(facet);
    if (std::none_of(states.begin(), states.end(),
                     [&](const ToolContactState *node) { return is_released(*node); }))
      continue;
    std::array<double, 4> areas{};
    for (const auto &point : facet_points()) {
      const Tensor<1, 3> area_vector =
          point.area_vector([&](const unsigned int a) { return states[a]->position; });
      for (unsigned int a = 0; a < 4; ++a)
        areas[a] += std::max(0., -(area_vector * states[a]->normal)) * point.N[a];
    }
    for (unsigned int a = 0; a < 4; ++a)
      if (is_released(*states[a]))
        load.dissipation += springs_of(facet.nodes[a], states[a]->friction.dissipation_n)
                                .on_areas(areas[a], facet.shallow_areas[a]);
  }
}

void RigidContact::average_over_points(std::vector<ContactNodeReport> &reports) const {
  struct Sums {
    double force = 0., slipping = 0., depth = 0., curvature = 0.;
    Tensor<1, 3> traction;
  };
  std::vector<Sums> sums(slaves_.n_mesh_nodes);
  std::vector<bool> has_points(slaves_.n_mesh_nodes, false);
  for (const auto &divided : slaves_.divided)
    for (const unsigned int corner : divided.corners)
      has_points[corner] = true;
  for_each_counted_area([&](const unsigned int i, const double area) {
    const ToolContactState &state = states_[i];
    slaves_.for_each_parent(i, [&](const unsigned int parent, const double weight) {
      const double force = weight * area * state.pressure;
      sums[parent].force += force;
      sums[parent].depth = std::max(sums[parent].depth, std::abs(state.gap + slaves_.nodes[i].lift));
      sums[parent].curvature = std::max(sums[parent].curvature, largest_curvature(state.turning));
      sums[parent].slipping += state.status == ContactStatus::slip ? force : 0.;
      sums[parent].traction += weight * area * state.traction;
    });
  });
  for (std::size_t i = 0; i < slaves_.n_mesh_nodes; ++i) {
    if (!has_points[i] || !(sums[i].force > 0.))
      continue;
    reports[i].pressure = sums[i].force / reports[i].area;
    reports[i].traction = sums[i].traction / reports[i].area;
    reports[i].penetration = sums[i].depth;
    reports[i].curvature = sums[i].curvature;
    // A tool that is thin compared with the facets counts as a radius of half its thickness.
    if (thin_tool_ && thin_tool_->thickness() < 0.5 * slaves_.nodes[i].size)
      reports[i].curvature = std::max(reports[i].curvature, 2. / thin_tool_->thickness());
    reports[i].status = sums[i].slipping > 0.5 * sums[i].force ? ContactStatus::slip : ContactStatus::stick;
  }
}

std::vector<ContactNodeReport> RigidContact::report() const {
  std::vector<ContactNodeReport> reports;
  for (std::size_t i = 0; i < slaves_.n_mesh_nodes; ++i) {
    const ToolContactState &state = states_[i];
    reports.push_back({slaves_.nodes[i].dofs, state.status, state.pressure,
                       state.gap + lift_of(slaves_.nodes[i]), friction_.empty() ? 0. : friction_[i].slip, 0.,
                       state.traction, state.pressure > 0. ? std::abs(state.gap + slaves_.nodes[i].lift) : 0.,
                       slaves_.nodes[i].size, friction_.empty() ? 0. : slaves_.nodes[i].stiffness.tangential,
                       state.pressure > 0. ? largest_curvature(state.turning) : 0.});
  }
  for_each_counted_area([&](const unsigned int i, const double area) {
    slaves_.for_each_parent(
        i, [&](const unsigned int parent, const double weight) { reports[parent].area += weight * area; });
  });
  // Along the sides of long facets the tool's normal may change more than over the root of their area.
  constexpr std::array<std::array<unsigned int, 2>, 4> sides{{{0, 1}, {0, 2}, {1, 3}, {2, 3}}};
  for (const auto &facet : slaves_.facets)
    for (const auto &side : sides) {
      const unsigned int a = facet.nodes[side[0]], b = facet.nodes[side[1]];
      for (const unsigned int i : {a, b})
        if (a < slaves_.n_mesh_nodes && b < slaves_.n_mesh_nodes && states_[i].pressure > 0.)
          reports[i].curvature =
              std::max(reports[i].curvature,
                       (states_[i].turning * (states_[a].position - states_[b].position)).norm() /
                           slaves_.nodes[i].size);
    }
  if (!slaves_.divided.empty())
    average_over_points(reports);
  return reports;
}

std::size_t RigidContact::history_size() const {
  return (2 * friction_.size() * sizeof(FrictionHistory) + slaves_.nodes.size() * sizeof(double)) /
         sizeof(double);
}

} // namespace billet
