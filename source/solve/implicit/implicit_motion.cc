// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/implicit_motion.h"

#include "billet/errors.h"
#include "billet/fail_together.h"
#include "billet/usage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace billet {

using dealii::Tensor;

namespace {

struct ImplicitMotionLimits {
  /// Error of each displacement or offset, as multiple of its last bit.
  static constexpr double last_bits = 10.;
};

bool is_lumped(const Scene &scene) {
  return scene.parameters().implicit_dynamics.mass == parameters::ImplicitDynamics::Mass::lumped;
}

/// Sets the initial velocities of the scene. Throws InputError. Collective.
void set_initial_velocities(const Scene &scene, const LocalNodes &nodes, Vector &velocities) {
  const Discretization &discretization = nodes.discretization();
  fail_together(discretization.communicator(), [&] {
    check_before_start([&] {
      for (std::size_t b = 0; b < discretization.n_bodies(); ++b)
        for (const auto &element : nodes.elements(b))
          for (const unsigned int node : element)
            for (unsigned int i = 0; i < 3; ++i) {
              const DofIndex dof = nodes.dofs(node)[i];
              if (discretization.owned_dofs().is_element(dof))
                velocities(dof) = scene.bodies()[b].initial_velocity[i].value(
                    0., dealii::Point<3>(get_vector(nodes.positions().data(), node)));
            }
    });
  });
  velocities.compress(dealii::VectorOperation::insert);
}

} // namespace

ImplicitMotion::ImplicitMotion(const Scene &scene, const Discretization &discretization,
                               const Supports &supports)
    : scene_(scene), discretization_(discretization), supports_(supports),
      integrator_(scene.parameters().implicit_dynamics.integrator), nodes_(discretization),
      mass_(scene, discretization, supports, is_lumped(scene)), start_{discretization.make_owned_vector(),
                                                                       discretization.make_owned_vector()},
      damping_(mass_, integrator_, start_.acceleration), tools_(scene, integrator_, damping_),
      loads_(scene, discretization, nodes_,
             [this](const LocalNodes &nodes) { return mass_.inertia().nodal_masses(nodes); }),
      held_(scene, discretization, supports),
      error_(scene, discretization, nodes_, mass_.inertia(), mass_.row_sums()) {
  step_.u_n = discretization.make_owned_vector();
  set_initial_velocities(scene, nodes_, start_.velocity);
  check_before_start([&] { held_.start(0., scene.parameters().time_stepping.initial_step); });
  supports_.homogeneous().distribute(start_.velocity);
  start_.velocity += held_.at_start().velocity;
  trial_ = start_;
  constexpr std::size_t n_fields =
      13; // displacements, velocities, accelerations, forces and rates of both ends
  memory_.set(n_fields * discretization.owned_dofs().n_elements() * sizeof(double));
}

ImplicitMotion::~ImplicitMotion() = default;

Vector ImplicitMotion::end_accelerations() const {
  Vector result = trial_.acceleration;
  damping_.complete(result);
  return result;
}

Vector ImplicitMotion::driving_forces(const Vector &forces) const {
  Vector result = mass_.times(held_.at_start().acceleration);
  result += forces;
  result *= -1.;
  return result;
}

void ImplicitMotion::set_accelerations(const Vector &accelerations) {
  start_.acceleration = accelerations;
  start_.acceleration += held_.at_start().acceleration;
}

void ImplicitMotion::start_step(const double t_n, const double t, const Vector &displacements,
                                const std::vector<double> &offsets) {
  if (step_.t_n == t_n && step_.length == t - t_n)
    return;
  Usage::count(Capability::inertia, displacements.locally_owned_size());
  step_.t_n = t_n;
  step_.length = t - t_n;
  step_.u_n = displacements;
  tools_.start_step(step_.length, offsets);
  held_.start_step(t_n, t);
  const double last_bit = ImplicitMotionLimits::last_bits * std::numeric_limits<double>::epsilon() *
                          integrator_.mass_factor(step_.length);
  const double n_nodes = static_cast<double>(discretization_.dof_handler().n_dofs()) / 3.;
  step_.round_off_force = last_bit * mass_.inertia().total() / std::sqrt(n_nodes) *
                          std::max(displacements.linfty_norm(), step_.length * start_.velocity.linfty_norm());
  step_.round_off_force += tools_.round_off_force(last_bit, discretization_.radius());
}

void ImplicitMotion::extrapolate(Vector &displacements, std::vector<double> &offsets) const {
  displacements.add(step_.length, start_.velocity, 0.5 * step_.length * step_.length, start_.acceleration);
  tools_.extrapolate(offsets);
}

void ImplicitMotion::set_rates(const Vector &displacements) {
  Vector increment = displacements;
  increment -= step_.u_n;
  const auto set = [&](const TimeIntegrator::Rate &weights, const Vector &held, Vector &rate) {
    rate = increment;
    rate *= weights.increment;
    rate.add(weights.velocity, start_.velocity, weights.acceleration, damping_.start_accelerations());
    held_.prescribe(held, rate);
  };
  set(integrator_.velocity(step_.length), held_.at_end().velocity, trial_.velocity);
  set(integrator_.acceleration(step_.length), held_.at_end().acceleration, trial_.acceleration);
}

double ImplicitMotion::add_loads(const double t, const Vector &displacements, Vector &residual) {
  if (step_.length > 0.)
    set_rates(displacements);
  return loads_.subtract(t, displacements, trial_.velocity, residual);
}

double ImplicitMotion::complete(const Vector &contact, Vector &residual) const {
  residual.add(damping_.at_end() - 1., contact);
  if (step_.length == 0.)
    return 0.;
  Vector weighted = trial_.acceleration;
  weighted *= integrator_.inertia_now();
  weighted.add(integrator_.inertia_before(), damping_.start_accelerations());
  const Vector inertia = mass_.times(weighted);
  residual += inertia;
  if (integrator_.forces_before() != 0.)
    residual.add(integrator_.forces_before(), damping_.start_forces());
  return inertia.l2_norm();
}

bool ImplicitMotion::follow_loads(const double t, const bool velocities_jump, Vector &forces) {
  if (!velocities_jump && !loads_.jump_at(t))
    return false;
  forces -= loads_.start_after(t, start_.velocity);
  return true;
}

void ImplicitMotion::add_end_inertia(Vector &residual) const {
  residual += mass_.times(step_.length > 0. ? end_accelerations() : start_.acceleration);
}

void ImplicitMotion::add_tangent(const double t, const TangentSystem &system) const {
  mass_.inertia().add_tangent(integrator_.mass_factor(step_.length), system);
  loads_.add_tangent(t, integrator_.damping_factor(step_.length), system);
}

double ImplicitMotion::step_error(const Vector &displacements) const {
  if (!error_.is_wanted())
    return 0.;
  Vector change = end_accelerations();
  change -= start_.acceleration;
  return error_.of_step(integrator_.error_factor() * step_.length * step_.length, change, displacements);
}

std::vector<LoadResult> ImplicitMotion::commit(const Vector &displacements, const Vector &increment,
                                               const Vector &mean_forces, const double /*touching*/,
                                               EnergyLedger &energies) {
  // With p = M Δv and the mean forces F̄, the part of v̄·p + F̄·Δu on prescribed motions is the
  // supports' work. The rest, with opposite sign, is the dissipation of the integrator.
  Vector change = trial_.velocity, mean_velocity = trial_.velocity;
  change -= start_.velocity;
  mean_velocity += start_.velocity;
  mean_velocity *= 0.5;
  Vector held_velocity = held_.at_start().velocity;
  held_velocity += held_.at_end().velocity;
  held_velocity *= 0.5;
  const Vector impulse = mass_.times(change);
  const double support_work = held_velocity * impulse + held_.change() * mean_forces;
  energies.external += support_work;
  energies.numerical -= mean_velocity * impulse + increment * mean_forces - support_work;
  energies.external += loads_.commit(increment);
  start_.velocity = trial_.velocity;
  start_.acceleration = end_accelerations();
  held_.commit();
  error_.commit(displacements);
  return loads_.results();
}

double ImplicitMotion::follow_supports(const double t) {
  const auto kinetic_energy = [this] { return 0.5 * (start_.velocity * mass_.times(start_.velocity)); };
  const double before = kinetic_energy();
  held_.start(t, step_.length > 0. ? step_.length : scene_.parameters().time_stepping.initial_step);
  supports_.homogeneous().distribute(start_.velocity);
  start_.velocity += held_.at_start().velocity;
  trial_.velocity = start_.velocity;
  return kinetic_energy() - before;
}

void ImplicitMotion::update_state(SolutionState &state) const {
  state.velocities = discretization_.make_ghosted_vector();
  state.velocities = start_.velocity;
  const Vector momenta = mass_.inertia().times(state.velocities);
  std::array<double, 6> own{};
  for (unsigned int node = 0; node < nodes_.size(); ++node) {
    const auto &dofs = nodes_.dofs(node);
    if (!discretization_.owned_dofs().is_element(dofs[0]))
      continue;
    Tensor<1, 3> x = get_vector(nodes_.positions().data(), node), p;
    for (unsigned int i = 0; i < 3; ++i) {
      x[i] += state.displacements(dofs[i]);
      p[i] = momenta(dofs[i]);
    }
    const Tensor<1, 3> L = dealii::cross_product_3d(x, p);
    for (unsigned int i = 0; i < 3; ++i) {
      own[i] += p[i];
      own[3 + i] += L[i];
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, own.data(), 6, MPI_DOUBLE, MPI_SUM, discretization_.communicator());
  for (unsigned int i = 0; i < 3; ++i) {
    state.momentum[i] = own[i];
    state.angular_momentum[i] = own[3 + i];
  }
  state.energies.kinetic = 0.5 * (start_.velocity * momenta);
  tools_.add_to(state);
}

void ImplicitMotion::save(StateWriter &writer, const OwnedNodes &nodes) const {
  save_nodal(writer, "velocities", nodes, start_.velocity);
  save_nodal(writer, "accelerations", nodes, start_.acceleration);
  loads_.save(writer, nodes);
  save_nodal(writer, "held velocities", nodes, held_.at_start().velocity);
  save_nodal(writer, "held accelerations", nodes, held_.at_start().acceleration);
  error_.save(writer);
}

void ImplicitMotion::load(const StateReader &reader, const OwnedNodes &nodes) {
  load_nodal(reader, "velocities", nodes, start_.velocity);
  load_nodal(reader, "accelerations", nodes, start_.acceleration);
  loads_.load(reader, nodes);
  SupportRates::Rates held = held_.at_start();
  load_nodal(reader, "held velocities", nodes, held.velocity);
  load_nodal(reader, "held accelerations", nodes, held.acceleration);
  held_.set_start(held);
  error_.load(reader);
  trial_ = start_;
}

void ImplicitMotion::begin(const StateReader &reader, const OwnedNodes &nodes, const double t) {
  if (reader.has("velocities"))
    load_nodal(reader, "velocities", nodes, start_.velocity);
  if (!refined_bodies(reader).empty()) { // the run goes on
    loads_.load(reader, nodes);
    error_.load(reader);
  }
  held_.start(t, scene_.parameters().time_stepping.initial_step);
  supports_.homogeneous().distribute(start_.velocity);
  start_.velocity += held_.at_start().velocity;
  trial_.velocity = start_.velocity;
}

} // namespace billet
