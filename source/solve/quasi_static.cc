// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/quasi_static.h"

#include "billet/contact/overlap.h"
#include "billet/errors.h"
#include "billet/scene/rigid_motions.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <Epetra_Vector.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <sstream>

namespace billet {

namespace {

/// Of the linear step that a step begins with, where the solver is iterative: the iterations mend the rest.
constexpr double first_guess_tolerance = 1e-3;

Epetra_Vector &as_epetra(Vector &vector) { return *vector.trilinos_vector()(0); }

NodalGeometry collect_geometry(const Discretization &discretization, const Constraints &constraints) {
  const auto &owned = discretization.owned_dofs();
  NodalGeometry geometry;
  geometry.positions.resize(owned.n_elements());
  geometry.constrained.resize(owned.n_elements());
  for (const auto &cell : discretization.dof_handler().active_cell_iterators())
    if (!cell->is_artificial())
      for (const unsigned int v : cell->vertex_indices())
        for (unsigned int i = 0; i < 3; ++i) {
          const DofIndex dof = cell->vertex_dof_index(v, i);
          if (owned.is_element(dof))
            geometry.positions[owned.index_within_set(dof)] = cell->vertex(v)[i];
        }
  for (const auto &line : constraints.get_lines())
    if (owned.is_element(line.index))
      geometry.constrained[owned.index_within_set(line.index)] = true;
  return geometry;
}

} // namespace

QuasiStatic::QuasiStatic(const Scene &scene, const Discretization &discretization)
    : scene_(scene), discretization_(discretization), supports_(scene, discretization),
      motions_(scene, supports_, discretization), internal_(scene, discretization),
      tangent_(scene.contact_tangent()),
      penalties_(scene, discretization, PenaltyControl::in_implicit_scenes),
      soft_penalties_(scene.parameters().is_dynamic() ? PenaltyWatch::Motion::sudden
                                                      : PenaltyWatch::Motion::slow) {
  for (std::size_t p = 0; p < scene.pairs().size(); ++p)
    contacts_.emplace_back(scene, p, discretization, tangent_);
  RigidContact::introduce(contacts_);
  if (!scene.body_pairs().empty())
    nodes_ = std::make_unique<LocalNodes>(discretization);
  for (std::size_t p = 0; p < scene.body_pairs().size(); ++p) {
    body_contacts_.push_back(std::make_unique<BodyContact>(scene, p, *nodes_));
    if (!scene.parameters().restart.is_wanted()) // it begins with deformed bodies
      check_overlap(scene, p, discretization);
  }
  softness_ =
      SoftnessLimit(of_contacts([](const auto &contact) { return contact.settings().limits_softness(); }));
  state_.body_pair_loads.resize(body_contacts_.size());
  tool_pair_energies_.resize(contacts_.size());
  if (body_contacts_.empty()) // else when it is known who touches whom
    build_matrix();

  trial_ = u_n_ = last_increment_ = support_forces_ = support_forces_n_ = contact_forces_ =
      contact_forces_n_ = bare_forces_n_ = internal_forces_ = internal_forces_n_ =
          discretization.make_owned_vector();
  trial_ghosted_ = state_.displacements = discretization.make_ghosted_vector();
  raw_internal_ = discretization.make_additive_vector();
  raw_contact_ = discretization.make_additive_vector();

  double stiffest = 0.;
  for (const auto &body : scene.bodies())
    stiffest = std::max(stiffest, body.largest_modulus);
  // A hundred times the force that the last bit of a displacement of the scene's size makes.
  round_off_force_ = 100. * std::numeric_limits<double>::epsilon() * stiffest * discretization.radius() *
                     discretization.radius();
  spring_round_off_ = find_spring_round_off();

  const std::size_t n_tools = scene.tools().size();
  offsets_.assign(n_tools, 0.);
  offsets_n_ = offsets_;
  stopped_.resize(n_tools);
  fading_forces_.resize(n_tools);
  state_.tool_loads.resize(n_tools);
  for (const auto &tool : scene.tools())
    state_.placements.push_back(tool.placement(0.));
  // Prescribed displacements hold at time 0, too.
  check_before_start([&] {
    supports_.at_time(0.).distribute(u_n_);
    supports_.at_time(scene.parameters().time_stepping.end_time);
  });
  state_.displacements = u_n_;
  choose_unknown_tools({});
  if (!scene.parameters().is_dynamic()) {
    prepare_support_check();
    prepare_stabilisation();
    body_forces_n_.assign(scene.bodies().size(), 0.);
    largest_forces_ = body_forces_n_;
  }
  if (scene.parameters().is_dynamic())
    motion_ = std::make_unique<ImplicitMotion>(scene_, discretization_, supports_);
  if (scene.parameters().restart.is_wanted()) // load() does the rest
    return;
  if (!body_contacts_.empty()) {
    for (auto &contact : contacts_)
      contact.update(state_.displacements);
    for (auto &contact : body_contacts_) {
      contact->update(state_.displacements, 0.);
      contact->allow_overlap();
    }
    if (!scene.parameters().is_dynamic())
      check_freedom();
    build_matrix();
  }
  if (scene.parameters().is_dynamic())
    start_motion();
}

void QuasiStatic::build_matrix(const bool couplings_are_known) {
  const auto &owned = discretization_.owned_dofs();
  dealii::IndexSet written = discretization_.relevant_dofs();
  for (auto &contact : body_contacts_) {
    if (!couplings_are_known)
      contact->find_couplings(tangent_);
    contact->add_foreign_dofs(written);
  }
  dealii::TrilinosWrappers::SparsityPattern pattern(owned, owned, written, discretization_.communicator());
  dealii::DoFTools::make_sparsity_pattern(
      discretization_.dof_handler(), pattern, supports_.homogeneous(), false,
      dealii::Utilities::MPI::this_mpi_process(discretization_.communicator()));
  for (const auto &contact : body_contacts_)
    contact->add_couplings(pattern);
  pattern.compress();
  if (linear_) {
    linear_->release();
    matrix_.reinit(pattern);
    linear_->set_matrix(matrix_.trilinos_matrix());
    return;
  }
  matrix_.reinit(pattern);
  parameters::Solver settings = scene_.parameters().solver;
  const bool has_own_tangent = tangent_ == scene_.contact_tangent();
  using LinearSolver = parameters::Solver::LinearSolver;
  LinearSolver &kind = settings.linear_solver.value;
  if (!has_own_tangent &&
      (kind == LinearSolver::mumps_symmetric || kind == LinearSolver::conjugate_gradients))
    kind = LinearSolver::automatic;
  linear_ =
      std::make_unique<TangentSolver>(settings, has_own_tangent && !scene_.capabilities().unsymmetric_matrix,
                                      matrix_.trilinos_matrix(), discretization_.communicator());
  if (linear_->is_iterative())
    undeformed_ = collect_geometry(discretization_, supports_.homogeneous());
}

void QuasiStatic::follow_couplings() {
  bool is_known = linear_ != nullptr;
  for (const auto &contact : body_contacts_)
    is_known = is_known && !contact->has_new_couplings();
  if (!body_contacts_.empty() && !all_ranks(is_known))
    build_matrix();
}

std::vector<std::vector<ContactNodeReport>> QuasiStatic::report_contacts() const {
  std::vector<std::vector<ContactNodeReport>> reports;
  for (const auto &contact : contacts_)
    reports.push_back(contact.report());
  for (const auto &contact : body_contacts_)
    reports.push_back(contact->report());
  return reports;
}

std::array<std::size_t, 2> QuasiStatic::history_sizes() const {
  std::array<std::size_t, 2> sizes = {{internal_.history_size(), 0}};
  for (const auto &contact : contacts_)
    sizes[1] += contact.history_size();
  for (const auto &contact : body_contacts_)
    sizes[1] += contact->history_size();
  for (auto &size : sizes)
    size = dealii::Utilities::MPI::sum(size, discretization_.communicator());
  return sizes;
}

bool QuasiStatic::all_ranks(const bool success) const {
  return dealii::Utilities::MPI::min(success ? 1 : 0, discretization_.communicator()) == 1;
}

void QuasiStatic::set_trial(const Epetra_Vector &x) {
  Epetra_Vector &displacements = as_epetra(trial_);
  std::copy(x.Values(), x.Values() + displacements.MyLength(), displacements.Values());
  trial_ghosted_ = trial_;
  if (unknown_tools_.empty())
    return;
  std::vector<double> values(unknown_tools_.size());
  if (dealii::Utilities::MPI::this_mpi_process(discretization_.communicator()) == 0)
    std::copy(x.Values() + displacements.MyLength(), x.Values() + x.MyLength(), values.begin());
  values = dealii::Utilities::MPI::broadcast(discretization_.communicator(), values, 0);
  for (std::size_t k = 0; k < unknown_tools_.size(); ++k)
    offsets_[unknown_tools_[k]] = values[k] / unit_of(unknown_tools_[k]);
  place_tools(time_);
}

bool QuasiStatic::compute_residual(const Epetra_Vector &x, Epetra_Vector &residual) {
  set_trial(x);
  raw_internal_ = 0.;
  raw_contact_ = 0.;
  const bool success = internal_.assemble_forces(trial_ghosted_, raw_internal_);
  if (!all_ranks(success))
    return false;
  raw_internal_.compress(dealii::VectorOperation::add);
  for (auto &contact : contacts_) {
    contact.update(trial_ghosted_);
    contact.add_forces(raw_contact_);
  }
  for (auto &contact : body_contacts_) {
    contact->update(trial_ghosted_, duration_);
    contact->add_forces(raw_contact_);
  }
  raw_contact_.compress(dealii::VectorOperation::add);

  support_forces_ = raw_internal_;
  internal_forces_ = support_forces_;
  force_scale_ = support_forces_.l2_norm();
  Vector total = support_forces_;
  contact_forces_ = raw_contact_;
  const double contact_size = contact_forces_.l2_norm();
  contact_bears_ = contact_size > 0.;
  force_scale_ = std::max(force_scale_, contact_size);
  total += contact_forces_;
  add_stabilisation(total);
  for (std::size_t tool = 0; tool < fading_forces_.size(); ++tool)
    if (fading_forces_[tool])
      total.add(fading(time_, tool), *fading_forces_[tool]);
  if (motion_)
    force_scale_ = std::max(force_scale_, motion_->add_loads(time_, trial_, total));
  if (imbalance_)
    total.add(-imbalance_left(time_), *imbalance_);
  support_forces_ = total;
  if (motion_) {
    total.add(contact_weight() - 1., contact_forces_);
    force_scale_ = std::max(force_scale_, motion_->complete(bare_forces_n_, total));
  }
  supports_.condense(total);
  const Epetra_Vector &values = as_epetra(total);
  std::copy(values.Values(), values.Values() + values.MyLength(), residual.Values());
  for (std::size_t k = 0; k < unknown_tools_.size(); ++k) {
    const double excess = imbalance(unknown_tools_[k], time_) / unit_of(unknown_tools_[k]);
    if (values.MyLength() + static_cast<int>(k) < residual.MyLength()) // on the rank that has it
      residual[values.MyLength() + static_cast<int>(k)] = excess;
  }
  status_changes_ = find_status_changes();
  const bool is_finite = std::isfinite(force_scale_);
  force_scale_ = std::max(force_scale_, lasting_scale_);
  return is_finite;
}

bool QuasiStatic::compute_tangent(const Epetra_Vector &x) {
  set_trial(x);
  const bool success = assemble_tangent({supports_.homogeneous(), matrix_});
  linearised_ = slave_forces();
  return success;
}

std::vector<std::vector<SlaveForce>> QuasiStatic::slave_forces() const {
  return of_contacts([](const auto &contact) { return contact.slave_forces(); });
}

StatusChanges QuasiStatic::find_status_changes() const {
  StatusChanges changes;
  if (linearised_.empty()) // nothing can touch, or there has been no tangent
    return changes;
  const std::vector<std::vector<SlaveForce>> now = slave_forces();
  for (std::size_t i = 0; i < now.size(); ++i)
    changes.add(linearised_[i], now[i]);
  std::vector<double> sums{changes.n, changes.force, changes.contact_force};
  dealii::Utilities::MPI::sum(sums, discretization_.communicator(), sums);
  return {sums[0], sums[1], sums[2]};
}

NodalGeometry QuasiStatic::nodal_geometry() const {
  NodalGeometry geometry = undeformed_;
  const Epetra_Vector &displacements = *trial_.trilinos_vector()(0);
  for (std::size_t i = 0; i < geometry.positions.size(); ++i)
    geometry.positions[i] += displacements[static_cast<int>(i)];
  return geometry;
}

std::vector<int> QuasiStatic::touching_dofs() const {
  Vector additive = discretization_.make_additive_vector(), forces = discretization_.make_owned_vector();
  for (const auto &contact : body_contacts_)
    contact->add_forces(additive);
  additive.compress(dealii::VectorOperation::add);
  forces = additive;
  const Epetra_Vector &values = as_epetra(forces);
  std::vector<int> dofs;
  for (int i = 0; i < values.MyLength(); i += 3)
    if (values[i] != 0. || values[i + 1] != 0. || values[i + 2] != 0.)
      dofs.insert(dofs.end(), {i, i + 1, i + 2});
  return dofs;
}

bool QuasiStatic::assemble_tangent(const TangentSystem &system, const double yield_slack) {
  for (auto &contact : body_contacts_)
    contact->update(trial_ghosted_, duration_);
  follow_couplings();
  system.matrix = 0.;
  if (!all_ranks(internal_.assemble_tangent(trial_ghosted_, system, yield_slack)))
    return false;
  add_stabilisation_tangent(system);
  const TangentSystem contact_system{system.constraints, system.matrix, system.lift, contact_weight()};
  for (auto &contact : contacts_) {
    contact.update(trial_ghosted_);
    contact.add_tangent(contact_system);
  }
  if (linear_->is_iterative() && !body_contacts_.empty()) {
    system.matrix.compress(dealii::VectorOperation::add);
    linear_->start_contact(touching_dofs());
  }
  for (const auto &contact : body_contacts_)
    contact->add_tangent(contact_system, tangent_);
  if (motion_)
    motion_->add_tangent(time_, {supports_.homogeneous(), system.matrix});
  system.matrix.compress(dealii::VectorOperation::add);
  assemble_tool_tangent();
  if (linear_->is_iterative())
    linear_->set_geometry(nodal_geometry());
  linear_->expect_nearly_singular(stabilisation_ && stabilisation_->acts());
  return linear_->factorize();
}

bool QuasiStatic::solve_tangent(const Epetra_Vector &residual, Epetra_Vector &dx,
                                const double relative_tolerance) {
  Vector r_u = discretization_.make_owned_vector(), du = r_u;
  Epetra_Vector &r_values = as_epetra(r_u);
  std::copy(residual.Values(), residual.Values() + r_values.MyLength(), r_values.Values());
  std::vector<double> r_s(unknown_tools_.size()), ds(r_s);
  if (residual.MyLength() > r_values.MyLength())
    std::copy(residual.Values() + r_values.MyLength(), residual.Values() + residual.MyLength(), r_s.begin());
  if (!r_s.empty())
    r_s = dealii::Utilities::MPI::broadcast(discretization_.communicator(), r_s, 0);
  if (!solve_with_tools(r_u, r_s, -1., relative_tolerance, du, ds)) // what Newton subtracts
    return false;
  const Epetra_Vector &values = as_epetra(du);
  std::copy(values.Values(), values.Values() + values.MyLength(), dx.Values());
  if (dx.MyLength() > values.MyLength())
    std::copy(ds.begin(), ds.end(), dx.Values() + values.MyLength());
  return std::isfinite(du.l2_norm());
}

bool QuasiStatic::stay_at_rest(const double t) {
  const double t_n = state_.time;
  if (has_lost_pace_ || imbalance_left(t) != imbalance_left(t_n))
    return false;
  for (std::size_t i = 0; i < scene_.tools().size(); ++i) {
    if (fading_forces_[i] && fading(t, i) != fading(t_n, i))
      return false;
    if (fading_forces_[i] || stopped_[i])
      continue;
    const Tool &tool = scene_.tools()[i];
    const Placement before = tool.placement(t_n), after = tool.placement(t);
    if (after.translation != before.translation || after.rotation_angle != before.rotation_angle ||
        (tool.control() != Tool::Control::motion && tool.load(t) != tool.load(t_n)))
      return false;
  }
  bool supports_move = false;
  supports_.change(t_n, t, supports_move);
  if (supports_move)
    return false;
  trial_ = u_n_;
  offsets_ = offsets_n_;
  return true;
}

bool QuasiStatic::continue_increment(const double t, const double previous_step) {
  if (has_lost_pace_)
    return false;
  const double ratio = (t - state_.time) / previous_step;
  // Where tools or supports do not go on as they went, the last increment says little.
  constexpr double largest_jump = 0.1;
  const double t_n = state_.time;
  for (const auto &tool : scene_.tools()) {
    if (stopped_[static_cast<std::size_t>(&tool - scene_.tools().data())])
      continue;
    const Placement before = tool.placement(t_n - previous_step), now = tool.placement(t_n),
                    after = tool.placement(t);
    // Six points of the tool about the scene.
    double jump = 0., motion = 0.;
    for (unsigned int i = 0; i < 6; ++i) {
      dealii::Tensor<1, 3> here = discretization_.centre();
      here[i / 2] += (i % 2 == 0 ? 1. : -1.) * discretization_.radius();
      const auto point = now.to_tool(here);
      const auto step = after.to_space(point) - here;
      jump += (step - ratio * (here - before.to_space(point))).norm();
      motion += step.norm();
    }
    if (jump > largest_jump * motion)
      return false;
  }
  trial_ = u_n_;
  trial_.add(ratio, last_increment_);
  for (const std::size_t tool : unknown_tools_)
    offsets_[tool] = offsets_n_[tool] + ratio * last_offset_increments_[tool];
  Vector jump = trial_, motion = trial_;
  supports_.at_time(t).distribute(trial_);
  jump -= trial_;
  motion -= u_n_;
  return jump.l2_norm() <= largest_jump * motion.l2_norm();
}

bool QuasiStatic::follow_tangent(const double t, NewtonIteration &iteration) {
  // K Δu = −∂R/∂t Δt at the last state. The change of the prescribed displacements is lifted to the
  // right-hand side, so that it spreads through the bodies, where putting it on the boundary nodes alone
  // would crush the elements beside them.
  const double t_n = state_.time;
  bool supports_move = false;
  const Constraints change = supports_.change(t_n, t, supports_move);
  for (auto &contact : contacts_) {
    const Placement &now = state_.placements[contact.tool()];
    contact.start_step(now, now, 0.);
    contact.set_allowed_part(scene_.pairs()[contact.pair()].overlap.allowed_part(t_n));
  }
  for (auto &contact : body_contacts_)
    contact->start_step(t_n, t_n);
  duration_ = 0.;
  offsets_ = offsets_n_;
  Vector correction = discretization_.make_owned_vector(), rhs = correction;
  {
    const std::vector<std::size_t> unknown = unknown_tools_;
    unknown_tools_.clear(); // their tools stay where they are
    const bool is_admissible = compute_residual(as_epetra(u_n_), as_epetra(rhs));
    unknown_tools_ = unknown;
    if (!is_admissible)
      return false;
  }
  rhs *= -1.;
  std::vector<double> load_rhs, offset_changes(unknown_tools_.size());
  for (const std::size_t tool : unknown_tools_)
    load_rhs.push_back(-imbalance(tool, t) / unit_of(tool));
  Vector pushes = discretization_.make_additive_vector(), lift = pushes;
  for (const auto &contact : contacts_)
    contact.add_tool_push(place(contact.tool(), t, offsets_n_[contact.tool()]), pushes);
  pushes.compress(dealii::VectorOperation::add);
  Vector push = correction;
  push = pushes;
  push *= contact_weight();
  supports_.condense(push);
  rhs += push;
  // Whether points on the yield surface will load or unload is not known yet. The elastic guess is the safe
  // one, and takes the fewer iterations: the soft plastic one overshoots wherever they unload.
  if (!assemble_tangent({change, matrix_, &lift}, 1e-9))
    return false;
  lift.compress(dealii::VectorOperation::add);
  push = lift;
  rhs += push;
  const parameters::Solver &solver = scene_.parameters().solver;
  const double relative_tolerance = solver.forcing == parameters::Solver::Forcing::fixed
                                        ? solver.linear_tolerance
                                        : std::max(solver.linear_tolerance, first_guess_tolerance);
  if (!solve_with_tools(rhs, load_rhs, 1., relative_tolerance, correction, offset_changes))
    return false;
  iteration = {1., std::abs(rhs * correction), 1.};
  change.distribute(correction);
  trial_ = u_n_;
  trial_ += correction;
  supports_.at_time(t).distribute(trial_);
  for (std::size_t k = 0; k < unknown_tools_.size(); ++k)
    offsets_[unknown_tools_[k]] += offset_changes[k] / unit_of(unknown_tools_[k]);
  return std::isfinite(trial_.l2_norm());
}

void QuasiStatic::start_step(const double t) {
  time_ = t;
  duration_ = t - state_.time;
  if (stabilisation_)
    stabilisation_->start_step(duration_);
  for (auto &contact : body_contacts_) {
    contact->start_step(state_.time, t);
    contact->set_friction_account(contact_before(), motion_ == nullptr);
  }
  if (motion_)
    motion_->start_step(state_.time, t, u_n_, offsets_n_);
  for (auto &contact : contacts_) {
    const std::size_t tool = contact.tool();
    contact.start_step(state_.placements[tool], place(tool, t, offsets_[tool]), t - state_.time);
    contact.set_friction_account(contact_before(), motion_ == nullptr);
    contact.set_allowed_part(scene_.pairs()[contact.pair()].overlap.allowed_part(t));
  }
}

NewtonReport QuasiStatic::step(const double t, const double previous_step) {
  if (!body_failure_.empty())
    throw SolutionFailure(body_failure_);
  DiagnosticList messages;
  choose_contact_damping();
  // What stalls with stiff penalties may converge by way of softer ones.
  accepts_stalled_ = !has_stiff_contacts();
  NewtonReport report = attempt_step(t, previous_step);
  constexpr unsigned int max_raises = 6; // each by 2 at least, by less than 100 in all
  for (unsigned int n = 0; report.penetrates && n < max_raises; ++n) {
    raise_penalties(raises_);
    append(report.diagnostics, describe_raises(raises_));
    report.append_anew(attempt_step(t, previous_step));
  }
  if (report.makes_energy) { // once more, so that it does not
    damp_contact();
    report.append_anew(attempt_step(t, previous_step));
  }
  bool may_accept_stalled = report.is_stalled;
  // Steps of motion that have converged, and are too long, need shorter ones.
  if (!report.converged && !(motion_ && report.is_explained) && soften_augmented_contacts(messages))
    report.append_anew(attempt_step(t, previous_step));
  if (!report.converged && !report.is_explained && !report.iterations.empty() && has_stiff_contacts()) {
    is_led_by_softer_ = true;
    report.append_anew(attempt_step(t, previous_step));
    is_led_by_softer_ = false;
    if (report.converged)
      messages.push_back(needs_softer_penalties());
    may_accept_stalled = may_accept_stalled || report.is_stalled;
  }
  if (!report.converged && !report.is_explained && may_accept_stalled && !accepts_stalled_) {
    accepts_stalled_ = true;
    report.append_anew(attempt_step(t, previous_step));
  }
  measures_penetration_ = false; // what is tried next may be no step to measure it in
  if (!report.converged) {
    probe_.reset(); // it may have led astray
    report.is_lost_in_round_off =
        report.is_lost_in_round_off || (!report.is_explained && may_be_round_off(report));
    if (report.is_lost_in_round_off)
      report.failure = describe_round_off(report.force);
    else if (!report.is_explained) {
      for (const auto &contact : body_contacts_)
        report.failure += contact->describe_restless();
      report.failure += describe_slipping_tools() + describe_sliding() + describe_residual();
    }
    if (state_.time < loss_.time && report.failure != loss_.text && !report.is_lost_in_round_off)
      report.failure += "; a step that goes further failed since " + loss_.text;
  }
  report.linear_iterations = linear_->take_iterations();
  append(report.diagnostics, std::move(messages));
  append(report.diagnostics, linear_->take_diagnostics());
  if (report.converged) {
    append(report.diagnostics, linear_->check_condition());
    append(report.diagnostics, check_penalties());
    if (report.is_stalled)
      report.diagnostics.push_back(describe_stall(report));
    else
      append(report.diagnostics, check_round_off(report.force));
    append(report.diagnostics, contact_losses_.watch(largest_energy_, state_.time));
    append(report.diagnostics, control_penalties());
  }
  return report;
}

NewtonReport QuasiStatic::attempt_step(const double t, const double previous_step) {
  NewtonReport report;
  time_ = t;
  of_penetration_.reset();
  tool_failure_.clear();
  path_failure_.clear();
  offsets_ = offsets_n_;
  std::vector<std::size_t> pressing;
  for (std::size_t i = 0; i < scene_.tools().size(); ++i)
    if (scene_.tools()[i].is_driven() && !fading_forces_[i])
      pressing.push_back(i);
  choose_unknown_tools(pressing);
  if (stabilisation_)
    stabilisation_->start_step(t - state_.time);
  if (turns_too_far(t, report) || skips_motion(t, report))
    return report;
  const bool extrapolates =
      scene_.parameters().solver.predictor == parameters::Solver::Predictor::extrapolation;
  bool needs_no_solution =
      motion_
          ? extrapolates && extrapolate_motion(t)
          : follow_probe(t) || (previous_step > 0. &&
                                (stay_at_rest(t) || (extrapolates && continue_increment(t, previous_step))));
  NewtonIteration linear_step{};
  if (motion_)
    motion_->start_step(state_.time, t, u_n_, offsets_n_);
  bool has_guess = needs_no_solution || follow_tangent(t, linear_step);
  start_step(t);
  if (has_guess && needs_no_solution && !motion_ &&
      goes_through(false, report)) { // the tangent knows contact
    report = NewtonReport();
    needs_no_solution = false;
    has_guess = follow_tangent(t, linear_step);
    start_step(t);
  }
  if (has_guess && goes_through(false, report))
    return report;
  path_failure_.clear();
  if (!has_guess) {
    report.failure = !tool_failure_.empty()        ? tool_failure_
                     : !linear_->failure().empty() ? linear_->failure()
                                                   : "the first guess is not admissible";
    return report;
  }
  Vector x = trial_;
  std::vector<double> offsets = offsets_;
  for (auto &contact : contacts_)
    contact.restart();
  for (auto &contact : body_contacts_)
    contact->restart();
  report = is_led_by_softer_ ? iterate_from_softer(offsets, x) : iterate(offsets, x);
  if (!needs_no_solution)
    report.iterations.insert(report.iterations.begin(), linear_step); // it costs what an iteration costs
  if (!is_led_by_softer_)
    report.hardest = report.iterations.size();
  augment(report, offsets, x);

  // A tool that has gone too far is drawn back to where it presses with its stop force.
  std::vector<std::size_t> stopping;
  if (report.converged)
    stopping = tools_to_stop(t);
  if (!stopping.empty()) {
    const bool has_measured = of_penetration_.has_value();
    pressing.insert(pressing.end(), stopping.begin(), stopping.end());
    choose_unknown_tools(pressing);
    report.append(iterate(offsets, x));
    augment(report, offsets, x);
    if (has_measured) // with the tool where it is no more
      of_penetration_ = OfPenetration();
  }
  if (report.converged) {
    // The line search may have looked further since: the histories have to be those of the accepted state.
    Epetra_Vector accepted = pack(x, offsets);
    Epetra_Vector residual(accepted);
    compute_residual(accepted, residual);
    if (measures_penetration_ && !is_probing_) {
      measure_penetration(accepted, report);
      compute_residual(accepted, residual);
      if (allow_less_penetration()) {
        augment(report, offsets, x);
        accepted = pack(x, offsets);
        compute_residual(accepted, residual);
        if (!report.converged)
          return report;
      }
    }
    if (is_probing_ || is_lost_in_round_off(t, report) || !is_accurate(t, report) ||
        goes_through_tool(report) || goes_through(true, report) || turns_too_far(t, report) ||
        penetrates(report) || meets_too_early(t, report) || contact_is_out_of_balance(t, report) ||
        loses_energy(t, report) || loses_bodies(t, report))
      return report;
    n_in_round_off_ = report.is_lost_in_round_off ? n_in_round_off_ + 1 : 0;
    penetration_ = find_penetration();
    append(report.diagnostics, check_motion(t));
    commit(t);
    has_lost_pace_ = has_lost_pace_ || !stopping.empty();
    for (const std::size_t tool : stopping)
      stopped_[tool] = std::make_unique<Placement>(state_.placements[tool]);
  }
  return report;
}

NewtonReport QuasiStatic::iterate(std::vector<double> &offsets, Vector &displacements) {
  const Epetra_Vector x_n = pack(u_n_, offsets_n_);
  Epetra_Vector x = pack(displacements, offsets);
  parameters::Solver settings = scene_.parameters().solver;
  const double accuracy = accuracy_ * (motion_ ? motion_->wanted_accuracy() : 1.);
  settings.force_tolerance *= accuracy;
  settings.energy_tolerance *= accuracy;
  settings.displacement_tolerance *= accuracy;
  constexpr unsigned int most_for_a_measurement = 8; // what it tells is not worth more
  if (is_probing_)
    settings.most_iterations = std::min(settings.most_iterations, most_for_a_measurement);
  NewtonReport report = solve_newton(*this, settings, x_n, x, accepts_stalled_);
  if (!tool_failure_.empty() && !report.converged)
    report.failure = tool_failure_;
  else if (!path_failure_.empty() && !report.converged && report.failure.empty())
    report.failure = "the correction is useless: " + path_failure_;
  set_trial(x);
  displacements = trial_;
  offsets = offsets_;
  return report;
}

void QuasiStatic::commit(const double t) {
  const StepWorks works = compute_step_works();
  softness_.commit(contact_springs());
  if (motion_)
    book_contact(contact_loss(t));
  else
    contact_balance_ += trial_contact_loss_;
  element_balance_ += trial_imbalance_;
  has_lost_pace_ = false;
  // When the forces go they leave a measure for what is small.
  lasting_scale_ = std::max(lasting_scale_, 1e-3 * force_scale_);
  round_off_.add(t, contact_round_off_force(), force_scale_);
  last_increment_ = trial_;
  last_increment_ -= u_n_;
  last_offset_increments_.resize(offsets_.size());
  for (std::size_t i = 0; i < offsets_.size(); ++i)
    last_offset_increments_[i] = offsets_[i] - offsets_n_[i];
  offsets_n_ = offsets_;
  commit_stabilisation();
  for (std::size_t tool = 0; tool < fading_forces_.size(); ++tool)
    if (fading_forces_[tool])
      state_.energies.external -=
          0.5 * (fading(t, tool) + fading(state_.time, tool)) * (*fading_forces_[tool] * last_increment_);
  if (imbalance_)
    state_.energies.external +=
        0.5 * (imbalance_left(t) + imbalance_left(state_.time)) * (*imbalance_ * last_increment_);
  if (!motion_)
    state_.energies.external += element_imbalance().by_yielding; // (A3)
  u_n_ = trial_;
  internal_.commit();

  // Work of the supports and of the tools, by the trapezoidal rule, but with (I4) that of contact by its
  // forces at the end.
  const double before = contact_before();
  Vector mean_forces = support_forces_;
  mean_forces += support_forces_n_;
  mean_forces *= 0.5;
  mean_forces.add(0.5 - before, contact_forces_, before - 0.5, contact_forces_n_);
  if (motion_)
    motion_->commit(u_n_, last_increment_, mean_forces, state_.energies);
  else
    state_.energies.external += mean_forces * last_increment_ + works.touching;
  state_.energies.external += works.ramp;
  internal_forces_n_ = internal_forces_;
  support_forces_n_ = support_forces_;
  contact_forces_n_ = contact_forces_;

  const std::vector<ContactLoad> loads_n = state_.tool_loads;
  const std::vector<Placement> placements_n = state_.placements;
  find_slipping_tools();
  std::fill(state_.tool_loads.begin(), state_.tool_loads.end(), ContactLoad());
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const ContactLoad load = contacts_[i].compute_load();
    tool_pair_energies_[i] = load.stored_energy;
    state_.tool_loads[contacts_[i].tool()] += load;
    contacts_[i].commit();
  }
  state_.energies.contact = 0.;
  for (std::size_t i = 0; i < body_contacts_.size(); ++i) {
    state_.body_pair_loads[i] = body_contacts_[i]->compute_load();
    state_.energies.contact += state_.body_pair_loads[i].stored_energy;
    state_.energies.friction += state_.body_pair_loads[i].dissipation;
    body_contacts_[i]->commit();
  }
  for (std::size_t i = 0; i < state_.tool_loads.size(); ++i) {
    const ContactLoad &load = state_.tool_loads[i];
    Placement &placement = state_.placements[i];
    placement = place(i, t, offsets_[i]);
    if (fading_forces_[i]) // it is gone, and does no work
      continue;
    const double turn = placement.rotation_angle - placements_n[i].rotation_angle;
    state_.energies.external +=
        ((1. - before) * load.force + before * loads_n[i].force) *
            (placement.translation - placements_n[i].translation) +
        ((1. - before) * load.moment + before * loads_n[i].moment) * scene_.tools()[i].rotation_axis() * turn;
    state_.energies.contact += load.stored_energy;
    state_.energies.friction += load.dissipation;
    if (motion_ && motion_->has_mass(i))
      motion_->commit_tool(i, offsets_[i], exerted_load(i), scene_.tools()[i].load(t), state_.energies);
  }
  state_.time = t;
  state_.displacements = u_n_;
  const InternalForces::Energies &energies = trial_energies_;
  state_.energies.elastic = energies.elastic;
  state_.energies.plastic = energies.plastic;
  state_.energies.hourglass = energies.hourglass;
  if (!motion_)
    update_largest_energy();
  remove_tools(t);
  if (motion_) {
    motion_->update_state(state_);
    update_largest_energy();
  }
}

void QuasiStatic::update_largest_energy() {
  const EnergyLedger &energies = state_.energies;
  // As it is shown: what is there counts half, so that energy from nowhere does not hide itself.
  largest_energy_ = std::max(
      {largest_energy_, 0.5 * std::abs(energies.total()), std::abs(energies.initial + energies.external)});
}

void QuasiStatic::choose_unknown_tools(const std::vector<std::size_t> &tools) {
  unknown_tools_ = tools;
  const Epetra_BlockMap &dofs = as_epetra(u_n_).Map();
  std::vector<int> indices(dofs.MyGlobalElements(), dofs.MyGlobalElements() + dofs.NumMyElements());
  if (dofs.Comm().MyPID() == 0)
    for (std::size_t k = 0; k < tools.size(); ++k)
      indices.push_back(dofs.NumGlobalElements() + static_cast<int>(k));
  map_ = std::make_unique<Epetra_Map>(-1, static_cast<int>(indices.size()), indices.data(), 0, dofs.Comm());
}

Epetra_Vector QuasiStatic::pack(const Vector &displacements, const std::vector<double> &offsets) const {
  Epetra_Vector x(*map_);
  const Epetra_Vector &values = *displacements.trilinos_vector()(0);
  std::copy(values.Values(), values.Values() + values.MyLength(), x.Values());
  for (int i = values.MyLength(); i < x.MyLength(); ++i) {
    const std::size_t tool = unknown_tools_[static_cast<std::size_t>(i - values.MyLength())];
    x[i] = offsets[tool] * unit_of(tool);
  }
  return x;
}

Epetra_Vector QuasiStatic::unknowns() const { return pack(u_n_, offsets_n_); }

Placement QuasiStatic::place(const std::size_t tool, const double t, const double offset) const {
  return stopped_[tool] ? *stopped_[tool] : scene_.tools()[tool].placement(t, offset);
}

void QuasiStatic::place_tools(const double t) {
  for (auto &contact : contacts_)
    contact.set_placement(place(contact.tool(), t, offsets_[contact.tool()]));
}

double QuasiStatic::unit_of(const std::size_t tool) const {
  return scene_.tools()[tool].control() == Tool::Control::moment ? discretization_.radius() : 1.;
}

RigidContact::ToolRate QuasiStatic::rate_of(const std::size_t tool) const {
  if (scene_.tools()[tool].control() == Tool::Control::moment)
    return {{}, scene_.tools()[tool].rotation_axis() / unit_of(tool)};
  return {scene_.tools()[tool].force_direction(), {}};
}

double QuasiStatic::exerted_load(const std::size_t tool) const {
  ContactLoad load;
  for (const auto &contact : contacts_)
    if (contact.tool() == tool)
      load += contact.compute_load();
  const Tool &which = scene_.tools()[tool];
  return which.control() == Tool::Control::moment ? load.moment * which.rotation_axis()
                                                  : load.force * which.force_direction();
}

double QuasiStatic::excess_load(const std::size_t tool, const double t) const {
  return exerted_load(tool) - scene_.tools()[tool].load(t);
}

double QuasiStatic::imbalance(const std::size_t tool, const double t) const {
  if (!motion_ || !motion_->has_mass(tool))
    return excess_load(tool, t);
  return contact_weight() * exerted_load(tool) - scene_.tools()[tool].load(t) +
         motion_->tool_inertia(tool, offsets_[tool]);
}

void QuasiStatic::assemble_tool_tangent() {
  const std::size_t n = unknown_tools_.size();
  Usage::count_if(n > 0, Capability::driven_tools, n);
  tool_columns_.assign(n, discretization_.make_owned_vector());
  tool_rows_ = tool_columns_;
  tool_block_.reinit(n, n);
  tool_memory_.set(2 * n * discretization_.owned_dofs().n_elements() * sizeof(double));
  for (std::size_t k = 0; k < n; ++k) {
    Vector column = discretization_.make_additive_vector(), row = column;
    double slope = 0.;
    for (const auto &contact : contacts_)
      if (contact.tool() == unknown_tools_[k])
        slope += contact.add_tool_derivatives(rate_of(unknown_tools_[k]), column, row);
    column.compress(dealii::VectorOperation::add);
    row.compress(dealii::VectorOperation::add);
    const bool has_mass = motion_ && motion_->has_mass(unknown_tools_[k]);
    const double weight = has_mass ? contact_weight() : 1.;
    tool_columns_[k] = column;
    tool_columns_[k] *= contact_weight();
    tool_rows_[k] = row;
    tool_rows_[k] *= weight;
    supports_.condense(tool_columns_[k]);
    tool_block_(k, k) = weight * dealii::Utilities::MPI::sum(slope, discretization_.communicator());
    if (has_mass)
      tool_block_(k, k) +=
          motion_->tool_slope(unknown_tools_[k]) / (unit_of(unknown_tools_[k]) * unit_of(unknown_tools_[k]));
  }
}

bool QuasiStatic::solve_with_tools(const Vector &r_u, const std::vector<double> &r_s, const double sense,
                                   const double relative_tolerance, Vector &du, std::vector<double> &ds) {
  const auto solve = [this](const Vector &rhs, const double relative_tolerance, Vector &solution) {
    if (!linear_->solve(*rhs.trilinos_vector()(0), as_epetra(solution), relative_tolerance))
      return false;
    supports_.homogeneous().distribute(solution);
    return true;
  };
  if (!solve(r_u, relative_tolerance, du))
    return false;
  const std::size_t n = unknown_tools_.size();
  if (n == 0)
    return true;
  std::vector<Vector> Y(n, discretization_.make_owned_vector());
  dealii::FullMatrix<double> S(tool_block_);
  dealii::Vector<double> rhs(n), solution(n);
  for (std::size_t j = 0; j < n; ++j) {
    // Closer, since a tool may have far to go where the bodies' residual is small.
    if (!solve(tool_columns_[j], 1e-2 * relative_tolerance, Y[j]))
      return false;
    for (std::size_t i = 0; i < n; ++i)
      S(i, j) -= tool_rows_[i] * Y[j];
  }
  for (std::size_t i = 0; i < n; ++i) {
    rhs(i) = r_s[i] - tool_rows_[i] * du;
    if (tool_block_(i, i) != 0.)
      continue;
    // It touches nothing, and goes on until it does.
    const double way = distance_to_touch(unknown_tools_[i]);
    if (!std::isfinite(way)) {
      tool_failure_ =
          "tool '" + scene_.tools()[unknown_tools_[i]].name() +
          "' has a force or moment, but nothing that it touches, or could come to touch, resists it";
      return false;
    }
    S(i, i) = 1.;
    rhs(i) = sense * way;
  }
  S.gauss_jordan();
  S.vmult(solution, rhs);
  for (std::size_t j = 0; j < n; ++j) {
    ds[j] = solution(j);
    du.add(-ds[j], Y[j]);
  }
  return true;
}

double QuasiStatic::distance_to_touch(const std::size_t tool) const {
  double way = std::numeric_limits<double>::infinity();
  if (scene_.tools()[tool].control() != Tool::Control::moment)
    for (const auto &contact : contacts_)
      if (contact.tool() == tool)
        way = std::min(way, contact.distance_to_touch(scene_.tools()[tool].force_direction()));
  way = dealii::Utilities::MPI::min(way, discretization_.communicator());
  // A little more, so that it does.
  return way + 1e-6 * discretization_.radius();
}

std::vector<std::size_t> QuasiStatic::tools_to_stop(const double t) const {
  std::vector<std::size_t> result;
  const double tolerance = scene_.parameters().solver.force_tolerance;
  for (std::size_t i = 0; i < scene_.tools().size(); ++i)
    if (scene_.tools()[i].control() == Tool::Control::stop && !stopped_[i] && !fading_forces_[i] &&
        excess_load(i, t) > -tolerance * scene_.tools()[i].load(t))
      result.push_back(i);
  return result;
}

double QuasiStatic::fading(const double t, const std::size_t tool) const {
  const Tool &gone = scene_.tools()[tool];
  return gone.release_time() > 0. ? std::max(0., 1. - (t - gone.removal_time()) / gone.release_time()) : 0.;
}

void QuasiStatic::remove_tools(const double t) {
  std::map<std::size_t, std::set<std::string>> let_go; // names of the tools that each body loses now
  bool forces_jump = false;
  for (std::size_t i = 0; i < scene_.tools().size(); ++i) {
    if (t < scene_.tools()[i].removal_time() || fading_forces_[i])
      continue;
    Vector forces = discretization_.make_additive_vector();
    for (auto &contact : contacts_)
      if (contact.tool() == i) {
        if (contact.compute_load().area > 0.)
          let_go[contact.body()].insert(scene_.tools()[i].name());
        contact.add_forces(forces);
        contact.remove_tool();
      }
    forces.compress(dealii::VectorOperation::add);
    fading_forces_[i] = std::make_unique<Vector>(discretization_.make_owned_vector());
    *fading_forces_[i] = forces;
    // What its penalty springs held goes with it.
    state_.energies.external -= state_.tool_loads[i].stored_energy;
    state_.energies.contact -= state_.tool_loads[i].stored_energy;
    has_lost_pace_ = true;
    contact_forces_n_ -= *fading_forces_[i]; // it is contact no more
    if (motion_) {
      state_.energies.external -= motion_->remove_tool(i);
      const double jump = 1. - fading(t, i);
      support_forces_n_.add(-jump, *fading_forces_[i]);
      forces_jump = forces_jump || jump > 0.;
    }
  }
  if (forces_jump)
    update_accelerations();
  for (const auto &[body, removed] : let_go)
    if (body_failure_.empty() && !motion_ && !is_stabilised(body))
      body_failure_ = describe_freedom(body, removed);
}

std::optional<RigidMotion> QuasiStatic::find_freedom(const std::size_t body) const {
  std::vector<Resistance> resistances;
  for (const auto &entry : collect_held_nodes(scene_, discretization_)) {
    dealii::Tensor<1, 3> position = entry.second.position;
    for (unsigned int i = 0; i < 3; ++i)
      position[i] += state_.displacements(entry.second.dofs[i]);
    for (const auto &hold : scene_.bodies()[body].holds)
      if (std::count(entry.second.holds.begin(), entry.second.holds.end(), &hold) > 0)
        resistances.push_back({position, hold.normal, Resistance::Sense::both_ways});
  }
  for (const auto &contact : contacts_)
    if (contact.body() == body)
      contact.add_resistances(resistances);
  for (const auto &contact : body_contacts_)
    contact->add_resistances(body, resistances);

  // Those of all ranks, in the same order on each, so that all find the same.
  std::vector<double> numbers;
  for (const auto &[position, direction, sense] : resistances) {
    numbers.insert(numbers.end(), position.begin_raw(), position.end_raw());
    numbers.insert(numbers.end(), direction.begin_raw(), direction.end_raw());
    numbers.push_back(static_cast<double>(sense));
  }
  resistances.clear();
  BoundingBox box = BoundingBox::empty();
  for (const auto &part : dealii::Utilities::MPI::all_gather(discretization_.communicator(), numbers))
    for (auto x = part.begin(); x != part.end(); x += 7) {
      resistances.push_back({dealii::Tensor<1, 3>({x[0], x[1], x[2]}),
                             dealii::Tensor<1, 3>({x[3], x[4], x[5]}),
                             static_cast<Resistance::Sense>(static_cast<int>(x[6]))});
      box.add(resistances.back().position);
    }
  // Of what holds the body: where that is but a point, turns about it are free.
  const double size =
      resistances.empty() ? 1. : std::max((box.high - box.low).norm(), 1e-6 * discretization_.radius());
  return find_free_motion(resistances, 0.5 * (box.low + box.high), size);
}

void QuasiStatic::check_freedom() const {
  for (std::size_t body = 0; body < scene_.bodies().size(); ++body)
    if (const auto motion = is_stabilised(body) ? std::nullopt : find_freedom(body))
      throw InputError(
          scene_.parameters().bodies[body].origin +
          ": the body is without support: at the start neither supports, nor symmetry planes, "
          "nor tools or bodies that it touches hold its rigid motion with " +
          print(*motion) +
          ". Allowed in a static scene: none that is free; hold it, or let it touch at the start");
}

std::string QuasiStatic::describe_freedom(const std::size_t body,
                                          const std::set<std::string> &removed) const {
  const auto motion = find_freedom(body);
  if (!motion)
    return "";
  std::ostringstream message;
  message << scene_.parameters().file_name << ": at time " << state_.time << ", without ";
  for (const auto &name : removed)
    message << "tool '" << name << "', ";
  message
      << "which " << (removed.size() == 1 ? "is" : "are") << " removed then, body '"
      << scene_.bodies()[body].name
      << "' is left without support: neither supports, nor symmetry planes, nor tools that it touches hold "
         "its rigid motion with "
      << print(*motion)
      << ". Hold it there by a support or a symmetry plane, or let a tool stay. What was computed until "
         "time "
      << state_.time << " is in '" << scene_.parameters().output.folder.value << "'.";
  return message.str();
}

} // namespace billet
