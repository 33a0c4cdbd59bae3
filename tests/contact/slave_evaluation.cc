// SPDX-License-Identifier: LGPL-2.1-or-later
// One slave facet above two facets with an edge in common: which of them each slave node touches, with
// normal, gap and areas, by each method; and the forces of the loop over slaves, with friction or without.
#include "billet/contact/slave_evaluation.h"
#include "billet/contact/slave_finder.h"
#include "billet/friction/coulomb.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/planed_facet.h"

#include "surfaces.h"

#include <deal.II/base/mpi.h>

namespace slave_evaluation_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

constexpr ContactStiffness penalty{1e3, 400.};
constexpr double depth = 0.01, coefficient = 0.3, facet_size = 0.5;
constexpr unsigned int n_slaves = 4; // the first nodes; the seam is x = 1

/// The slave facet looks down, from z = -depth; two of its nodes are above the facet on the left, two above
/// the seam. `offset` moves it.
Surface make_surfaces(const Tensor<1, 3> &offset) {
  Surface surface;
  add_sheet(surface, 1, 1, 0, 0.05, [&](const double s, const double t) {
    return Tensor<1, 3>({0.5 + 0.5 * t, 0.2 + 0.6 * s, -depth}) + offset;
  });
  add_sheet(surface, 2, 1, 1, 0.05, [](const double s, const double t) {
    return Tensor<1, 3>({2. * s, t, 0.});
  });
  return surface;
}

/// Parts of a contact of these surfaces, moved as FacetContact does it.
struct Bench {
  Bench(const FacetMethod method, const FrictionPointer &friction, const Tensor<1, 3> &offset,
        const double resting_gap = -1.)
      : surface(make_surfaces(offset)), part(surface, [](const std::size_t) { return true; }),
        parts(MPI_COMM_SELF, make_settings(method, friction, resting_gap), part.node_keys, part.facets,
              std::vector<ContactStiffness>(part.nodes.size(), penalty),
              std::vector<double>(part.nodes.size(), facet_size)) {
    move({});
  }

  static FacetContactSettings make_settings(const FacetMethod method, const FrictionPointer &friction,
                                            const double resting_gap) {
    FacetContactSettings settings;
    settings.method = method;
    settings.friction = friction;
    settings.two_pass = false;
    settings.search_margin = 0.05;
    settings.touching_gap = resting_gap;
    return settings;
  }

  /// Moves the slave facet by this in the step.
  void move(const Tensor<1, 3> &by) {
    const Positions positions_n = part.take(surface.positions);
    positions = positions_n;
    for (std::size_t i = 0; i < part.nodes.size(); ++i)
      if (part.nodes[i] < n_slaves)
        positions[i] += by;
    if (parts.surfaces.update(positions_n, positions)) {
      std::optional<double> penetration;
      if (parts.overlaps)
        penetration = FacetOverlaps::penetration;
      parts.surfaces.rebuild(parts.slaves.list(), penetration);
      if (parts.overlaps)
        parts.overlaps->rebuild(parts.surfaces, false, false);
      parts.start.find_facets(parts.surfaces.search().facets());
    }
    if (parts.overlaps)
      parts.overlaps->update(parts.surfaces, parts.slaves, parts.offsets);
  }

  Positions run(const double duration) {
    Positions forces(parts.surfaces.exchange().n_nodes());
    make_slave_evaluation(parts)->run(duration, forces);
    return forces;
  }

  bool is_above_seam(const std::size_t s) const {
    return std::abs(positions[parts.slaves.node(s)][0] - 1.) < 1e-12;
  }

  Surface surface;
  Part part;
  FacetContactParts parts;
  Positions positions;
};

template <class Facet> void find_all(Bench &bench) {
  bench.parts.touching.start_evaluation(0.);
  SlaveFinder<Facet> finder(bench.parts);
  for (std::size_t s = 0; s < bench.parts.slaves.size(); ++s)
    finder.find(s);
}

template <class Facet> void check_finder(const std::string &name, const FacetMethod method) {
  Bench bench(method, nullptr, {});
  find_all<Facet>(bench);
  const TouchingSlaves &touching = bench.parts.touching;
  WorstError gap, normal, area, shares, halves;
  bool all_press = bench.parts.slaves.size() == n_slaves, are_right = true;
  for (std::size_t s = 0; s < bench.parts.slaves.size(); ++s) {
    const SlaveState &state = touching[s];
    all_press = all_press && state.presses() && !state.is_near && !state.rests;
    gap.add(std::abs(state.contact.gap + depth));
    normal.add((state.contact.normal - Tensor<1, 3>({0., 0., 1.})).norm());
    area.add(std::abs(state.area - 0.075)); // a quarter of 0.5 × 0.6
    area.add(std::abs(state.own_area - state.area));
    double sum = 0.;
    for (std::size_t i = state.first_share; i < state.end_of_shares; ++i)
      sum += bench.parts.touching.shares()[i].share;
    shares.add(std::abs(sum - 1.));
    const std::size_t n_shares = state.end_of_shares - state.first_share;
    if (bench.is_above_seam(s)) {
      are_right = are_right && n_shares == 2;
      halves.add(std::abs(bench.parts.touching.shares()[state.first_share].share - 0.5));
    } else
      are_right = are_right && n_shares == 1 && bench.parts.surfaces.facet(state.touched.facet).key == 1;
  }
  check(name + ": all slaves press", all_press);
  check(name + ": gap", gap.value(), 1e-14);
  check(name + ": normal", normal.value(), 1e-14);
  check(name + ": area is a quarter of the slave facet", area.value(), 1e-14);
  check(name + ": a node above a facet touches it, one above the seam both", are_right);
  check(name + ": shares sum to 1", shares.value(), 1e-14);
  check(name + ": those at the seam are halves", halves.value(), 1e-12);

  bench.parts.offsets.penetrations.set(std::vector<double>(n_slaves, 0.5 * depth));
  find_all<Facet>(bench);
  check(name + ": an allowed penetration does not count",
        near(bench.parts.touching[0].contact.gap, -0.5 * depth, 1e-12));

  Bench front(method, nullptr, Tensor<1, 3>({0., 0., 1.2 * depth}));
  find_all<Facet>(front);
  check(name + ": a slave in front of a facet is near it",
        front.parts.touching[0].is_near && !front.parts.touching[0].presses() &&
            near(front.parts.touching[0].contact.gap, 0.2 * depth, 1e-12));
  Bench resting(method, nullptr, Tensor<1, 3>({0., 0., 1.2 * depth}), 0.3 * depth / facet_size);
  find_all<Facet>(resting);
  check(name + ": one within the touching gap rests on it, without pressure",
        resting.parts.touching[0].rests && resting.parts.touching[0].presses() &&
            !resting.parts.touching[0].has_pressure());
  Bench beside(method, nullptr, Tensor<1, 3>({5., 0., 0.}));
  find_all<Facet>(beside);
  check(name + ": one beside all facets touches none",
        !beside.parts.touching[0].touched.exists() && !beside.parts.touching[0].is_near);
}

void check_overlaps() {
  // Half of the slave facet is on each side of the seam.
  Bench bench(FacetMethod::overlap, nullptr, Tensor<1, 3>({0.25, 0., 0.}));
  find_all<OverlapFacet>(bench);
  WorstError gap;
  double area = 0.;
  bool share_both = true;
  for (std::size_t s = 0; s < n_slaves; ++s) {
    const SlaveState &state = bench.parts.touching[s];
    gap.add(std::abs(state.contact.gap + depth));
    share_both = share_both && state.end_of_shares - state.first_share == 2;
    for (std::size_t i = state.first_share; i < state.end_of_shares; ++i)
      area += bench.parts.touching.shares()[i].area;
  }
  check("overlaps: each slave has a part with both facets", share_both);
  check("overlaps: mean gap", gap.value(), 1e-12);
  check("overlaps: their areas sum to that of the slave facet", std::abs(area - 0.3), 1e-12);
}

struct Sums {
  Tensor<1, 3> of_slaves, of_all, moment;
  double scale = 0.;
};

Sums sum_up(const Bench &bench, const Positions &forces) {
  Sums sums;
  for (std::size_t i = 0; i < bench.part.nodes.size(); ++i) {
    if (bench.part.nodes[i] < n_slaves)
      sums.of_slaves += forces[i];
    sums.of_all += forces[i];
    sums.moment += dealii::cross_product_3d(bench.positions[i], forces[i]);
    sums.scale += forces[i].norm();
  }
  return sums;
}

void check_forces(const std::string &name, const FacetMethod method) {
  const double area = 0.3, pressure = penalty.normal * depth;
  for (const bool has_friction : {false, true}) {
    const std::string law = name + (has_friction ? ", Coulomb" : ", frictionless");
    for (const bool slips : {false, true}) {
      const double way = slips ? 0.02 : 0.002;
      Bench bench(method, has_friction ? make_coulomb(coefficient) : nullptr, {});
      bench.run(1.);
      bench.parts.start.commit();
      for (std::size_t s = 0; s < n_slaves; ++s) {
        const SlaveState &state = bench.parts.touching[s];
        bench.parts.start.set(s, state.touched, bench.parts.surfaces.search().facets(),
                              {pressure, depth, state.area, state.contact.normal});
      }
      if (bench.parts.friction)
        bench.parts.friction->commit();
      bench.move(Tensor<1, 3>({-way, 0., 0.}));
      const Sums sums = sum_up(bench, bench.run(1.));
      const double drag = has_friction ? std::min(coefficient * pressure, penalty.tangential * way) : 0.;
      const std::string kind = law + (slips ? ", a long way" : ", a short way");
      check(kind + ": force on the slaves",
            (sums.of_slaves - area * Tensor<1, 3>({drag, 0., pressure})).norm() / (area * pressure), 1e-12);
      check(kind + ": forces and moments balance", (sums.of_all.norm() + sums.moment.norm()) / sums.scale,
            1e-14);
    }
  }
  Bench apart(method, make_coulomb(coefficient), Tensor<1, 3>({0., 0., 2. * depth}));
  check(name + ": no force on slaves in front", sum_up(apart, apart.run(1.)).scale == 0.);
}

} // namespace

BILLET_MPI_TEST(slave_evaluation) {
  check_finder<PlanedFacet>("planed", FacetMethod::planed);
  check_finder<MeanGapFacet>("mean gap", FacetMethod::mean_gap);
  check_finder<BilinearFacet>("bilinear", FacetMethod::bilinear);
  check_overlaps();
  check_forces("planed", FacetMethod::planed);
  check_forces("mean gap", FacetMethod::mean_gap);
  check_forces("bilinear", FacetMethod::bilinear);
  check_forces("overlap", FacetMethod::overlap);
}

} // namespace slave_evaluation_test
