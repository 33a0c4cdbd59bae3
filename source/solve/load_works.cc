// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/load_works.h"

#include "billet/times.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

/// Returns a time after the end of a step at t, by which LoadTimes tells what acts then.
double just_after(const double t) { return t * (1. + 2. * times::rounding); }

} // namespace

LoadWorks::LoadWorks(const Scene &scene, const LocalNodes &nodes, const ExternalLoads &loads)
    : nodes_(nodes), loads_(loads), scratch_(nodes.make_vectors()) {
  for (const Body &body : scene.bodies())
    for (const AppliedLoad &load : body.loads) {
      const std::vector<unsigned int> of_load = loads.nodes_of(load);
      of_loads_.push_back({&load, of_load, std::vector<Tensor<1, 3>>(of_load.size()), 0.});
    }
  for (const std::string &name : named_loads(scene))
    names_ += name + "\n";
}

void LoadWorks::evaluate(const double t, const NodalVectors &displacements, const NodalVectors &velocities,
                         NodalVectors &sum) {
  for (OfLoad &of_load : of_loads_)
    evaluate_load(of_load, t, displacements, velocities, sum);
}

void LoadWorks::evaluate_after(const double t, const NodalVectors &displacements,
                               const NodalVectors &velocities, NodalVectors &sum) {
  for (OfLoad &of_load : of_loads_)
    evaluate_load(of_load, of_load.load->times.changes_at(t) ? just_after(t) : t, displacements, velocities,
                  sum);
}

void LoadWorks::evaluate_load(OfLoad &of_load, const double t, const NodalVectors &displacements,
                              const NodalVectors &velocities, NodalVectors &sum) {
  loads_.add_forces_of(*of_load.load, t, displacements, velocities, scratch_);
  for (std::size_t k = 0; k < of_load.nodes.size(); ++k) {
    const unsigned int node = of_load.nodes[k];
    of_load.forces[k] = get_vector(scratch_.data(), node);
    add_vector(sum.data(), node, of_load.forces[k]);
    std::fill_n(&scratch_[std::size_t{nodal_stride} * node], nodal_stride, 0.);
  }
}

bool LoadWorks::jumps_at(const double t) const {
  // Change of the factor; a load that begins to fade changes by the time's rounding.
  constexpr double notable = 1e-3;
  return std::any_of(of_loads_.begin(), of_loads_.end(), [t](const OfLoad &of_load) {
    const LoadTimes &times = of_load.load->times;
    return times.changes_at(t) && std::abs(times.factor(just_after(t)) - times.factor(t)) > notable;
  });
}

void LoadWorks::add_works(const NodalVectors &motion, const double factor) {
  for (OfLoad &of_load : of_loads_)
    for (std::size_t k = 0; k < of_load.nodes.size(); ++k)
      of_load.work += factor * (of_load.forces[k] * get_vector(motion.data(), of_load.nodes[k]));
}

std::vector<LoadResult> LoadWorks::results() const {
  std::vector<double> sums;
  for (const OfLoad &of_load : of_loads_) {
    Tensor<1, 3> force;
    for (const Tensor<1, 3> &at_node : of_load.forces)
      force += at_node;
    sums.insert(sums.end(), {force[0], force[1], force[2], of_load.work});
  }
  dealii::Utilities::MPI::sum(sums, nodes_.discretization().communicator(), sums);
  std::vector<LoadResult> results;
  for (std::size_t k = 0; k < sums.size(); k += 4)
    results.push_back({Tensor<1, 3>({sums[k], sums[k + 1], sums[k + 2]}), sums[k + 3]});
  return results;
}

std::vector<double> LoadWorks::own_works() const {
  std::vector<double> works;
  for (const OfLoad &of_load : of_loads_)
    works.push_back(of_load.work);
  return works;
}

void LoadWorks::save(StateWriter &writer) const {
  if (of_loads_.empty())
    return;
  const MPI_Comm communicator = nodes_.discretization().communicator();
  const std::vector<double> own = own_works();
  std::vector<double> sums(own.size());
  dealii::Utilities::MPI::sum(own, communicator, sums);
  writer.write_text("load names", names_);
  writer.write("load works", sums);
  writer.write_rows("load works of ranks", own.size(),
                    {dealii::Utilities::MPI::this_mpi_process(communicator)}, own);
}

void LoadWorks::load(const StateReader &reader) {
  if (!reader.has("load names") || reader.read_text("load names") != names_)
    return;
  const MPI_Comm communicator = nodes_.discretization().communicator();
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator);
  const bool has_same_ranks = reader.n_ranks() == dealii::Utilities::MPI::n_mpi_processes(communicator);
  const std::vector<double> works = has_same_ranks
                                        ? reader.read_rows("load works of ranks", of_loads_.size(), {rank})
                                        : reader.read("load works", of_loads_.size());
  for (std::size_t i = 0; i < of_loads_.size(); ++i)
    of_loads_[i].work = has_same_ranks || rank == 0 ? works[i] : 0.;
}

void LoadWorks::save_forces(StateWriter &writer, const OwnedNodes &nodes) const {
  std::vector<double> shares; // of this rank
  for (const OfLoad &of_load : of_loads_)
    for (const Tensor<1, 3> &force : of_load.forces)
      RowWriter(shares).vector(force);
  write_list(writer, "shares of loads",
             dealii::Utilities::MPI::this_mpi_process(nodes_.discretization().communicator()), shares);
  for (std::size_t i = 0; i < of_loads_.size(); ++i) {
    Vector sum = nodes_.discretization().make_additive_vector();
    for (std::size_t k = 0; k < of_loads_[i].nodes.size(); ++k)
      sum.add(3, nodes_.dofs(of_loads_[i].nodes[k]).data(), of_loads_[i].forces[k].begin_raw());
    sum.compress(dealii::VectorOperation::add);
    Vector owned = nodes_.discretization().make_owned_vector();
    owned = sum;
    save_nodal(writer, "forces of load " + std::to_string(i), nodes, owned);
  }
}

void LoadWorks::load_forces(const StateReader &reader, const OwnedNodes &nodes) {
  const MPI_Comm communicator = nodes_.discretization().communicator();
  if (reader.has("shares of loads") &&
      reader.n_ranks() == dealii::Utilities::MPI::n_mpi_processes(communicator)) {
    const std::vector<double> shares =
        read_list(reader, "shares of loads", dealii::Utilities::MPI::this_mpi_process(communicator));
    RowReader row(shares);
    for (OfLoad &of_load : of_loads_)
      for (Tensor<1, 3> &force : of_load.forces)
        row.vector(force);
    return;
  }
  for (std::size_t i = 0; i < of_loads_.size(); ++i) {
    const std::string name = "forces of load " + std::to_string(i);
    if (!reader.has(name))
      continue;
    Vector owned = nodes_.discretization().make_owned_vector();
    load_nodal(reader, name, nodes, owned);
    Vector ghosted = nodes_.discretization().make_ghosted_vector();
    ghosted = owned;
    for (std::size_t k = 0; k < of_loads_[i].nodes.size(); ++k) {
      const unsigned int node = of_loads_[i].nodes[k];
      for (unsigned int c = 0; c < 3; ++c)
        of_loads_[i].forces[k][c] = nodes_.is_owned(node) ? ghosted(nodes_.dofs(node)[c]) : 0.;
    }
  }
}

} // namespace billet
