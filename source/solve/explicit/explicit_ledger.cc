// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/explicit_ledger.h"

#include "billet/solve/restart.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace billet {

using dealii::Tensor;

namespace {

/// Indices of the sums over all ranks.
enum Sum {
  kinetic,
  elastic,
  plastic,
  contact,
  friction,
  viscous,
  hourglass,
  external,
  momentum,
  angular = momentum + 3,
  n_sums = angular + 3
};

double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

} // namespace

void ExplicitLedger::add_works(const NodalVectors &v, const double half) {
  const auto power = [&v](const NodalVectors &forces, const unsigned int node) {
    const std::size_t k = std::size_t{nodal_stride} * node;
    return dot(&forces[k], &v[k]);
  };
  for (const unsigned int node : parts_.forces.loaded_nodes())
    works_.external += half * power(parts_.forces.external(), node);
  for (const unsigned int node : parts_.motion.constrained_nodes())
    if (parts_.nodes.is_owned(node))
      works_.external += half * power(parts_.motion.support_forces(), node);
  parts_.tools.add_works(parts_.clock.time(), works_.external);
}

std::vector<double> ExplicitLedger::sum_own() {
  const NodalVectors &u = parts_.motion.displacements(), &v = parts_.motion.velocities(),
                     &v_before = parts_.motion.velocities_before();
  std::vector<double> own(n_sums, 0.);
  extent_ = 0.;
  for (unsigned int node = 0; node < parts_.nodes.size(); ++node) {
    if (!parts_.nodes.is_owned(node))
      continue;
    const std::size_t k = std::size_t{nodal_stride} * node;
    const double mass = parts_.masses.values()[node];
    own[kinetic] += 0.5 * mass * dot(&v[k], &v_before[k]);
    const Tensor<1, 3> p = 0.5 * mass * (get_vector(v.data(), node) + get_vector(v_before.data(), node));
    const Tensor<1, 3> x = get_vector(parts_.nodes.positions().data(), node) + get_vector(u.data(), node);
    const Tensor<1, 3> L = dealii::cross_product_3d(x, p);
    extent_ = std::max({extent_, std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
    for (unsigned int i = 0; i < 3; ++i) {
      own[momentum + i] += p[i];
      own[angular + i] += L[i];
    }
  }
  own[elastic] = parts_.elements.elastic_energy();
  own[plastic] = works_.plastic;
  for (std::size_t i = 0; i < parts_.tools.size(); ++i)
    own[contact] += parts_.tools.load(i).stored_energy;
  own[friction] = works_.friction;
  own[viscous] = works_.viscous;
  own[hourglass] = parts_.elements.hourglass_energy();
  own[external] = works_.external;
  return own;
}

void ExplicitLedger::add_tools(SolutionState &state) const {
  for (std::size_t i = 0; i < parts_.tools.size(); ++i) {
    const FreeTool &tool = parts_.tools[i];
    state.energies.kinetic += tool.kinetic_energy();
    state.momentum += tool.momentum();
    state.angular_momentum += tool.angular_momentum();
    state.tool_loads[i] = sum_over_ranks(parts_.tools.load(i), parts_.communicator());
    state.placements[i] = tool.now();
  }
}

void ExplicitLedger::update(SolutionState &state) {
  state.time = parts_.clock.time();
  const std::vector<double> own = sum_own();
  std::vector<double> totals(own.size());
  dealii::Utilities::MPI::sum(own, parts_.communicator(), totals);
  extent_ = dealii::Utilities::MPI::max(extent_, parts_.communicator());

  EnergyLedger &energies = state.energies;
  energies.kinetic = totals[kinetic];
  energies.elastic = totals[elastic];
  energies.plastic = totals[plastic];
  energies.contact = totals[contact];
  energies.friction = totals[friction];
  energies.viscous = totals[viscous];
  energies.hourglass = totals[hourglass];
  energies.external = totals[external];
  for (unsigned int i = 0; i < 3; ++i) {
    state.momentum[i] = totals[momentum + i];
    state.angular_momentum[i] = totals[angular + i];
  }
  add_tools(state);
  for (std::size_t i = 0; i < parts_.contacts.of_bodies().size(); ++i) {
    state.body_pair_loads[i] = parts_.contacts.of_bodies()[i].measures().compute_load();
    energies.contact += state.body_pair_loads[i].stored_energy;
  }
  if (parts_.clock.is_at_start())
    energies.initial = energies.total() - energies.external;
  drift_ = energies.drift();
  // The present energy counts half only, so that spurious energy does not hide itself.
  const double energy = std::max(0.5 * energies.total(), std::abs(energies.initial + energies.external));
  max_energy_ = std::max(max_energy_, energy);
  if (is_due()) // steps must not depend on other updates
    max_energy_when_due_ = std::max(max_energy_when_due_, energy);
}

double ExplicitLedger::count_refinement(SolutionState &state, const EnergyLedger &before) {
  const EnergyLedger &now = state.energies;
  const double made = (now.total() - now.external) - (before.total() - before.external);
  state.energies.initial = before.initial + made;
  drift_ = state.energies.drift();
  return made;
}

double ExplicitLedger::min_energy(const double stable_step) const {
  const double rounding = std::numeric_limits<double>::epsilon() * extent_;
  const double rate = 2. / stable_step * 2. * rounding / std::min(parts_.settings().max_drift, 1.);
  return 0.5 * (parts_.masses.of_bodies() + parts_.masses.added()) * rate * rate;
}

double ExplicitLedger::relative_drift(const EnergyLedger &energies, const double stable_step) const {
  const double scale = std::max(max_energy_, min_energy(stable_step));
  return scale > 0. ? energies.drift() / scale : 0.;
}

double ExplicitLedger::kinetic_energy() const {
  const NodalVectors &v = parts_.motion.velocities(), &v_before = parts_.motion.velocities_before();
  double energy = 0.;
  for (unsigned int node = 0; node < parts_.nodes.size(); ++node)
    if (parts_.nodes.is_owned(node))
      energy += 0.5 * parts_.masses.values()[node] *
                (get_vector(v.data(), node) * get_vector(v_before.data(), node));
  energy = dealii::Utilities::MPI::sum(energy, parts_.communicator());
  for (std::size_t i = 0; i < parts_.tools.size(); ++i)
    energy += parts_.tools[i].kinetic_energy();
  return energy;
}

void ExplicitLedger::save(StateWriter &writer, EnergyLedger energies) const {
  writer.write("drift", {drift_});
  energies.kinetic = kinetic_energy();
  writer.write("kinetic energy", {energies.kinetic});
  const std::vector<double> own{works_.external,
                                works_.plastic,
                                works_.friction,
                                works_.viscous,
                                parts_.elements.elastic_energy(),
                                parts_.elements.hourglass_energy()};
  std::vector<double> sums(own.size());
  dealii::Utilities::MPI::sum(own, parts_.communicator(), sums);
  energies.external = sums[0];
  energies.plastic = sums[1];
  energies.friction = sums[2];
  energies.viscous = sums[3];
  energies.elastic = sums[4];
  energies.hourglass = sums[5];
  writer.write("energies", to_numbers(energies));
  writer.write("largest energy", {max_energy_});
  writer.write("energy of steps", {max_energy_when_due_});
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(parts_.communicator());
  writer.write_rows("works", 4, {rank}, {own.begin(), own.begin() + 4});
}

EnergyLedger ExplicitLedger::load(const StateReader &reader, const bool is_exact) {
  if (is_exact)
    drift_ = reader.number("drift");
  // The ledger resumes these sums; the rest follows from the state.
  const EnergyLedger energies = to_energies(reader.read("energies"));
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(parts_.communicator());
  const bool is_same_partition =
      is_exact && reader.n_ranks() == dealii::Utilities::MPI::n_mpi_processes(parts_.communicator());
  if (is_same_partition) {
    const std::vector<double> works = reader.read_rows("works", 4, {rank});
    works_ = {works[0], works[1], works[2], works[3]};
  } else if (rank == 0)
    works_ = {energies.external, energies.plastic, energies.friction, energies.viscous};
  if (is_exact) {
    max_energy_ = reader.number("largest energy");
    max_energy_when_due_ = reader.number("energy of steps");
  }
  return energies;
}

} // namespace billet
