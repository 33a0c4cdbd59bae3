// SPDX-License-Identifier: LGPL-2.1-or-later
// Twenty thousand cycles of friction: a sheet is drawn around a square on another one, stick and slip on
// each side, while both turn. After ten cycles each ends with the traction of the last, and has taken
// the same work.
#include "billet/contact/facet_contact.h"
#include "billet/friction/coulomb.h"

#include "surfaces.h"

#include <deal.II/base/mpi.h>

namespace friction_cycles_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

constexpr double depth = 1e-3,
                 reach = 2e-3; // reach: half a side of the square; slip begins at μ depth k_n/k_t
constexpr unsigned int n_cycles = 20000, n_per_cycle = 8, settled = 10;

void check_cycles(const FacetMethod method, const std::string &name) {
  Surface surface;
  add_sheet(surface, 1, 1, 0, 0.5, [](const double s, const double t) {
    return Tensor<1, 3>({t, s, -depth}); // looks down
  });
  add_sheet(surface, 1, 1, 1, 0.5, [](const double s, const double t) {
    return Tensor<1, 3>({2. * s - 0.5, 2. * t - 0.5, 0.});
  });
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < surface.positions.size(); ++i)
    keys.push_back(i);
  FacetContactSettings settings;
  settings.method = method;
  settings.friction = make_coulomb(0.5);
  settings.two_pass = false;
  settings.search_margin = 0.05;
  FacetContact contact(MPI_COMM_SELF, settings, keys, surface.facets,
                       std::vector<ContactStiffness>(keys.size(), {1e3, 1e3}),
                       std::vector<double>(keys.size(), 1.));
  // Eight places around the square, and as many turns around the normal, which come back.
  const auto positions_at = [&](const unsigned int place) {
    constexpr std::array<double, n_per_cycle> x{0., 1., 1., 1., 0., -1., -1., -1.},
        y{-1., -1., 0., 1., 1., 1., 0., -1.};
    const double angle = 0.1 * x[(place + 3) % n_per_cycle];
    FacetContact::Positions positions = surface.positions;
    for (unsigned int node = 0; node < 4; ++node)
      positions[node] += reach * Tensor<1, 3>({x[place], y[place], 0.});
    for (auto &position : positions)
      position = Tensor<1, 3>({std::cos(angle) * position[0] - std::sin(angle) * position[1],
                               std::sin(angle) * position[0] + std::cos(angle) * position[1], position[2]});
    return positions;
  };
  std::vector<FacetContact::Positions> places;
  for (unsigned int place = 0; place < n_per_cycle; ++place)
    places.push_back(positions_at(place));

  WorstError force_changes, work_changes;
  Tensor<1, 3> expected_force;
  double expected_work = 0., minimum = 1e300, maximum = 0.;
  FacetContact::Positions forces(keys.size());
  for (unsigned int cycle = 0; cycle < n_cycles; ++cycle) {
    double work = 0.;
    for (unsigned int place = 0; place < n_per_cycle; ++place) {
      forces.assign(keys.size(), Tensor<1, 3>());
      contact.add_forces(cycle == 0 && place == 0 ? places[0]
                                                  : places[(place + n_per_cycle - 1) % n_per_cycle],
                         places[place], 1., forces);
      const double taken = contact.works().local_dissipation();
      work += taken;
      if (cycle == settled) {
        minimum = std::min(minimum, taken);
        maximum = std::max(maximum, taken);
      }
      contact.commit();
    }
    Tensor<1, 3> force;
    for (unsigned int node = 0; node < 4; ++node)
      force += forces[node];
    if (cycle == settled) {
      expected_force = force;
      expected_work = work;
    } else if (cycle > settled) {
      force_changes.add((force - expected_force).norm() / expected_force.norm());
      work_changes.add(std::abs(work / expected_work - 1.));
    }
  }
  check(name + ": it slips, here more, there less", maximum > 1.1 * minimum && expected_work > 0.);
  check(name + ": and is held sideways",
        std::hypot(expected_force[0], expected_force[1]) > 0.1 * expected_force[2]);
  check(name + ": each cycle ends as the tenth", force_changes.value(), 2e-10);
  check(name + ": each takes as much work", work_changes.value(), 2e-10);
}

} // namespace

BILLET_MPI_TEST(friction_cycles) {
  check_cycles(FacetMethod::planed, "planed");
  check_cycles(FacetMethod::overlap, "overlap");
}

} // namespace friction_cycles_test
