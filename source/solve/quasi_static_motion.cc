// SPDX-License-Identifier: LGPL-2.1-or-later
// What QuasiStatic does in scenes of implicit dynamics only.
#include "billet/errors.h"
#include "billet/solve/quasi_static.h"

#include <Epetra_Vector.h>

#include <sstream>

namespace billet {

void QuasiStatic::start_motion() {
  check_before_start([&] {
    Epetra_Vector x = unknowns(), ignored(x);
    if (!compute_residual(x, ignored))
      throw SolutionFailure(scene_.parameters().file_name +
                            ": the displacements that supports prescribe at time 0 turn an element inside "
                            "out; allowed are small ones: the rest of the body starts undeformed");
  });
  support_forces_n_ = support_forces_;
  for (const auto &contact : contacts_)
    state_.tool_loads[contact.tool()] += contact.compute_load();
  check_before_start([&] { update_accelerations(); });

  const auto energies = internal_.compute_energies(state_.displacements);
  state_.energies.elastic = energies.elastic;
  state_.energies.hourglass = energies.hourglass;
  for (const auto &load : state_.tool_loads)
    state_.energies.contact += load.stored_energy;
  for (std::size_t i = 0; i < body_contacts_.size(); ++i) {
    state_.body_pair_loads[i] = body_contacts_[i]->compute_load();
    state_.energies.contact += state_.body_pair_loads[i].stored_energy;
  }
  motion_->update_state(state_);
  state_.energies.initial = state_.energies.total();
}

void QuasiStatic::update_accelerations() {
  matrix_ = 0.;
  motion_->add_mass({supports_.homogeneous(), matrix_});
  matrix_.compress(dealii::VectorOperation::add);
  Vector rhs = motion_->driving_forces(support_forces_n_),
         accelerations = discretization_.make_owned_vector();
  condense(rhs);
  if (linear_->is_iterative()) {
    linear_->start_contact({}); // there is none in the mass
    linear_->set_geometry(nodal_geometry());
  }
  constexpr double tolerance = 1e-10;
  if (!linear_->factorize() ||
      !linear_->solve(*rhs.trilinos_vector()(0), *accelerations.trilinos_vector()(0), tolerance)) {
    std::ostringstream message;
    message << scene_.parameters().file_name << ": at time " << state_.time
            << " the mass matrix cannot be solved for the accelerations: " << linear_->failure()
            << "; are the densities of the right unit?";
    throw SolutionFailure(message.str());
  }
  supports_.homogeneous().distribute(accelerations);
  motion_->set_accelerations(accelerations);
  for (std::size_t tool = 0; tool < scene_.tools().size(); ++tool)
    if (motion_->has_mass(tool))
      motion_->start_tool(tool, excess_load(tool, state_.time));
}

bool QuasiStatic::extrapolate_motion(const double t) {
  Vector guess = u_n_;
  offsets_ = offsets_n_;
  motion_->start_step(state_.time, t, u_n_, offsets_n_);
  motion_->extrapolate(guess, offsets_);
  supports_.at_time(t).distribute(guess);
  const std::vector<double> offsets = offsets_;
  start_step(t);

  Epetra_Vector residual(*map_);
  if (!compute_residual(pack(guess, offsets), residual))
    return false;
  double at_guess = 0., at_start = 0.;
  residual.Norm2(&at_guess);
  if (!compute_residual(pack(u_n_, offsets_n_), residual))
    return false;
  residual.Norm2(&at_start);
  trial_ = guess;
  offsets_ = offsets;
  return at_guess <= at_start;
}

bool QuasiStatic::is_accurate(NewtonReport &report) {
  time_error_ = motion_ ? motion_->step_error(trial_) : 0.;
  if (time_error_ <= 1.)
    return true;
  report.converged = false;
  std::ostringstream message;
  message << "the error of the step's time integration is " << time_error_ << " times the 'Error tolerance'";
  report.failure = message.str();
  return false;
}

} // namespace billet
