// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/quasi_static.h"

#include "billet/errors.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <Epetra_Vector.h>

#include <algorithm>
#include <limits>

namespace billet {

namespace {

Epetra_Vector &as_epetra(Vector &vector) { return *vector.trilinos_vector()(0); }

} // namespace

QuasiStatic::QuasiStatic(const Scene &scene, const Discretization &discretization)
    : scene_(scene), discretization_(discretization), supports_(scene, discretization),
      internal_(scene, discretization) {
  for (std::size_t p = 0; p < scene.pairs().size(); ++p)
    contacts_.emplace_back(scene, p, discretization, scene.contact_tangent());
  build_matrix();
  direct_ = make_direct_solver(scene.parameters().solver.linear_solver.value,
                               !scene.capabilities().unsymmetric_matrix, matrix_.trilinos_matrix(),
                               discretization.communicator());

  trial_ = u_n_ = last_increment_ = support_forces_ = support_forces_n_ = discretization.make_owned_vector();
  trial_ghosted_ = state_.displacements = discretization.make_ghosted_vector();
  raw_internal_ = discretization.make_additive_vector();
  raw_contact_ = discretization.make_additive_vector();

  double stiffest = 0.;
  for (const auto &body : scene.bodies())
    stiffest = std::max(stiffest, body.young_modulus);
  // A hundred times the force that the last bit of a displacement of the scene's size makes.
  round_off_force_ = 100. * std::numeric_limits<double>::epsilon() * stiffest * discretization.radius() *
                     discretization.radius();

  state_.tool_loads.resize(scene.tools().size());
  for (const auto &tool : scene.tools())
    state_.placements.push_back(tool.placement(0.));
  // Prescribed displacements hold at time 0, too.
  check_before_start([&] {
    supports_.at_time(0.).distribute(u_n_);
    supports_.at_time(scene.parameters().time_stepping.end_time);
  });
  state_.displacements = u_n_;
}

void QuasiStatic::build_matrix() {
  const auto &owned = discretization_.owned_dofs();
  dealii::TrilinosWrappers::SparsityPattern pattern(owned, owned, discretization_.relevant_dofs(),
                                                    discretization_.communicator());
  dealii::DoFTools::make_sparsity_pattern(
      discretization_.dof_handler(), pattern, supports_.homogeneous(), false,
      dealii::Utilities::MPI::this_mpi_process(discretization_.communicator()));
  pattern.compress();
  matrix_.reinit(pattern);
}

std::array<std::size_t, 2> QuasiStatic::history_sizes() const {
  std::array<std::size_t, 2> sizes = {{internal_.history_size(), 0}};
  for (const auto &contact : contacts_)
    sizes[1] += contact.history_size();
  for (auto &size : sizes)
    size = dealii::Utilities::MPI::sum(size, discretization_.communicator());
  return sizes;
}

bool QuasiStatic::all_ranks(const bool success) const {
  return dealii::Utilities::MPI::min(success ? 1 : 0, discretization_.communicator()) == 1;
}

void QuasiStatic::set_trial(const Epetra_Vector &x) {
  as_epetra(trial_) = x;
  trial_ghosted_ = trial_;
}

void QuasiStatic::condense(Vector &forces) const {
  // On this rank's own values: to write through deal.II's vector would make ranks wait for each other that do
  // not hold as many constraints.
  Epetra_Vector &values = as_epetra(forces);
  const auto place = [&values](const DofIndex dof) { return values.Map().LID(static_cast<int>(dof)); };
  for (const auto &line : supports_.homogeneous().get_lines()) {
    if (!discretization_.owned_dofs().is_element(line.index))
      continue;
    double &force = values[place(line.index)];
    // The dofs of a node have one owner, and constraints couple dofs of one node only.
    for (const auto &entry : line.entries)
      values[place(entry.first)] += entry.second * force;
    force = 0.;
  }
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
  raw_contact_.compress(dealii::VectorOperation::add);

  support_forces_ = raw_internal_;
  force_scale_ = support_forces_.l2_norm();
  Vector total = support_forces_;
  support_forces_ = raw_contact_;
  force_scale_ = std::max(force_scale_, support_forces_.l2_norm());
  total += support_forces_;
  support_forces_ = total;
  condense(total);
  residual = as_epetra(total);
  return std::isfinite(force_scale_);
}

bool QuasiStatic::compute_tangent(const Epetra_Vector &x) {
  set_trial(x);
  return assemble_tangent({supports_.homogeneous(), matrix_});
}

bool QuasiStatic::assemble_tangent(const TangentSystem &system) {
  system.matrix = 0.;
  if (!all_ranks(internal_.assemble_tangent(trial_ghosted_, system)))
    return false;
  for (auto &contact : contacts_) {
    contact.update(trial_ghosted_);
    contact.add_tangent(system);
  }
  system.matrix.compress(dealii::VectorOperation::add);
  return direct_->factorize();
}

bool QuasiStatic::solve_tangent(const Epetra_Vector &residual, Epetra_Vector &dx) {
  if (!direct_->solve(residual, dx))
    return false;
  Vector correction = discretization_.make_owned_vector();
  as_epetra(correction) = dx;
  supports_.homogeneous().distribute(correction);
  dx = as_epetra(correction);
  return std::isfinite(correction.l2_norm());
}

bool QuasiStatic::continue_increment(const double t, const double previous_step) {
  const double ratio = (t - state_.time) / previous_step;
  // Where tools or supports do not go on as they went, the last increment says little.
  constexpr double largest_jump = 0.1;
  const double t_n = state_.time;
  for (const auto &tool : scene_.tools()) {
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
  for (auto &contact : contacts_)
    contact.start_step(t_n, t_n);
  Vector correction = discretization_.make_owned_vector(), rhs = correction;
  if (!compute_residual(as_epetra(u_n_), as_epetra(rhs)))
    return false;
  rhs *= -1.;
  Vector pushes = discretization_.make_additive_vector(), lift = pushes;
  for (const auto &contact : contacts_)
    contact.add_tool_push(t, pushes);
  pushes.compress(dealii::VectorOperation::add);
  Vector push = correction;
  push = pushes;
  condense(push);
  rhs += push;
  if (!assemble_tangent({change, matrix_, &lift}))
    return false;
  lift.compress(dealii::VectorOperation::add);
  push = lift;
  rhs += push;
  if (!direct_->solve(as_epetra(rhs), as_epetra(correction)))
    return false;
  iteration = {1., std::abs(rhs * correction), 1.};
  change.distribute(correction);
  trial_ = u_n_;
  trial_ += correction;
  supports_.at_time(t).distribute(trial_);
  return std::isfinite(trial_.l2_norm());
}

void QuasiStatic::start_step(const double t) {
  for (auto &contact : contacts_)
    contact.start_step(state_.time, t);
}

NewtonReport QuasiStatic::step(const double t, const double previous_step) {
  NewtonReport report;
  const bool may_continue =
      scene_.parameters().solver.predictor == parameters::Solver::Predictor::extrapolation &&
      previous_step > 0. && continue_increment(t, previous_step);
  NewtonIteration linear_step{};
  const bool has_guess = may_continue || follow_tangent(t, linear_step);
  start_step(t);
  if (!has_guess) {
    report.failure = direct_->failure().empty() ? "the first guess is not admissible" : direct_->failure();
    return report;
  }
  Vector x = trial_;
  report = solve_newton(*this, scene_.parameters().solver, as_epetra(u_n_), as_epetra(x));
  if (!may_continue)
    report.iterations.insert(report.iterations.begin(), linear_step); // it costs what an iteration costs
  if (report.converged) {
    // The line search may have looked further since: the histories have to be those of the accepted state.
    Epetra_Vector residual(as_epetra(x));
    compute_residual(as_epetra(x), residual);
    commit(t);
  }
  return report;
}

void QuasiStatic::commit(const double t) {
  last_increment_ = trial_;
  last_increment_ -= u_n_;
  u_n_ = trial_;
  internal_.commit();

  // Work of the supports and of the tools, by the trapezoidal rule.
  Vector mean_support_forces = support_forces_;
  mean_support_forces += support_forces_n_;
  state_.energies.external += 0.5 * (mean_support_forces * last_increment_);
  support_forces_n_ = support_forces_;

  const std::vector<ContactLoad> loads_n = state_.tool_loads;
  const std::vector<Placement> placements_n = state_.placements;
  std::fill(state_.tool_loads.begin(), state_.tool_loads.end(), ContactLoad());
  for (auto &contact : contacts_) {
    state_.tool_loads[contact.tool()] += contact.compute_load();
    contact.commit();
  }
  state_.energies.contact = 0.;
  for (std::size_t i = 0; i < state_.tool_loads.size(); ++i) {
    const ContactLoad &load = state_.tool_loads[i];
    Placement &placement = state_.placements[i];
    placement = scene_.tools()[i].placement(t);
    const double turn = placement.rotation_angle - placements_n[i].rotation_angle;
    state_.energies.external +=
        0.5 * ((load.force + loads_n[i].force) * (placement.translation - placements_n[i].translation) +
               (load.moment + loads_n[i].moment) * scene_.tools()[i].rotation_axis() * turn);
    state_.energies.contact += load.stored_energy;
    state_.energies.friction += load.dissipation;
  }
  state_.time = t;
  state_.displacements = u_n_;
  const auto energies = internal_.compute_energies(state_.displacements);
  state_.energies.elastic = energies.elastic;
  state_.energies.plastic = energies.plastic;
}

} // namespace billet
