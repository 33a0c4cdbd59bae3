// SPDX-License-Identifier: LGPL-2.1-or-later
// What QuasiStatic does in scenes of implicit dynamics only.
#include "billet/errors.h"
#include "billet/solve/quasi_static.h"

#include <Epetra_Vector.h>

#include <algorithm>
#include <cmath>
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
  contact_forces_n_ = contact_forces_;
  internal_forces_n_ = internal_forces_;
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
  control_penalties(); // learns of the motion at the start, and raises nothing yet
}

void QuasiStatic::update_accelerations() {
  matrix_ = 0.;
  motion_->add_mass({supports_.homogeneous(), matrix_});
  matrix_.compress(dealii::VectorOperation::add);
  Vector rhs = motion_->driving_forces(support_forces_n_),
         accelerations = discretization_.make_owned_vector();
  supports_.condense(rhs);
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
      motion_->start_tool(tool, exerted_load(tool), scene_.tools()[tool].load(state_.time));
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

namespace {

// Part of the largest energy that contact may make, and give back of what it took.
constexpr double may_make = 0.005;
// And that it may take in a step, but for friction.
constexpr double may_take = 0.01;

} // namespace

bool QuasiStatic::may_be_cut(const double t) const {
  const auto &stepping = scene_.parameters().time_stepping;
  constexpr double rounding = 1e-9;
  return stepping.control == parameters::TimeStepping::Control::automatic &&
         t - state_.time > stepping.smallest_step * (1. + rounding);
}

double QuasiStatic::largest_energy_of_trial() const {
  return std::max(largest_energy_, std::abs(trial_energies_.total()));
}

double QuasiStatic::energy_error(const double imbalance) const {
  constexpr double of_run = 0.02, of_rest = 0.05, always = 1e-4; // of the largest energy; of what is left
  const double largest = std::max(largest_energy_of_trial(), 0.5 * std::abs(state_.energies.total()));
  const double allowed =
      std::max(always * largest, of_rest * (of_run * largest - std::abs(element_balance_)));
  return allowed > 0. ? std::abs(imbalance) / allowed : 0.;
}

bool QuasiStatic::is_accurate(const double t, NewtonReport &report) {
  trial_energies_ = internal_.compute_energies(trial_ghosted_, Beat::evaluated);
  time_error_ = 0.;
  if (!motion_)
    return true;
  motion_->finish_contact(contact_forces_);
  time_error_ = motion_->step_error(trial_);
  std::ostringstream message;
  message.precision(3);
  message << "the error of the step's time integration is " << time_error_
          << " times the 'Error tolerance'. Try a smaller 'Smallest step' or a larger 'Error tolerance'";
  trial_imbalance_ = element_imbalance().unexplained;
  if (may_be_cut(t)) {
    const double error = energy_error(trial_imbalance_);
    if (error > std::max(1., time_error_)) {
      message.str("");
      message << "the work of the elements' forces in the step differs from their energy by " << error
              << " times what is allowed. Try a smaller 'Smallest step'";
    }
    time_error_ = std::max(time_error_, error);
  }
  if (time_error_ <= 1.)
    return true;
  report.converged = false;
  report.is_explained = true;
  report.failure = message.str();
  return false;
}

QuasiStatic::ContactLoss QuasiStatic::contact_loss(const double t) const {
  const double before = contact_before();
  Vector mean = contact_forces_, increment = trial_;
  mean *= 1. - before;
  mean.add(before, contact_forces_n_);
  increment -= u_n_;
  ContactLoss loss;
  loss.total = mean * increment + state_.energies.contact;
  std::vector<ContactLoad> loads(scene_.tools().size());
  for (const auto &contact : contacts_)
    loads[contact.tool()] += contact.compute_load();
  for (std::size_t i = 0; i < loads.size(); ++i) {
    if (fading_forces_[i])
      continue;
    const ContactLoad &load = loads[i], &load_n = state_.tool_loads[i];
    const Placement to = place(i, t, offsets_[i]);
    loss.total += ((1. - before) * load.force + before * load_n.force) *
                      (to.translation - state_.placements[i].translation) +
                  ((1. - before) * load.moment + before * load_n.moment) * scene_.tools()[i].rotation_axis() *
                      (to.rotation_angle - state_.placements[i].rotation_angle) -
                  load.stored_energy - load.dissipation;
    loss.friction += load.damping;
  }
  for (const auto &contact : body_contacts_) {
    const ContactLoad load = contact->compute_load();
    loss.total -= load.stored_energy + load.dissipation;
    loss.friction += load.damping;
  }
  const StepWorks works = compute_step_works();
  loss.total += works.ramp + (motion_ ? 0. : works.touching);
  return loss;
}

void QuasiStatic::choose_contact_damping() {
  if (!motion_)
    return;
  bare_forces_n_ = support_forces_n_;
  if (motion_->damps_contact() && contact_forces_n_.l2_norm() == 0.)
    motion_->release_contact();
  else if (motion_->damps_contact())
    damp_contact();
}

void QuasiStatic::damp_contact() {
  bare_forces_n_ = support_forces_n_;
  bare_forces_n_ -= contact_forces_n_;
  motion_->damp_contact(contact_forces_n_);
}

double QuasiStatic::taken_by_contact(const ContactLoss &loss) const {
  return std::max(0., motion_->damps_contact()
                          ? loss.total
                          : contact_balance_ + loss.total - may_make * largest_energy_of_trial());
}

bool QuasiStatic::contact_is_out_of_balance(const double t, NewtonReport &report) {
  if (!motion_)
    return false;
  update_largest_energy();
  const double largest = largest_energy_of_trial(); // in the first step there has been none before
  const ContactLoss loss = contact_loss(t);
  report.makes_energy = !motion_->damps_contact() && contact_balance_ + loss.total < -may_make * largest;
  // So long a step that bodies meet in it, rather than at its end.
  const bool takes_too_much = taken_by_contact(loss) - loss.friction > may_take * largest && may_be_cut(t);
  if (!report.makes_energy && !takes_too_much)
    return false;
  report.converged = false;
  report.is_explained = takes_too_much;
  report.failure =
      std::string("contact ") + (report.makes_energy ? "makes" : "takes") + " energy in the step";
  return true;
}

bool QuasiStatic::meets_too_early(const double t, NewtonReport &report) {
  constexpr double most = 0.1; // facet sizes
  if (!motion_ || !may_be_cut(t))
    return false;
  const std::vector<double> closings =
      of_contacts([](const auto &contact) { return contact.closing_of_new_contacts(); });
  const double largest =
      dealii::Utilities::MPI::max(closings.empty() ? 0. : *std::max_element(closings.begin(), closings.end()),
                                  discretization_.communicator());
  if (!(largest > most))
    return false;
  std::ostringstream text;
  text.precision(3);
  text << "nodes close by " << largest << " facet sizes in the step in which they touch, allowed are "
       << most;
  report.converged = false;
  report.is_explained = true;
  report.failure = text.str();
  return true;
}

void QuasiStatic::book_contact(const ContactLoss &loss) {
  const double taken = taken_by_contact(loss);
  if (motion_->damps_contact()) {
    const double by_friction = std::min(taken, loss.friction);
    contact_losses_.add(ContactLosses::friction, by_friction);
    contact_losses_.add(ContactLosses::impacts, taken - by_friction);
  } else
    contact_losses_.add(ContactLosses::crossings, taken);
  contact_balance_ += loss.total - taken;
  state_.energies.numerical += taken;
  // Areas that change take energy at one time and give it back at another.
  const double returned = contact_losses_.give_back(std::max(0., -contact_balance_));
  contact_balance_ += returned;
  state_.energies.numerical -= returned;
}

} // namespace billet
