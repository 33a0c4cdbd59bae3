// SPDX-License-Identifier: LGPL-2.1-or-later
// Surfaces split over ranks, some of which may have none: each rank finds the candidates that one rank alone
// finds, sees where the ghosts' owners are, and gives back what belongs to them.
#include "billet/contact/surface_exchange.h"

#include "surfaces.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace surface_exchange_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

constexpr double margin = 0.1, max_reach = 0.08;

/// Sorted keys of a node's candidates.
std::vector<std::uint64_t> candidate_keys(const FacetSearch &search, const std::size_t slave) {
  std::vector<std::uint64_t> keys;
  search.visit_candidates(slave,
                          [&](const unsigned int facet) { keys.push_back(search.facets()[facet].key); });
  return keys;
}

double integer_of(const unsigned int rank, const unsigned int node, const unsigned int component) {
  return (rank * 131 + node * 17 + component * 5) % 1009;
}

void report(const std::string &name, const bool holds_here) {
  const bool holds = dealii::Utilities::MPI::min(holds_here ? 1 : 0, MPI_COMM_WORLD) == 1;
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    check(name, holds);
}

template <class IsMine>
void check_split(const std::string &name, const FacetSearch::Partners partners, const IsMine &is_mine) {
  Random random;
  Surface whole;
  add_ball(whole, 12, 0, 0.05, Tensor<1, 3>(), 1.);
  add_ball(whole, 9, 1, max_reach, Tensor<1, 3>({0.9, 0.2, 0.3}), 0.6);
  add_sheet(whole, 8, 8, 2, 0.05, [](const double s, const double t) {
    return Tensor<1, 3>({2. * s - 1., 2. * t - 1., 0.3 * s * t});
  });
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const Part part(whole, [&](const std::size_t facet) { return is_mine(facet) == rank; });
  const auto slaves = whole.slaves();
  FacetSearch serial(partners, margin), search(partners, margin);
  serial.set_surface(whole.facets, slaves);
  SurfaceExchange exchange(MPI_COMM_WORLD, part.node_keys, part.facets);

  RandomMotion motion(random, 3, 0.02);
  Positions positions = whole.positions;
  bool same_candidates = true, same_positions = true, sums_agree = true, is_reproducible = true,
       ghosts_are_zero = true;
  std::size_t n_ghosts = 0;
  for (unsigned int step = 0; step < 20; ++step) {
    const Positions positions_n = positions;
    motion.advance(whole, slaves, positions, Tensor<1, 3>({0.3, -0.2, 0.1}));
    Positions own_n = part.take(positions_n), own = part.take(positions);
    if (step % 4 == 0) {
      serial.rebuild(positions_n, positions);
      exchange.rebuild(own_n, own, max_reach + margin);
      std::vector<SlaveNode> own_slaves(part.nodes.size());
      for (const auto &facet : part.facets)
        for (const unsigned int node : facet.nodes)
          own_slaves[node] = {node, facet.surface};
      search.set_surface(exchange.facets(), own_slaves);
    }
    exchange.update(own_n);
    exchange.update(own);
    if (step % 4 == 0) {
      search.rebuild(own_n, own);
      for (std::size_t s = 0; s < part.nodes.size(); ++s)
        same_candidates =
            same_candidates && candidate_keys(search, s) == candidate_keys(serial, part.nodes[s]);
    }
    for (const auto &facet : exchange.facets())
      for (unsigned int a = 0; a < 4; ++a) {
        const unsigned int node = whole.facets[facet.key].nodes[a];
        same_positions = same_positions && (own[facet.nodes[a]] - positions[node]).norm() == 0. &&
                         (own_n[facet.nodes[a]] - positions_n[node]).norm() == 0.;
      }
    n_ghosts += exchange.n_nodes() - exchange.n_own_nodes();

    // Integers, so that sums are the same in any order.
    std::vector<unsigned int> node_of(exchange.n_nodes());
    for (const auto &facet : exchange.facets())
      for (unsigned int a = 0; a < 4; ++a)
        node_of[facet.nodes[a]] = whole.facets[facet.key].nodes[a];
    Positions forces(exchange.n_nodes()), wild(exchange.n_nodes());
    std::vector<double> before(3 * whole.positions.size()), after(before.size());
    for (std::size_t i = 0; i < forces.size(); ++i)
      for (unsigned int c = 0; c < 3; ++c) {
        forces[i][c] = integer_of(rank, node_of[i], c);
        wild[i][c] = std::sin(1e3 * forces[i][c] + step);
        before[3 * node_of[i] + c] += forces[i][c];
      }
    Positions again = wild;
    exchange.collect(forces);
    exchange.collect(wild);
    exchange.collect(again);
    for (std::size_t i = 0; i < exchange.n_own_nodes(); ++i)
      for (unsigned int c = 0; c < 3; ++c)
        after[3 * node_of[i] + c] += forces[i][c];
    dealii::Utilities::MPI::sum(before, MPI_COMM_WORLD, before);
    dealii::Utilities::MPI::sum(after, MPI_COMM_WORLD, after);
    sums_agree = sums_agree && before == after;
    is_reproducible = is_reproducible && wild == again;
    for (std::size_t i = exchange.n_own_nodes(); i < exchange.n_nodes(); ++i)
      ghosts_are_zero = ghosts_are_zero && forces[i].norm() == 0.;
  }
  report(name + ": candidates are those of one rank", same_candidates);
  report(name + ": ghosts are where their owners are", same_positions);
  report(name + ": what is collected is what was there", sums_agree && ghosts_are_zero);
  report(name + ": the same bits again", is_reproducible);
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const double all_ghosts = dealii::Utilities::MPI::sum(static_cast<double>(n_ghosts), MPI_COMM_WORLD);
  // Not every rank has the whole surface.
  report(name + ": ghosts, but not everything",
         n_ranks == 1 ? all_ghosts == 0.
                      : all_ghosts < 20. * (n_ranks - 1.) * static_cast<double>(whole.positions.size()));
}

void check_far_apart() {
  // Each rank has a sheet of its own, far from the others': nobody has a ghost.
  Surface whole;
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  add_sheet(whole, 3, 3, rank, 0.1, [&](const double s, const double t) {
    return Tensor<1, 3>({s + 10. * rank, t, 0.});
  });
  const std::uint64_t first_key = std::uint64_t{1000} * rank;
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < whole.positions.size(); ++i)
    keys.push_back(first_key + i);
  for (auto &facet : whole.facets)
    facet.key += first_key;
  SurfaceExchange exchange(MPI_COMM_WORLD, keys, whole.facets);
  exchange.rebuild(whole.positions, whole.positions, 1.);
  report("far apart: no ghosts", exchange.n_nodes() == whole.positions.size());
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  exchange.rebuild(whole.positions, whole.positions, 9.01); // one edge, of 3 facets and 8 nodes, each way
  const std::size_t n_sides = (rank > 0 ? 1 : 0) + (rank + 1 < n_ranks ? 1 : 0);
  report("near: the nearest facets only", exchange.n_nodes() == whole.positions.size() + 8 * n_sides);
}

} // namespace

BILLET_MPI_TEST(surface_exchange) {
  using Partners = FacetSearch::Partners;
  const std::size_t n = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  check_split("stripes", Partners::other_surfaces, [&](const std::size_t f) { return f / 10 % n; });
  check_split("with themselves", Partners::other_surfaces_and_self,
              [&](const std::size_t f) { return f / 10 % n; });
  check_split("bodies", Partners::other_surfaces,
              [&](const std::size_t f) { return std::min(f / 144, n - 1); });
  check_split("one rank has all", Partners::other_surfaces, [&](const std::size_t) { return n - 1; });
  check_split("nobody has anything", Partners::other_surfaces, [&](const std::size_t) { return n; });
  check_far_apart();
}

} // namespace surface_exchange_test
