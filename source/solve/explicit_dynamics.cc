// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit_dynamics.h"

#include "billet/contact/overlap.h"
#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <numeric>
#include <sstream>

namespace billet {

using dealii::Tensor;

ExplicitFormulation make_formulation(const parameters::Scene &scene, const parameters::Body &body) {
  using Instructions = parameters::ExplicitDynamics::Instructions;
  const auto &dynamics = scene.explicit_dynamics;
  ExplicitFormulation formulation;
  formulation.element = make_formulation(body).element;
  formulation.linear_viscosity = dynamics.linear_viscosity;
  formulation.quadratic_viscosity = dynamics.quadratic_viscosity;
  switch (dynamics.instructions) {
  case Instructions::automatic:
    formulation.instructions = InstructionSet::automatic;
    break;
  case Instructions::scalar:
    formulation.instructions = InstructionSet::scalar;
    break;
  case Instructions::sse2:
    formulation.instructions = InstructionSet::sse2;
    break;
  case Instructions::avx2:
    formulation.instructions = InstructionSet::avx2;
    break;
  case Instructions::avx512:
    formulation.instructions = InstructionSet::avx512;
    break;
  }
  formulation.number_type = dynamics.number_type == parameters::ExplicitDynamics::NumberType::float_precision
                                ? ExplicitFormulation::NumberType::float_precision
                                : ExplicitFormulation::NumberType::double_precision;
  return formulation;
}

namespace {

void clear(NodalVectors &vectors, const std::vector<unsigned int> &nodes) {
  for (const unsigned int node : nodes)
    std::fill_n(&vectors[std::size_t{nodal_stride} * node], nodal_stride, 0.);
}

constexpr const char *flat_element_advice =
    "try a mesh that is finer, or of better shape, where it deforms most, or a material that hardens";

double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

} // namespace

ExplicitDynamics::ExplicitDynamics(const Scene &scene, const Discretization &discretization)
    : scene_(scene), discretization_(discretization), parameters_(scene.parameters().explicit_dynamics),
      nodes_(discretization), held_(scene, nodes_), blocks_(make_blocks()), contacts_(scene, nodes_),
      penalties_(scene, discretization, PenaltyControl::in_explicit_scenes) {
  count_memory();
  make_masses();
  for (std::size_t i = 0; i < scene.tools().size(); ++i)
    tools_.emplace_back(scene.tools()[i], scene.parameters().tools[i].motion);
  has_free_tools_ = std::any_of(tools_.begin(), tools_.end(),
                                [](const FreeTool &tool) { return tool.inverse_inertia() > 0.; });
  tool_memory_.set(
      static_cast<std::size_t>(std::count_if(tools_.begin(), tools_.end(),
                                             [](const FreeTool &tool) { return tool.wants_load(); })) *
      sizeof(FreeTool));
  tool_loads_.resize(tools_.size());
  fading_forces_.resize(tools_.size());
  u_ = v_ = v_before_ = forces_ = external_ = supports_ = bounds_ = nodes_.make_vectors();
  set_initial_motion();
  find_touched_nodes();
  if (!scene.parameters().restart.is_wanted()) // it begins with deformed bodies
    for (auto &contact : contacts_.of_bodies())
      if (contact.settings().overlap.closed_gap > 0.) {
        contact.update(u_);
        contact.allow_overlap();
      }
  state_.body_pair_loads.resize(contacts_.of_bodies().size());
  state_.tool_loads.resize(tools_.size());
  state_.placements.resize(tools_.size());
  state_.displacements = discretization.make_ghosted_vector();
  state_.velocities = discretization.make_ghosted_vector();
}

std::vector<std::unique_ptr<ExplicitBlock>> ExplicitDynamics::make_blocks() const {
  std::vector<std::unique_ptr<ExplicitBlock>> blocks;
  fail_together(discretization_.communicator(), [&] {
    for (std::size_t b = 0; b < scene_.bodies().size(); ++b) {
      const Body &body = scene_.bodies()[b];
      const auto &input = scene_.parameters().bodies[b];
      try {
        blocks.push_back(
            make_explicit_block(body.law, body.density, make_formulation(scene_.parameters(), input)));
      } catch (const std::invalid_argument &error) {
        throw InputError(input.origin + ": " + error.what());
      }
      std::size_t offender = 0;
      if (!blocks.back()->initialize(nodes_.elements(b), nodes_.positions().data(), offender)) {
        std::ostringstream message;
        message << input.origin << ": the element with its centre at ("
                << discretization_.elements(b)[offender].cell->center()
                << ") is degenerate or inside out; allowed are hexahedra with a positive Jacobian";
        throw InputError(message.str());
      }
    }
  });
  return blocks;
}

void ExplicitDynamics::count_memory() {
  std::size_t plastic = 0, stabilised = 0; // bytes
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (scene_.bodies()[b].law->has_plasticity())
      plastic += blocks_[b]->history_memory();
    stabilised += blocks_[b]->stabilisation_memory();
  }
  plastic_memory_.set(plastic);
  stabilised_memory_.set(stabilised);
}

void ExplicitDynamics::make_masses() {
  std::vector<double> local(nodes_.size(), 0.);
  for (const auto &block : blocks_)
    block->add_masses(local.data());
  loads_ = std::make_unique<ExternalLoads>(scene_, nodes_, local); // which the mass added does not feel
  const MPI_Comm communicator = discretization_.communicator();
  mass_ = dealii::Utilities::MPI::sum(std::accumulate(local.begin(), local.end(), 0.), communicator);
  if (parameters_.scaled_step > 0.) {
    double added = 0.;
    for (const auto &block : blocks_)
      added += block->scale_mass(parameters_.scaled_step / parameters_.safety_factor);
    added_mass_ = dealii::Utilities::MPI::sum(added, communicator);
    std::fill(local.begin(), local.end(), 0.);
    for (const auto &block : blocks_)
      block->add_masses(local.data());
  }
  NodalVectors sums = nodes_.make_vectors();
  for (unsigned int node = 0; node < nodes_.size(); ++node)
    sums[std::size_t{nodal_stride} * node] = local[node];
  nodes_.sum_shared(sums);
  masses_.resize(nodes_.size());
  for (unsigned int node = 0; node < nodes_.size(); ++node)
    masses_[node] = sums[std::size_t{nodal_stride} * node];
  for (const double mass : masses_)
    inverse_masses_.push_back(1. / mass);
  inertia_memory_.set(2 * masses_.size() * sizeof(double));
}

void ExplicitDynamics::find_touched_nodes() {
  bool has_accelerations = false, has_loads = false;
  has_bounds_ = !scene_.pairs().empty() || !scene_.body_pairs().empty();
  for (const auto &body : scene_.bodies())
    for (const auto &load : body.loads) {
      has_loads = true;
      has_accelerations = has_accelerations || !load.load.acts_on_faces();
      has_bounds_ = has_bounds_ || load.load.limits_steps();
    }
  // All else acts on boundaries, of elements of any rank.
  NodalVectors is_touched = nodes_.make_vectors();
  for (std::size_t b = 0; b < scene_.bodies().size(); ++b)
    for (std::size_t e = 0; e < nodes_.elements(b).size(); ++e) {
      const auto &cell = discretization_.elements(b)[e].cell;
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary())
          for (unsigned int v = 0; v < 4; ++v)
            is_touched[std::size_t{nodal_stride} *
                       nodes_.elements(b)[e][dealii::GeometryInfo<3>::face_to_cell_vertices(f, v)]] = 1.;
    }
  nodes_.sum_shared(is_touched);
  const bool may_be_loaded = has_loads || !scene_.tools().empty(); // tools fade when they are removed
  for (unsigned int node = 0; node < nodes_.size(); ++node) {
    const bool touched = is_touched[std::size_t{nodal_stride} * node] > 0.;
    if (has_accelerations || (may_be_loaded && touched))
      loaded_nodes_.push_back(node);
    if (has_bounds_ && touched)
      bounded_nodes_.push_back(node);
  }
}

void ExplicitDynamics::set_initial_motion() {
  fail_together(discretization_.communicator(), [&] {
    check_before_start([&] {
      for (std::size_t b = 0; b < blocks_.size(); ++b)
        for (const auto &element : nodes_.elements(b))
          for (const unsigned int node : element) {
            const dealii::Point<3> position(get_vector(nodes_.positions().data(), node));
            for (unsigned int i = 0; i < 3; ++i)
              v_[std::size_t{nodal_stride} * node + i] =
                  scene_.bodies()[b].initial_velocity[i].value(0., position);
          }
    });
  });
  // Where planes contradict each other it shows here, if it does at one of these times.
  const Supports supports(scene_, discretization_);
  constexpr unsigned int n_looks = 16;
  check_before_start([&] {
    for (unsigned int look = 0; look <= n_looks; ++look)
      supports.at_time(scene_.parameters().time_stepping.end_time * look / n_looks);
  });
  held_.set_displacements(0., u_);
}

SolutionFailure ExplicitDynamics::failure(const std::string &why) const {
  std::ostringstream message;
  message << scene_.parameters().file_name << ": at time " << time_ << " after " << n_steps_ << " steps "
          << why;
  return SolutionFailure(message.str());
}

void ExplicitDynamics::fail(const std::string &why) const { throw failure(why); }

void ExplicitDynamics::compute_internal_forces() {
  element_step_ = std::numeric_limits<double>::infinity();
  elastic_energy_ = hourglass_energy_ = 0.;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const auto result =
        blocks_[b]->advance({u_.data(), v_.data(), forces_.data()}, n_steps_ == 0 ? 0. : step_);
    if (result.inverted < blocks_[b]->size()) {
      dealii::Point<3> centre, at_start;
      for (const unsigned int node : nodes_.elements(b)[result.inverted]) {
        at_start += 0.125 * get_vector(nodes_.positions().data(), node);
        centre += 0.125 * (get_vector(nodes_.positions().data(), node) + get_vector(u_.data(), node));
      }
      std::ostringstream why;
      why << "element " << discretization_.elements(b)[result.inverted].cell->global_active_cell_index()
          << " of body '" << scene_.bodies()[b].name << "', which started at (" << at_start << "), is ";
      if (std::isfinite(centre.norm()))
        why << "inside out at (" << centre
            << "): try a smaller 'Safety factor', more bulk viscosity, a softer penalty or a mesh that is "
               "less "
               "distorted there";
      else
        why << "at no finite place: a velocity, a load or a penalty may be too large for its units";
      fail(why.str());
    }
    if (n_steps_ > 0 && n_steps_ % ExplicitBlock::renewal_interval == 0)
      blocks_[b]->renew(u_.data());
    const Body &body = scene_.bodies()[b];
    Usage::count_if(body.law->has_plasticity(), Capability::plasticity, blocks_[b]->size());
    Usage::count_if(body.formulation.element.is_stabilised(), Capability::stabilisation, blocks_[b]->size());
    element_step_ = std::min(element_step_, result.stable_step);
    elastic_energy_ += result.elastic_energy;
    works_.plastic += result.plastic_work;
    works_.viscous += result.viscous_work;
    hourglass_energy_ += result.hourglass_energy;
  }
}

std::vector<Placement> ExplicitDynamics::placements_of(const Placement &(FreeTool::*get)() const) const {
  std::vector<Placement> placements;
  for (const FreeTool &tool : tools_)
    placements.push_back((tool.*get)());
  return placements;
}

std::string ExplicitDynamics::compute_contact_forces() {
  std::string passage;
  std::fill(tool_loads_.begin(), tool_loads_.end(), ContactLoad());
  tool_stiffness_.assign(tools_.size(), 0.);
  const std::vector<Placement> before = placements_of(&FreeTool::before), now = placements_of(&FreeTool::now);
  // Overlaps that are allowed do not fade in explicit scenes: they have the times of the start.
  const ContactStep step{0., 0., n_steps_ == 0 ? 0. : step_, before, now};
  for (auto &contact : contacts_) {
    contact.start_step(step);
    contact.update(u_);
    if (passage.empty() && contact.lets_nodes_through())
      passage = contact.describe_passage();
    const ContactLoad load = contact.add_forces(forces_, bounds_);
    if (const auto &tool = contact.rigid_tool()) {
      tool_loads_[*tool] += load;
      if (tools_[*tool].inverse_inertia() > 0.)
        tool_stiffness_[*tool] += contact.stiffness_against_tool();
    }
    works_.friction += load.dissipation;
    contact.add_crossings(crossings_);
    contact.commit();
  }
  return passage;
}

void ExplicitDynamics::remove_tools() {
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    if (!tools_[i].is_gone(time_))
      continue;
    if (!fading_forces_[i]) {
      fading_forces_[i] = std::make_unique<NodalVectors>(nodes_.make_vectors());
      NodalVectors ignored = nodes_.make_vectors();
      for (auto &contact : contacts_.of_tools())
        if (contact.tool() == i) {
          contact.add_forces(*fading_forces_[i], ignored);
          contact.remove_tool();
        }
      // What its penalty springs held goes with it, and what it has of its own, which all ranks know.
      works_.external -= tool_loads_[i].stored_energy;
      if (dealii::Utilities::MPI::this_mpi_process(discretization_.communicator()) == 0)
        works_.external -= tools_[i].kinetic_energy();
      tools_[i].remove();
    }
    const Tool &gone = scene_.tools()[i];
    const double left =
        gone.release_time() > 0. ? 1. - (time_ - gone.removal_time()) / gone.release_time() : 0.;
    if (left > 0.)
      for (const unsigned int node : loaded_nodes_)
        add_vector(external_.data(), node, left * get_vector(fading_forces_[i]->data(), node));
  }
}

void ExplicitDynamics::raise_penalties() {
  if (!penalties_.is_used() || n_steps_ % steps_between_looks != 0)
    return;
  const MPI_Comm communicator = discretization_.communicator();
  update_ledger();
  const PenaltyControl::Energies energies =
      penalties_.measure(*this, scene_.bodies().size(), time_, communicator);
  const auto room =
      contacts_.collect([&](const auto &contact) { return penalties_.room_of(contact, communicator); });
  const std::vector<PenaltyControl::Factors> factors = penalties_.raises(energies, room);
  for (std::size_t p = 0; p < factors.size(); ++p) {
    if (!factors[p].raises())
      continue;
    const auto [normal, tangential] = factors[p];
    contacts_[p].scale_penalties(normal, tangential);
    // What compressed springs hold more is given to them. Of friction the force stays, and springs hold less.
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      works_.external +=
          (normal - 1.) * energies.of_pairs[p] - (1. - 1. / tangential) * energies.sticking[p].stored;
  }
}

void ExplicitDynamics::compute_forces() {
  clear(bounds_, bounded_nodes_);
  clear(external_, loaded_nodes_);
  crossings_ = Crossings();
  std::exception_ptr failure;
  try {
    if (late_failure_)
      std::rethrow_exception(late_failure_);
    remove_tools();
    compute_internal_forces();
    loads_->add_forces(time_, u_, v_, external_);
  } catch (const SolutionFailure &) { // of this rank
    failure = std::current_exception();
    element_step_ = -1.;
  }
  // Ranks talk to each other in it, also where one has failed.
  if (const std::string passage = compute_contact_forces(); !failure && !passage.empty()) {
    failure = std::make_exception_ptr(this->failure(passage));
    element_step_ = -1.;
  }
  const double resolution = parameters_.contact_resolution * parameters_.contact_resolution;
  for (const unsigned int node : bounded_nodes_)
    bounds_[std::size_t{nodal_stride} * node] *= resolution;
  loads_->add_bounds(bounds_);
  for (const unsigned int node : loaded_nodes_)
    add_vector(forces_.data(), node, get_vector(external_.data(), node));
  nodes_.sum_shared(forces_);
  if (has_bounds_)
    nodes_.sum_shared(bounds_);
  element_step_ = stable_step();
  if (element_step_ < 0.)
    fail_together(discretization_.communicator(), [&failure] {
      if (failure)
        std::rethrow_exception(failure);
    });
  constexpr double collapsed = 1e-5;
  if (free_step_ < collapsed * first_free_step_) {
    std::ostringstream why;
    why << describe_flat_elements() << ". So the run would hardly end: " << flat_element_advice;
    fail(why.str());
  }
  crossing_step_ = crossing_step();
}

double ExplicitDynamics::tools_share() const {
  // Springs k_i, between nodes that move by u_i along a_i and a tool that moves by s, hold
  //   k_i (u_i − s)² <= k_i (1/m_i + Σ_j k_j/(k_i M)) (m_i u_i² + k_i/(Σ_j k_j) M s²),
  // so that ω² <= max k_i/m_i + Σ_j k_j/M: the second is the tool's share. With a_i·a_i in k_i of the tool.
  std::vector<double> sums(tool_stiffness_.size());
  dealii::Utilities::MPI::sum(tool_stiffness_, discretization_.communicator(), sums);
  double share = 0.;
  for (std::size_t i = 0; i < tools_.size(); ++i)
    share = std::max(share, tools_[i].inverse_inertia() * sums[i]);
  return parameters_.contact_resolution * parameters_.contact_resolution * share;
}

double ExplicitDynamics::stable_step() {
  // ω² <= ω_e² + max Σ k/m by Gershgorin, and with damping ω² Δt²/4 + Δt c/(2 m) <= 1.
  double stiffest = 0., most_damped = 0.;
  for (const unsigned int node : bounded_nodes_) {
    const double *of_node = &bounds_[std::size_t{nodal_stride} * node];
    stiffest = std::max(stiffest, of_node[0] * inverse_masses_[node]);
    most_damped = std::max(most_damped, of_node[1] * inverse_masses_[node]);
  }
  // Each over all ranks before they are put together: else the step would depend on which rank has what.
  std::array<double, 3> bounds{element_step_, -stiffest, -most_damped};
  MPI_Allreduce(MPI_IN_PLACE, bounds.data(), 3, MPI_DOUBLE, MPI_MIN, discretization_.communicator());
  if (bounds[0] < 0.)
    return bounds[0];
  free_step_ = bounds[0];
  if (first_free_step_ == 0.)
    first_free_step_ = free_step_;
  if (has_free_tools_)
    bounds[1] -= tools_share();
  const double a = 1. / (bounds[0] * bounds[0]) - 0.25 * bounds[1], b = -0.5 * bounds[2];
  return 2. / (b + std::sqrt(b * b + 4. * a));
}

double ExplicitDynamics::crossing_step() const {
  constexpr double allowed = 0.0025; // of the energy
  if (contacts_.empty())
    return std::numeric_limits<double>::infinity();
  const MPI_Comm communicator = discretization_.communicator();
  Crossings crossings = crossings_;
  double step = step_;
  if (n_steps_ == 0) { // no node has gone anywhere yet
    step = element_step_;
    for (const auto &contact : contacts_)
      contact.add_start_crossings(crossings, v_, step);
    const bool tools_move =
        std::any_of(tools_.begin(), tools_.end(), [step](const FreeTool &tool) { return tool.moves(step); });
    const bool moves =
        tools_move || std::any_of(v_.begin(), v_.end(), [](const double v) { return v != 0.; });
    double near = 0.; // bounds on what facets would do
    for (const unsigned int node : bounded_nodes_)
      near = std::max(near, bounds_[std::size_t{nodal_stride} * node]);
    // The first step shows how fast facets, or tools, come nearer.
    if ((!contacts_.of_bodies().empty() || tools_move) &&
        dealii::Utilities::MPI::max(near > 0. ? 1 : 0, communicator) *
                dealii::Utilities::MPI::max(moves ? 1 : 0, communicator) >
            0)
      return 0.;
  }
  const double springs = dealii::Utilities::MPI::sum(crossings.springs, communicator);
  if (!(springs > 0.))
    return std::numeric_limits<double>::infinity();
  double fastest = crossings.way / step;
  if (n_steps_ == 0) // bodies that slide along a tool are not at rest, whatever round-off makes of v n
    for (std::size_t node = 0; node < masses_.size(); ++node)
      fastest = std::max(fastest, get_vector(v_.data(), static_cast<unsigned int>(node)).norm());
  const double speed = dealii::Utilities::MPI::max(fastest, communicator);
  const double energy = std::max(energy_of_steps_, 0.5 * (mass_ + added_mass_) * speed * speed);
  return step * std::sqrt(allowed * energy / (0.125 * springs));
}

void ExplicitDynamics::choose_step(const double event) {
  // Energies are kept best by equal steps, and by steps that change slowly, whatever asks for the change.
  // What a change of the step by a part p costs goes with p (ω Δt)²: short steps may grow faster.
  constexpr double growth = 0.02, largest_growth = 2., short_step = 0.9, long_step = 0.99;
  constexpr double rounding = 1e-9; // a remainder that is so much too long is one step
  constexpr double shortest = 0.25; // part of the stable step, for what comes through surfaces
  const double stable = step_factor_ * parameters_.safety_factor * element_step_;
  const double allowed = std::min(stable, std::max(step_factor_ * crossing_step_, shortest * stable));
  const double length = step_ / allowed;
  const double largest =
      n_steps_ > 0 ? std::min(allowed, std::min(largest_growth, 1. + growth / (length * length)) * step_)
                   : allowed;
  const double remaining = event - time_;
  const double n = std::max(1., std::ceil(remaining / largest * (1. - rounding)));
  const double fresh = remaining / n;
  is_growing_ = step_ < (is_growing_ ? long_step : short_step) * allowed;
  const bool is_planned = n_planned_ > 0 && event_ == event && step_ <= allowed;
  // Near the event, n steps may have to be shorter than those planned: then these are kept.
  if (is_planned && !(is_growing_ && fresh > step_)) {
    --n_planned_;
    return;
  }
  event_ = event;
  step_ = fresh;
  n_planned_ = static_cast<unsigned int>(std::min(n, 1e9)) - 1;
  if (!(time_ + step_ > time_) || !(n < 1e15)) {
    std::ostringstream why;
    why << "the stable step, " << largest
        << ", is too short for the clock: is an element nearly flat, a density tiny or a penalty huge? 'Mass "
           "scaling "
           "step' makes it longer";
    fail(why.str());
  }
}

void ExplicitDynamics::kick() {
  Usage::count(Capability::inertia, inverse_masses_.size());
  const bool is_first = n_steps_ == 0;
  const double half_sum = is_first ? step_ : 0.5 * (step_before_ + step_);
  // At the start v_ is v_0, and v_{−½} follows below.
  const double weight = is_first ? 0.5 * step_ : half_sum;
  std::swap(v_, v_before_);
  double *v = v_.data(), *forces = forces_.data();
  const double *v_before = v_before_.data();
  for (const double inverse_mass : inverse_masses_) {
    const double factor = weight * inverse_mass;
    for (unsigned int i = 0; i < nodal_stride; ++i) {
      v[i] = v_before[i] + factor * forces[i];
      forces[i] = 0.; // now, while it is in the cache, for the next step
    }
    v += nodal_stride;
    v_before += nodal_stride;
    forces += nodal_stride;
  }
  clear(supports_, held_.nodes());
  try {
    held_.constrain(time_, step_, u_, masses_, v_, supports_);
  } catch (const SolutionFailure &) { // of this rank; the others do not know, and the next forces tell them
    late_failure_ = std::current_exception();
  }
  for (const unsigned int node : held_.nodes())
    for (unsigned int i = 0; i < 3; ++i)
      supports_[std::size_t{nodal_stride} * node + i] /= weight;
  if (is_first)
    for (std::size_t k = 0; k < v_.size(); ++k)
      v_before_[k] = 2. * v_before_[k] - v_[k];
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const ContactLoad load = tools_[i].wants_load()
                                 ? sum_over_ranks(tool_loads_[i], discretization_.communicator())
                                 : ContactLoad();
    Usage::count_if(tools_[i].wants_load(), Capability::driven_tools, 1);
    tools_[i].kick(time_, load, step_before_, step_, is_first);
  }
}

void ExplicitDynamics::add_works(const NodalVectors &v, const double half) {
  const bool is_first_rank = dealii::Utilities::MPI::this_mpi_process(discretization_.communicator()) == 0;
  const auto power = [&v](const NodalVectors &forces, const unsigned int node) {
    const std::size_t k = std::size_t{nodal_stride} * node;
    return dot(&forces[k], &v[k]);
  };
  for (const unsigned int node : loaded_nodes_)
    works_.external += half * power(external_, node);
  for (const unsigned int node : held_.nodes())
    if (nodes_.is_owned(node))
      works_.external += half * power(supports_, node);
  for (std::size_t i = 0; i < tools_.size(); ++i)
    if (!tools_[i].is_gone(time_))
      works_.external += tools_[i].motion_work(tool_loads_[i]) + (is_first_rank ? tools_[i].load_work() : 0.);
}

void ExplicitDynamics::prepare_step(const double event) {
  compute_forces();
  step_before_ = step_;
  choose_step(event);
  kick();
  if (n_steps_ > 0)
    add_works(v_before_, 0.5 * step_before_);
}

void ExplicitDynamics::finish_step() {
  raise_penalties(); // the ledger of this time has been looked at: what is given to springs shows in the next
                     // one
  for (std::size_t k = 0; k < u_.size(); ++k)
    u_[k] += step_ * v_[k];
  for (auto &tool : tools_)
    tool.move(time_, step_);
  add_works(v_, 0.5 * step_);
  time_before_ = time_;
  time_ = n_planned_ == 0 ? event_ : time_ + step_;
  ++n_steps_;
}

void ExplicitDynamics::update_state() {
  update_ledger();
  nodes_.copy(u_, state_.displacements);
  NodalVectors v = v_;
  for (std::size_t k = 0; k < v.size(); ++k)
    v[k] = 0.5 * (v_[k] + v_before_[k]);
  nodes_.copy(v, state_.velocities);
}

void ExplicitDynamics::update_ledger() {
  const MPI_Comm communicator = discretization_.communicator();
  state_.time = time_;
  enum {
    kinetic,
    elastic,
    plastic,
    contact,
    friction,
    viscous,
    hourglass,
    external,
    momentum,
    angular = momentum + 3
  };
  std::vector<double> own(angular + 3, 0.);
  double extent = 0.;
  for (unsigned int node = 0; node < nodes_.size(); ++node) {
    if (!nodes_.is_owned(node))
      continue;
    const std::size_t k = std::size_t{nodal_stride} * node;
    own[kinetic] += 0.5 * masses_[node] * dot(&v_[k], &v_before_[k]);
    const Tensor<1, 3> p =
        0.5 * masses_[node] * (get_vector(v_.data(), node) + get_vector(v_before_.data(), node));
    const Tensor<1, 3> x = get_vector(nodes_.positions().data(), node) + get_vector(u_.data(), node);
    const Tensor<1, 3> L = dealii::cross_product_3d(x, p);
    extent = std::max({extent, std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
    for (unsigned int i = 0; i < 3; ++i) {
      own[momentum + i] += p[i];
      own[angular + i] += L[i];
    }
  }
  own[elastic] = elastic_energy_;
  own[plastic] = works_.plastic;
  for (const auto &load : tool_loads_)
    own[contact] += load.stored_energy;
  own[friction] = works_.friction;
  own[viscous] = works_.viscous;
  own[hourglass] = hourglass_energy_;
  own[external] = works_.external;
  std::vector<double> totals(own.size());
  dealii::Utilities::MPI::sum(own, communicator, totals);
  extent_ = dealii::Utilities::MPI::max(extent, communicator);

  EnergyLedger &energies = state_.energies;
  energies.kinetic = totals[kinetic];
  energies.elastic = totals[elastic];
  energies.plastic = totals[plastic];
  energies.contact = totals[contact];
  energies.friction = totals[friction];
  energies.viscous = totals[viscous];
  energies.hourglass = totals[hourglass];
  energies.external = totals[external];
  for (unsigned int i = 0; i < 3; ++i) {
    state_.momentum[i] = totals[momentum + i];
    state_.angular_momentum[i] = totals[angular + i];
  }
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    energies.kinetic += tools_[i].kinetic_energy();
    state_.momentum += tools_[i].momentum();
    state_.angular_momentum += tools_[i].angular_momentum();
    state_.tool_loads[i] = sum_over_ranks(tool_loads_[i], communicator);
    state_.placements[i] = tools_[i].now();
  }
  for (std::size_t i = 0; i < contacts_.of_bodies().size(); ++i) {
    state_.body_pair_loads[i] = contacts_.of_bodies()[i].compute_load();
    energies.contact += state_.body_pair_loads[i].stored_energy;
  }
  if (n_steps_ == 0)
    energies.initial = energies.total() - energies.external;
  // What is there counts half only: energy that came from nowhere must not hide itself.
  const double energy = std::max(0.5 * energies.total(), std::abs(energies.initial + energies.external));
  largest_energy_ = std::max(largest_energy_, energy);
  if (n_steps_ % steps_between_looks == 0) // steps must not depend on when else somebody looks
    energy_of_steps_ = std::max(energy_of_steps_, energy);
}

DiagnosticList ExplicitDynamics::check_penalties() {
  DiagnosticList messages = penalties_.take_diagnostics();
  // Of all ranks: the largest displacement, and for each pair how deep it is, in facet sizes and as length.
  std::vector<double> maxima(1);
  for (unsigned int node = 0; node < nodes_.size(); ++node)
    maxima[0] = std::max(maxima[0], get_vector(u_.data(), node).norm());
  for (const auto &contact : contacts_) {
    const Penetration deepest = contact.penetration();
    maxima.insert(maxima.end(), {deepest.of_facet, deepest.length});
  }
  dealii::Utilities::MPI::max(maxima, discretization_.communicator(), maxima);

  const EnergyLedger &energies = state_.energies;
  const double part = energies.total() > 0. ? energies.contact / energies.total() : 0.; // of all pairs
  auto next = maxima.begin() + 1;
  for (const auto &contact : contacts_) {
    double moved = maxima[0];
    if (const auto &tool = contact.rigid_tool())
      moved = std::max(moved, largest_motion(scene_.tools()[*tool].placement(0.), tools_[*tool].now(),
                                             discretization_.radius()));
    append(messages, soft_penalties_.check(contact.name(), time_, {next[0], next[1]}, moved, part));
    next += 2;
    append(messages, contact.check_step());
  }
  return messages;
}

std::string ExplicitDynamics::describe_flat_elements() const {
  std::ostringstream text;
  text.precision(3);
  text << "the stable step of the elements has fallen to " << free_step_ << ", from " << first_free_step_
       << " at the start, as one is nearly flat";
  return text.str();
}

DiagnosticList ExplicitDynamics::check_steps() const {
  constexpr double much_shorter = 0.1, flat = 0.01;
  DiagnosticList messages;
  if (element_step_ < much_shorter * free_step_) {
    std::vector<double> room = // by pair, on all ranks
        contacts_.collect([](const auto &contact) { return contact.stiffening_left(); });
    dealii::Utilities::MPI::min(room, discretization_.communicator(), room);
    const auto stiffest = std::min_element(room.begin(), room.end());
    const auto i = static_cast<std::size_t>(stiffest - room.begin());
    if (stiffest != room.end() && *stiffest < 1. && contacts_[i].settings().input->has_own_penalty) {
      std::ostringstream text;
      text.precision(3);
      text << "The penalty, " << enough_penalty / *stiffest << " E/h, makes steps "
           << std::round(free_step_ / element_step_) << " times shorter than the elements require";
      messages.push_back(Diagnostic(diagnostic::penalty_too_high, text.str())
                             .pair(contacts_[i].name())
                             .time(time_)
                             .value("penalty [E/h]", enough_penalty / *stiffest));
    }
  }
  if (free_step_ < flat * first_free_step_) {
    std::string text = describe_flat_elements();
    text.front() = 'T';
    messages.push_back(Diagnostic(diagnostic::flat_elements, text)
                           .time(time_)
                           .value("stable step", free_step_)
                           .advice(flat_element_advice));
  }
  return messages;
}

double ExplicitDynamics::smallest_energy() const {
  const double rounding = std::numeric_limits<double>::epsilon() * extent_;
  const double rate = 2. / element_step_ * 2. * rounding / std::min(parameters_.largest_drift, 1.);
  return 0.5 * (mass_ + added_mass_) * rate * rate;
}

double ExplicitDynamics::relative_drift() const {
  const double scale = std::max(largest_energy_, smallest_energy());
  return scale > 0. ? state_.energies.drift() / scale : 0.;
}

std::vector<ElementSummary> ExplicitDynamics::summarize(const std::size_t body) const {
  std::vector<ElementSummary> summaries;
  for (std::size_t e = 0; e < blocks_[body]->size(); ++e)
    summaries.push_back(blocks_[body]->summarize(e, u_.data()));
  return summaries;
}

std::vector<std::vector<ContactNodeReport>> ExplicitDynamics::report_contacts() const {
  return contacts_.report();
}

std::array<std::size_t, 2> ExplicitDynamics::history_sizes() const {
  std::array<std::size_t, 2> sizes{};
  for (const auto &block : blocks_)
    sizes[0] += block->history_memory() / sizeof(double);
  sizes[1] = contacts_.history_size();
  for (auto &size : sizes)
    size = dealii::Utilities::MPI::sum(size, discretization_.communicator());
  return sizes;
}

std::string ExplicitDynamics::method() const {
  return parameters_.number_type == parameters::ExplicitDynamics::NumberType::float_precision
             ? "central differences, elements in float"
             : "central differences";
}

} // namespace billet
