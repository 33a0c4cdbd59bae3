// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit_motion.h"

#include "billet/errors.h"
#include "billet/usage.h"

#include <deal.II/lac/solver_cg.h>

#include <Epetra_Vector.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace billet {

using dealii::Tensor;

ImplicitMotion::ImplicitMotion(const Scene &scene, const Discretization &discretization,
                               const Supports &supports)
    : scene_(scene), discretization_(discretization), supports_(supports),
      parameters_(scene.parameters().implicit_dynamics), integrator_(parameters_.integrator),
      nodes_(discretization),
      inertia_(scene, discretization, parameters_.mass == parameters::ImplicitDynamics::Mass::lumped) {
  if (std::any_of(scene.bodies().begin(), scene.bodies().end(),
                  [](const Body &body) { return !body.loads.empty(); }))
    loads_ = std::make_unique<ExternalLoads>(scene, nodes_, inertia_.nodal_masses(nodes_));
  for (std::size_t i = 0; i < scene.tools().size(); ++i) {
    const auto &motion = scene.parameters().tools[i].motion;
    tools_.emplace_back();
    if (!scene.tools()[i].is_driven())
      continue;
    tools_.back().inertia = motion.inertia;
    tools_.back().rate = motion.initial_rate;
  }

  u_n_ = v_n_ = a_n_ = a_bare_ = bare_forces_n_ = c_ = lumped_ = discretization.make_owned_vector();
  lumped_ = 1.;
  lumped_ = inertia_.times(ghosted(lumped_));
  load_forces_n_ = load_forces_ = held_change_ = u_n_;
  fail_together(discretization.communicator(), [&] {
    check_before_start([&] {
      for (std::size_t b = 0; b < discretization.n_bodies(); ++b)
        for (const auto &element : nodes_.elements(b))
          for (const unsigned int node : element)
            for (unsigned int i = 0; i < 3; ++i) {
              const DofIndex dof = nodes_.dofs(node)[i];
              if (discretization.owned_dofs().is_element(dof))
                v_n_(dof) = scene.bodies()[b].initial_velocity[i].value(
                    0., dealii::Point<3>(get_vector(nodes_.positions().data(), node)));
            }
    });
  });
  v_n_.compress(dealii::VectorOperation::insert);
  check_before_start([&] { held_n_ = find_held_rates(0., scene.parameters().time_stepping.initial_step); });
  held_ = held_n_;
  supports_.homogeneous().distribute(v_n_);
  v_n_ += held_n_.velocity;
  v_ = v_n_;
  a_ = a_n_;
  Vector positions = discretization.make_owned_vector();
  body_axes_.resize(discretization.owned_dofs().n_elements());
  for (std::size_t b = 0; b < discretization.n_bodies(); ++b)
    for (const auto &element : nodes_.elements(b))
      for (const unsigned int node : element)
        for (unsigned int i = 0; i < 3; ++i) {
          const DofIndex dof = nodes_.dofs(node)[i];
          if (!discretization.owned_dofs().is_element(dof))
            continue;
          positions(dof) = get_vector(nodes_.positions().data(), node)[i];
          body_axes_[discretization.owned_dofs().index_within_set(dof)] = {b, i};
        }
  positions.compress(dealii::VectorOperation::insert);
  for (const Spread &spread : spread_of_bodies(positions))
    if (spread.mass > 0.)
      largest_gyration_ = std::max(largest_gyration_, std::sqrt(spread.square / spread.mass));
  constexpr std::size_t n_fields =
      13; // displacements, velocities, accelerations, forces and rates of both ends
  inertia_memory_.set(n_fields * discretization.owned_dofs().n_elements() * sizeof(double));
  error_memory_.set(parameters_.error_tolerance > 0. ? sizeof(largest_displacement_) : 0);
}

void ImplicitMotion::save(StateWriter &writer, const OwnedNodes &nodes) const {
  save_nodal(writer, "velocities", nodes, v_n_);
  save_nodal(writer, "accelerations", nodes, a_n_);
  save_nodal(writer, "load forces", nodes, load_forces_n_);
  save_nodal(writer, "held velocities", nodes, held_n_.velocity);
  save_nodal(writer, "held accelerations", nodes, held_n_.acceleration);
  writer.write("largest displacement", {largest_displacement_});
}

void ImplicitMotion::load(const StateReader &reader, const OwnedNodes &nodes) {
  load_nodal(reader, "velocities", nodes, v_n_);
  load_nodal(reader, "accelerations", nodes, a_n_);
  load_nodal(reader, "load forces", nodes, load_forces_n_);
  load_nodal(reader, "held velocities", nodes, held_n_.velocity);
  load_nodal(reader, "held accelerations", nodes, held_n_.acceleration);
  largest_displacement_ = reader.number("largest displacement");
  held_ = held_n_;
  v_ = v_n_;
  a_ = a_n_;
}

void ImplicitMotion::save_tool(const std::size_t tool, StateWriter &writer) const {
  const HeavyTool &heavy = tools_[tool];
  if (heavy.inertia == 0.)
    return;
  writer.write("rate", {heavy.rate});
  writer.write("acceleration", {heavy.acceleration, heavy.exerted, heavy.load});
}

void ImplicitMotion::load_tool(const std::size_t tool, const StateReader &reader, const bool is_exact) {
  HeavyTool &heavy = tools_[tool];
  if (heavy.inertia == 0.)
    return;
  if (reader.read("flags").at(1) != 0.) { // gone
    heavy = HeavyTool();
    return;
  }
  if (reader.has("rate"))
    heavy.rate = reader.number("rate");
  if (is_exact) {
    heavy.acceleration = reader.read("acceleration").at(0);
    heavy.exerted = reader.read("acceleration").at(1);
    heavy.load = reader.read("acceleration").at(2);
  }
}

void ImplicitMotion::begin(const StateReader &reader, const OwnedNodes &nodes, const double t) {
  if (reader.has("velocities"))
    load_nodal(reader, "velocities", nodes, v_n_);
  held_n_ = find_held_rates(t, scene_.parameters().time_stepping.initial_step);
  supports_.homogeneous().distribute(v_n_);
  v_n_ += held_n_.velocity;
  held_ = held_n_;
  v_ = v_n_;
}

Vector ImplicitMotion::held_change(const double from, const double to) const {
  Vector change = discretization_.make_owned_vector();
  bool moves = false;
  supports_.change(from, to, moves).distribute(change);
  return change;
}

ImplicitMotion::HeldRates ImplicitMotion::find_held_rates(const double t, const double step) const {
  HeldRates rates{discretization_.make_owned_vector(), discretization_.make_owned_vector()};
  if (!scene_.capabilities().moving_supports)
    return rates;
  // A parabola through three times within the run, about t where that is possible.
  const double end = scene_.parameters().time_stepping.end_time, h = std::min(step, 0.5 * end);
  const double middle = std::clamp(t, h, end - h);
  const Vector before = held_change(middle - h, middle);
  rates.velocity = held_change(middle, middle + h);
  rates.acceleration = rates.velocity;
  rates.acceleration -= before;
  rates.acceleration /= h * h;
  rates.velocity += before;
  rates.velocity /= 2. * h;
  rates.velocity.add(t - middle, rates.acceleration);
  return rates;
}

Vector ImplicitMotion::ghosted(const Vector &owned) const {
  Vector result = discretization_.make_ghosted_vector();
  result = owned;
  return result;
}

NodalVectors ImplicitMotion::nodal(const Vector &field) const {
  NodalVectors result = nodes_.make_vectors();
  const Vector values = ghosted(field);
  for (unsigned int node = 0; node < nodes_.size(); ++node)
    for (unsigned int i = 0; i < 3; ++i)
      result[std::size_t{nodal_stride} * node + i] = values(nodes_.dofs(node)[i]);
  return result;
}

double ImplicitMotion::mean_size(const Vector &field) const {
  return std::sqrt(std::max(0., field * inertia_.times(ghosted(field))) / inertia_.total());
}

std::vector<ImplicitMotion::Spread> ImplicitMotion::spread_of_bodies(const Vector &field) const {
  constexpr std::size_t n_sums = 7; // of each body Σ m x and Σ m by axis, Σ m x²
  std::vector<double> sums(n_sums * discretization_.n_bodies());
  std::size_t k = 0;
  for (const DofIndex dof : discretization_.owned_dofs()) {
    const BodyAxis at = body_axes_[k++];
    double *sum = &sums[n_sums * at.body];
    const double x = field(dof), m = lumped_(dof);
    sum[at.axis] += m * x;
    sum[3 + at.axis] += m;
    sum[6] += m * x * x;
  }
  dealii::Utilities::MPI::sum(sums, discretization_.communicator(), sums);
  std::vector<Spread> spreads;
  for (std::size_t body = 0; body < discretization_.n_bodies(); ++body) {
    const double *sum = &sums[n_sums * body];
    double square = sum[6];
    for (unsigned int i = 0; i < 3; ++i)
      square -= sum[3 + i] > 0. ? sum[i] * sum[i] / sum[3 + i] : 0.;
    spreads.push_back({std::max(0., square), sum[3]});
  }
  return spreads;
}

double ImplicitMotion::displacement_to_resolve(const Vector &displacements) const {
  constexpr double least = 1e-6; // of the scene's radius: at the start nothing has moved yet
  double own = 0.;
  for (const Spread &spread : spread_of_bodies(displacements))
    own += spread.square;
  return std::max({std::sqrt(own / inertia_.total()), std::min(mean_size(displacements), largest_gyration_),
                   least * discretization_.radius()});
}

Vector ImplicitMotion::driving_forces(const Vector &forces) const {
  Vector result = inertia_.times(ghosted(held_n_.acceleration));
  result += forces;
  result *= -1.;
  return result;
}

void ImplicitMotion::set_accelerations(const Vector &accelerations) {
  a_n_ = accelerations;
  a_n_ += held_n_.acceleration;
  load_forces_n_ = load_forces_;
}

void ImplicitMotion::start_tool(const std::size_t tool, const double exerted, const double load) {
  HeavyTool &heavy = tools_[tool];
  heavy.exerted = exerted;
  heavy.load = load;
  heavy.acceleration = (load - exerted) / heavy.inertia;
}

namespace {

/// x -> CᵀMC x of the dofs that are free, C the homogeneous constraints.
struct CondensedMass {
  const Inertia &inertia;
  const Supports &supports;
  Vector &ghosted;

  void vmult(Vector &result, const Vector &x) const {
    Vector all = x;
    supports.homogeneous().distribute(all);
    ghosted = all;
    result = inertia.times(ghosted);
    supports.condense(result);
  }
};

/// Divides by the row sums.
struct LumpedMass {
  const Vector &row_sums;

  void vmult(Vector &result, const Vector &x) const {
    result = x;
    Epetra_Vector &values = *result.trilinos_vector()(0);
    values.ReciprocalMultiply(1., *row_sums.trilinos_vector()(0), values, 0.);
  }
};

} // namespace

Vector ImplicitMotion::accelerations_by(const Vector &forces) const {
  Vector rhs = forces, result = discretization_.make_owned_vector();
  rhs *= -1.;
  supports_.condense(rhs);
  const double size = rhs.l2_norm();
  if (size == 0.)
    return result;
  // The mass over its row sums has eigenvalues from 1/27 to 1 in bricks: some thirty iterations.
  constexpr double relative_tolerance = 1e-12;
  constexpr unsigned int most_iterations = 1000;
  dealii::SolverControl control(most_iterations, relative_tolerance * size, false, false);
  dealii::SolverCG<Vector> solver(control);
  Vector scratch = discretization_.make_ghosted_vector();
  try {
    solver.solve(CondensedMass{inertia_, supports_, scratch}, result, rhs, LumpedMass{lumped_});
  } catch (const dealii::SolverControl::NoConvergence &) {
    // By round-off, in bodies whose densities differ by very much: what is missing is of that size.
  }
  supports_.homogeneous().distribute(result);
  return result;
}

void ImplicitMotion::choose_contact_damping(const ForceState &start) {
  bare_forces_n_ = start.supports;
  if (damps_contact_ && start.contact.l2_norm() == 0.)
    damps_contact_ = false;
  else if (damps_contact_)
    damp_contact(start);
}

void ImplicitMotion::damp_contact(const ForceState &start) {
  bare_forces_n_ = start.supports;
  bare_forces_n_ -= start.contact;
  damps_contact_ = true;
  a_bare_ = a_n_;
  a_bare_ -= accelerations_by(start.contact);
}

void ImplicitMotion::finish_contact(const Vector &contact_forces) {
  if (damps_contact_)
    c_ = accelerations_by(contact_forces);
}

Vector ImplicitMotion::end_accelerations() const {
  Vector result = a_;
  if (damps_contact_)
    result.add(1. - 1. / integrator_.gamma(), c_);
  return result;
}

void ImplicitMotion::start_step(const double t_n, const double t, const Vector &displacements,
                                const std::vector<double> &offsets) {
  if (t_n_ == t_n && step_ == t - t_n)
    return;
  Usage::count(Capability::inertia, displacements.locally_owned_size());
  t_n_ = t_n;
  step_ = t - t_n;
  u_n_ = displacements;
  for (std::size_t i = 0; i < tools_.size(); ++i)
    tools_[i].offset = offsets[i];
  held_ = find_held_rates(t, step_);
  if (scene_.capabilities().moving_supports)
    held_change_ = held_change(t_n, t);
  // Ten times what the last bit of each displacement, or offset, makes.
  const double last_bit = 10. * std::numeric_limits<double>::epsilon() * integrator_.mass_factor(step_);
  const double n_nodes = static_cast<double>(discretization_.dof_handler().n_dofs()) / 3.;
  round_off_force_ = last_bit * inertia_.total() / std::sqrt(n_nodes) *
                     std::max(displacements.linfty_norm(), step_ * v_n_.linfty_norm());
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const double length =
        scene_.tools()[i].control() == Tool::Control::moment ? 1. / discretization_.radius() : 1.;
    round_off_force_ += last_bit * tools_[i].inertia * length *
                        std::max(std::abs(tools_[i].offset), step_ * std::abs(tools_[i].rate));
  }
}

void ImplicitMotion::extrapolate(Vector &displacements, std::vector<double> &offsets) const {
  displacements.add(step_, v_n_, 0.5 * step_ * step_, a_n_);
  for (std::size_t i = 0; i < tools_.size(); ++i)
    offsets[i] += step_ * (tools_[i].rate + 0.5 * step_ * tools_[i].acceleration);
}

void ImplicitMotion::set_rates(const Vector &displacements) {
  Vector increment = displacements;
  increment -= u_n_;
  const auto set = [&](const TimeIntegrator::Rate &weights, const Vector &held, Vector &rate) {
    rate = increment;
    rate *= weights.increment;
    rate.add(weights.velocity, v_n_, weights.acceleration, start_accelerations());
    if (scene_.capabilities().moving_supports) {
      supports_.homogeneous().distribute(rate);
      rate += held;
    }
  };
  set(integrator_.velocity(step_), held_.velocity, v_);
  set(integrator_.acceleration(step_), held_.acceleration, a_);
}

double ImplicitMotion::add_loads(const double t, const Vector &displacements, Vector &residual) {
  if (step_ > 0.)
    set_rates(displacements);
  if (loads_ == nullptr)
    return 0.;
  displaced_ = nodal(displacements);
  const NodalVectors velocities = nodal(v_);
  NodalVectors forces = nodes_.make_vectors();
  fail_together(discretization_.communicator(),
                [&] { loads_->add_forces(t, displaced_, velocities, forces); });
  Vector sum = discretization_.make_additive_vector();
  for (unsigned int node = 0; node < nodes_.size(); ++node)
    sum.add(3, nodes_.dofs(node).data(), &forces[std::size_t{nodal_stride} * node]);
  sum.compress(dealii::VectorOperation::add);
  load_forces_ = sum;
  residual -= load_forces_;
  return load_forces_.l2_norm();
}

double ImplicitMotion::complete(const Vector &contact, Vector &residual) const {
  residual.add(contact_weight() - 1., contact);
  if (step_ == 0.)
    return 0.;
  Vector weighted = a_;
  weighted *= integrator_.inertia_now();
  weighted.add(integrator_.inertia_before(), start_accelerations());
  const Vector inertia = inertia_.times(ghosted(weighted));
  residual += inertia;
  if (integrator_.forces_before() != 0.)
    residual.add(integrator_.forces_before(), bare_forces_n_);
  return inertia.l2_norm();
}

void ImplicitMotion::add_tangent(const double t, const TangentSystem &system) const {
  inertia_.add_tangent(integrator_.mass_factor(step_), system);
  if (loads_ != nullptr)
    loads_->add_tangent(t, displaced_, integrator_.damping_factor(step_), system);
}

double ImplicitMotion::accelerate(const HeavyTool &tool, const double offset) const {
  const TimeIntegrator::Rate weights = integrator_.acceleration(step_);
  return weights.increment * (offset - tool.offset) + weights.velocity * tool.rate +
         weights.acceleration * start_acceleration(tool);
}

double ImplicitMotion::tool_inertia(const std::size_t tool, const double offset) const {
  const HeavyTool &heavy = tools_[tool];
  if (heavy.inertia == 0.)
    return 0.;
  return integrator_.forces_before() * ((damps_contact_ ? 0. : heavy.exerted) - heavy.load) +
         heavy.inertia * (integrator_.inertia_now() * accelerate(heavy, offset) +
                          integrator_.inertia_before() * start_acceleration(heavy));
}

double ImplicitMotion::tool_slope(const std::size_t tool) const {
  return tools_[tool].inertia * integrator_.mass_factor(step_);
}

double ImplicitMotion::step_error(const Vector &displacements) const {
  if (parameters_.error_tolerance == 0.)
    return 0.;
  Usage::count(Capability::error_control, 1);
  Vector change = end_accelerations();
  change -= a_n_;
  const double error = integrator_.error_factor() * step_ * step_ * mean_size(change);
  const double reference = parameters_.reference_displacement > 0.
                               ? parameters_.reference_displacement
                               : std::max(largest_displacement_, displacement_to_resolve(displacements));
  return error / (parameters_.error_tolerance * reference);
}

double ImplicitMotion::wanted_accuracy() const {
  constexpr double by_default = 1e-3;
  return parameters_.error_tolerance > 0. ? std::min(1., parameters_.error_tolerance / by_default) : 1.;
}

void ImplicitMotion::commit(const Vector &displacements, const Vector &increment, const Vector &mean_forces,
                            const double /*touching*/, EnergyLedger &energies) {
  // With p = M Δv and the mean forces F̄, what the nodes' motions v̄·p + F̄·Δu do not cancel out is the
  // supports' work where they prescribe the motion, and elsewhere what the integrator takes.
  Vector change = v_, mean_velocity = v_;
  change -= v_n_;
  mean_velocity += v_n_;
  mean_velocity *= 0.5;
  Vector held_velocity = held_n_.velocity;
  held_velocity += held_.velocity;
  held_velocity *= 0.5;
  const Vector impulse = inertia_.times(ghosted(change));
  const double support_work = held_velocity * impulse + held_change_ * mean_forces;
  energies.external += support_work;
  energies.numerical -= mean_velocity * impulse + increment * mean_forces - support_work;
  if (loads_ != nullptr) {
    load_forces_n_ += load_forces_;
    energies.external += 0.5 * (load_forces_n_ * increment);
    load_forces_n_ = load_forces_;
  }
  v_n_ = v_;
  a_n_ = end_accelerations();
  held_n_ = held_;
  if (parameters_.error_tolerance > 0. && parameters_.reference_displacement == 0.)
    largest_displacement_ = std::max(largest_displacement_, displacement_to_resolve(displacements));
}

void ImplicitMotion::commit_tool(const std::size_t tool, const double offset, const double exerted,
                                 const double load, EnergyLedger &energies) {
  HeavyTool &heavy = tools_[tool];
  const double way = offset - heavy.offset, rate_n = heavy.rate;
  const TimeIntegrator::Rate weights = integrator_.velocity(step_);
  const double acceleration = accelerate(heavy, offset);
  heavy.rate =
      weights.increment * way + weights.velocity * rate_n + weights.acceleration * start_acceleration(heavy);
  // The tools' works contain what it exerts, of which its kinetic energy keeps account; its load is the
  // scene's.
  const double mean_exerted = damps_contact_ ? exerted : 0.5 * (heavy.exerted + exerted);
  const double work = (0.5 * (heavy.load + load) - mean_exerted) * way;
  energies.external += work;
  energies.numerical -= 0.5 * heavy.inertia * (heavy.rate * heavy.rate - rate_n * rate_n) - work;
  heavy.acceleration =
      acceleration - (damps_contact_ ? (1. - 1. / integrator_.gamma()) * exerted / heavy.inertia : 0.);
  heavy.offset = offset;
  heavy.exerted = exerted;
  heavy.load = load;
}

double ImplicitMotion::remove_tool(const std::size_t tool) {
  HeavyTool &heavy = tools_[tool];
  const double energy = 0.5 * heavy.inertia * heavy.rate * heavy.rate;
  heavy = HeavyTool();
  return energy;
}

void ImplicitMotion::update_state(SolutionState &state) const {
  state.velocities = ghosted(v_n_);
  const Vector momenta = inertia_.times(state.velocities);
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
  state.energies.kinetic = 0.5 * (v_n_ * momenta);
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const HeavyTool &heavy = tools_[i];
    state.energies.kinetic += 0.5 * heavy.inertia * heavy.rate * heavy.rate;
    const Tool &tool = scene_.tools()[i];
    if (heavy.inertia == 0.)
      continue;
    if (tool.control() == Tool::Control::moment) {
      state.angular_momentum += heavy.inertia * heavy.rate * tool.rotation_axis();
      continue;
    }
    const Tensor<1, 3> p = heavy.inertia * heavy.rate * tool.force_direction();
    state.momentum += p;
    state.angular_momentum += dealii::cross_product_3d(state.placements[i].moved_centre(), p);
  }
}

} // namespace billet
