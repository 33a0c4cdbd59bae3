// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/implicit_problem.h"

#include "billet/discretization/boundary_facets.h"
#include "billet/errors.h"
#include "billet/solve/implicit/statics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace billet {

namespace {

struct ImplicitProblemLimits {
  /// Force by round-off of displacements over that by the last bit of a displacement of the scene's
  /// size.
  static constexpr double last_bits = 100.;
  /// Part of a correction below which it is useless.
  static constexpr double min_part = 1e-3;
};

/// Makes the motion of a dynamic scene; null for a static one. Throws InputError if prescribed
/// displacements contradict each other.
std::unique_ptr<ImplicitMotion> make_motion(const Scene &scene, const Discretization &discretization,
                                            const Supports &supports) {
  check_agreement(scene, discretization);
  if (scene.parameters().scheme().has_inertia)
    return std::make_unique<ImplicitMotion>(scene, discretization, supports);
  return nullptr;
}

/// Makes what time adds to a static scene; null for a dynamic one.
std::unique_ptr<ImplicitScheme> make_statics(const Scene &scene, const Discretization &discretization) {
  if (scene.parameters().scheme().has_inertia)
    return nullptr;
  const auto &bodies = scene.bodies();
  if (std::any_of(bodies.begin(), bodies.end(), [](const Body &body) { return !body.loads.empty(); }))
    return std::make_unique<Statics>(scene, discretization);
  return std::make_unique<ImplicitScheme>();
}

/// Returns the stiffness of all springs of a load on a surface of a body [force/length].
/// Collective.
double find_surface_stiffness(const AppliedLoad &load, const Discretization &discretization,
                              const std::size_t body, const double young_modulus) {
  const auto *action = std::get_if<std::shared_ptr<const SurfaceLoad>>(&load.load.action);
  if (action == nullptr || load.nodes) // a moment on nodes has no springs
    return 0.;
  std::vector<double> sums(2, 0.); // area and number of faces
  for (const auto &facet : collect_boundary_facets(discretization, body, load.boundary_ids)) {
    sums[0] += facet.area_vector().norm();
    sums[1] += 1.;
  }
  dealii::Utilities::MPI::sum(sums, discretization.communicator(), sums);
  LoadedSurface surface;
  surface.stiffness = young_modulus / std::sqrt(sums[0] / sums[1]);
  return (*action)->bound(surface).stiffness * sums[0];
}

/// Returns a hundred times the force by the last bit of a displacement of the scene's size.
/// Collective.
double find_round_off_force(const Scene &scene, const Discretization &discretization) {
  double stiffest = 0.; // [force/length]
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    const Body &body = scene.bodies()[b];
    stiffest = std::max(stiffest, body.max_modulus * discretization.radius());
    for (const AppliedLoad &load : body.loads)
      stiffest = std::max(stiffest, find_surface_stiffness(load, discretization, b, body.young_modulus));
  }
  return ImplicitProblemLimits::last_bits * std::numeric_limits<double>::epsilon() * stiffest *
         discretization.radius();
}

} // namespace

ImplicitParts::ImplicitParts(const Scene &scene, const Discretization &discretization)
    : scene_(scene), discretization_(discretization), supports_(scene, discretization),
      internal_(scene, discretization), contacts_(scene, discretization),
      statics_(make_statics(scene, discretization)), motion_(make_motion(scene, discretization, supports())),
      tools_(scene, discretization, supports(), contacts_, scheme()),
      removal_(scene, discretization, contacts_), stabilisation_(scene, discretization),
      tangent_(scene, discretization, supports(), contacts_) {
  if (contacts_.of_bodies().empty()) // else once the contacts are known
    tangent_.build();
}

ImplicitParts::~ImplicitParts() = default;

ImplicitProblem::ImplicitProblem(const Scene &scene, const Discretization &discretization)
    : parts_(scene, discretization), step_(discretization),
      raw_internal_(discretization.make_additive_vector()),
      raw_contact_(discretization.make_additive_vector()) {
  scales_.round_off = find_round_off_force(scene, discretization);
  scales_.spring_round_off = parts_.contacts().find_spring_round_off();
  state_.body_pair_loads.resize(parts_.contacts().of_bodies().size());
  state_.tool_loads.resize(scene.tools().size());
  for (const auto &tool : scene.tools())
    state_.placements.push_back(tool.placement(0.));
  // Prescribed displacements hold at time 0, too.
  parts_.supports().at_time(0.).distribute(step_.start.displacements);
  state_.displacements = discretization.make_ghosted_vector();
  state_.displacements = step_.start.displacements;
}

ImplicitProblem::~ImplicitProblem() = default;

bool ImplicitProblem::on_all_ranks(const bool success) const {
  return dealii::Utilities::MPI::min(success ? 1 : 0, parts_.communicator()) == 1;
}

void ImplicitProblem::set_trial(const Vector &x) {
  parts_.tools().unpack(x, step_.trial.displacements);
  step_.ghosted = step_.trial.displacements;
  if (!parts_.tools().unknown().empty())
    parts_.tools().place_contacts(step_.time);
}

bool ImplicitProblem::compute_residual(const Vector &x, Vector &residual) {
  set_trial(x);
  raw_internal_ = 0.;
  raw_contact_ = 0.;
  if (!on_all_ranks(parts_.internal().assemble_forces(step_.ghosted, raw_internal_)))
    return false;
  raw_internal_.compress(dealii::VectorOperation::add);
  parts_.contacts().update(step_.ghosted, raw_contact_);
  raw_contact_.compress(dealii::VectorOperation::add);
  if (judge_)
    if (const std::string why = judge_(); !why.empty()) {
      obstacle_ = why;
      return false;
    }

  ForceState &trial = step_.trial;
  const auto measure = [this](const double force) { scales_.force = std::max(scales_.force, force); };
  trial.internal = raw_internal_;
  trial.contact = raw_contact_;
  scales_.force = trial.internal.l2_norm();
  const double contact_size = trial.contact.l2_norm();
  scales_.contact_bears = contact_size > 0.;
  measure(contact_size);
  Vector total = trial.internal;
  total += trial.contact;
  measure(parts_.stabilisation().add_forces(step_, total));
  parts_.removal().add_forces(step_.time, total);
  measure(parts_.scheme().add_loads(step_.time, trial.displacements, total));
  parts_.released().add_forces(step_.time, total);
  parts_.switched_supports().add_forces(step_.time, total);
  trial.supports = total;
  measure(parts_.scheme().complete(trial.contact, total));
  parts_.supports().condense(total);
  std::copy(total.begin(), total.end(), residual.begin());
  parts_.tools().add_residual(step_.time, total.locally_owned_size(), residual);
  status_changes_ = find_status_changes();
  const bool is_finite = std::isfinite(scales_.force);
  measure(scales_.lasting);
  return is_finite;
}

bool ImplicitProblem::compute_tangent(const Vector &x) {
  set_trial(x);
  const bool success = assemble_tangent({parts_.supports().homogeneous(), parts_.tangent().matrix()});
  linearised_ = parts_.contacts().slave_forces();
  return success;
}

StatusChanges ImplicitProblem::find_status_changes() const {
  StatusChanges changes;
  if (linearised_.empty()) // no contact is possible, or there has been no tangent
    return changes;
  const std::vector<std::vector<SlaveForce>> now = parts_.contacts().slave_forces();
  for (std::size_t i = 0; i < now.size(); ++i)
    changes.add(linearised_[i], now[i]);
  std::vector<double> sums{changes.n, changes.force, changes.contact_force};
  dealii::Utilities::MPI::sum(sums, parts_.communicator(), sums);
  return {sums[0], sums[1], sums[2]};
}

bool ImplicitProblem::assemble_tangent(const TangentSystem &system, const double yield_slack) {
  for (auto &contact : parts_.contacts())
    contact.with_matrix().update(step_.ghosted);
  parts_.tangent().follow_couplings();
  system.matrix = 0.;
  if (!on_all_ranks(parts_.internal().assemble_tangent(step_.ghosted, system, yield_slack)))
    return false;
  parts_.stabilisation().add_tangent(system);
  const TangentSystem contact_system{system.constraints, system.matrix, system.lift,
                                     parts_.scheme().contact().at_end()};
  for (const auto &contact : parts_.contacts().of_tools())
    contact.with_matrix().add_tangent(contact_system);
  parts_.tangent().start_contact();
  for (const auto &contact : parts_.contacts().of_bodies())
    contact.with_matrix().add_tangent(contact_system);
  parts_.scheme().add_tangent(step_.time, {parts_.supports().homogeneous(), system.matrix});
  system.matrix.compress(dealii::VectorOperation::add);
  parts_.tools().assemble_tangent();
  parts_.tangent().set_geometry(step_.trial.displacements);
  parts_.tangent().solver().expect_nearly_singular(parts_.stabilisation().acts());
  return parts_.tangent().solver().factorize();
}

bool ImplicitProblem::solve_bordered(const Vector &r_u, const std::vector<double> &r_s, const double sense,
                                     const double relative_tolerance, Vector &du, std::vector<double> &ds) {
  return parts_.tools().solve([this](const Vector &b, const double tolerance,
                                     Vector &x) { return parts_.tangent().solve(b, tolerance, x); },
                              r_u, r_s, sense, relative_tolerance, du, ds);
}

bool ImplicitProblem::solve_tangent(const Vector &residual, Vector &dx, const double relative_tolerance) {
  Vector r_u = parts_.discretization().make_owned_vector(), du = r_u;
  const std::size_t n_displacements = r_u.locally_owned_size();
  std::copy(residual.begin(), residual.begin() + n_displacements, r_u.begin());
  std::vector<double> r_s(parts_.tools().unknown().size()), ds(r_s);
  if (residual.locally_owned_size() > n_displacements)
    std::copy(residual.begin() + n_displacements, residual.end(), r_s.begin());
  if (!r_s.empty())
    r_s = dealii::Utilities::MPI::broadcast(parts_.communicator(), r_s, 0);
  if (!solve_bordered(r_u, r_s, -1., relative_tolerance, du, ds)) // Newton's method subtracts it
    return false;
  std::copy(du.begin(), du.end(), dx.begin());
  if (dx.locally_owned_size() > n_displacements)
    std::copy(ds.begin(), ds.end(), dx.begin() + n_displacements);
  return std::isfinite(du.l2_norm());
}

double ImplicitProblem::max_step_length(const Vector &x, const Vector &direction) {
  if (parts_.contacts().empty())
    return 1.;
  set_trial(x);
  const Vector from = step_.ghosted;
  const std::vector<Placement> tools_from = parts_.tools().placements(step_.time);
  Vector end = x;
  end += direction;
  set_trial(end);
  const double part = parts_.contacts().find_free_part(
      {from, step_.ghosted, tools_from, parts_.tools().placements(step_.time), false}, obstacle_);
  return part < ImplicitProblemLimits::min_part ? 0. : part;
}

double ImplicitProblem::find_free_part(const bool is_thorough) {
  step_.ghosted = step_.trial.displacements;
  return parts_.contacts().find_free_part({state_.displacements, step_.ghosted, state_.placements,
                                           parts_.tools().placements(step_.time), is_thorough},
                                          obstacle_);
}

void ImplicitProblem::start_step(const double t) {
  step_.time = t;
  step_.duration = t - state_.time;
  parts_.internal().start_step(t, step_.duration);
  parts_.stabilisation().start_step(step_.duration);
  parts_.scheme().start_step(state_.time, t, step_.start.displacements, parts_.tools().start_offsets());
  const std::vector<Placement> placements = parts_.tools().placements(t);
  for (auto &contact : parts_.contacts()) {
    contact.start_step({state_.time, t, step_.duration, state_.placements, placements});
    contact.set_friction_account(parts_.scheme().contact().at_start(),
                                 parts_.scheme().has_inertia() ? FrictionAccounting::of_motion
                                                               : FrictionAccounting::of_equilibria);
  }
}

void ImplicitProblem::start_at_rest() {
  for (auto &contact : parts_.contacts())
    contact.start_step({state_.time, state_.time, 0., state_.placements, state_.placements});
  step_.duration = 0.;
  parts_.internal().start_step(state_.time, 0.);
}

void ImplicitProblem::evaluate_start() {
  start_at_rest();
  parts_.contacts().restart();
  parts_.stabilisation().start_step(0.);
  step_.time = state_.time;
  parts_.tools().restart();
  parts_.tools().choose_unknown({});
  Vector x = unknowns(), ignored(x);
  compute_residual(x, ignored);
}

Contacts::Loads ImplicitProblem::start_from_trial() {
  step_.start.supports = step_.trial.supports;
  step_.start.contact = step_.trial.contact;
  step_.start.internal = step_.trial.internal;
  Contacts::Loads loads = parts_.contacts().compute_loads();
  state_.tool_loads = loads.of_tools;
  state_.body_pair_loads = loads.of_body_pairs;
  return loads;
}

} // namespace billet
