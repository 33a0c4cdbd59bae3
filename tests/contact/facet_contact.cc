// SPDX-License-Identifier: LGPL-2.1-or-later
// Contact between surfaces as a whole: forces of known size, in one pass and in two, balance of all forces
// and moments, momentum and energy in an impact, and the same on any number of ranks.
#include "billet/contact/facet_contact.h"
#include "billet/friction/coulomb.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/planed_facet.h"

#include "surfaces.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace facet_contact_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

constexpr ContactStiffness penalty{1e3, 5e2};

unsigned int rank() { return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD); }

void report(const std::string &name, const double error, const double tolerance) {
  const double worst = dealii::Utilities::MPI::max(std::isnan(error) ? 1e300 : error, MPI_COMM_WORLD);
  if (rank() == 0)
    check(name, worst, tolerance);
}

FacetContactSettings make_settings(const FacetMethod method, const FrictionPointer &friction,
                                   const bool two_pass) {
  FacetContactSettings settings;
  settings.method = method;
  settings.friction = friction;
  settings.two_pass = two_pass;
  settings.search_margin = 0.05;
  return settings;
}

FacetContact make_contact(MPI_Comm communicator, const FacetContactSettings &settings, const Part &part) {
  return {communicator,
          settings,
          part.node_keys,
          part.facets,
          std::vector<ContactStiffness>(part.nodes.size(), penalty),
          std::vector<double>(part.nodes.size(), 0.1)};
}

Part everything(const Surface &surface) {
  return Part(surface, [](const std::size_t) { return true; });
}

/// A smaller sheet from above on a larger one below, of other facets, deeper by `depth`.
Surface make_press(const double depth) {
  Surface surface;
  add_sheet(surface, 7, 5, 0, 0.05, [&](const double s, const double t) {
    return Tensor<1, 3>({t, s, -depth}); // looks down
  });
  add_sheet(surface, 11, 13, 1, 0.05, [](const double s, const double t) {
    return Tensor<1, 3>({2. * s - 0.5, 2. * t - 0.5, 0.});
  });
  return surface;
}

/// Two waved balls pressed into each other, of 324 and 196 facets.
Surface make_balls() {
  Surface surface;
  add_ball(surface, 18, 0, 0.2, Tensor<1, 3>(), 1.);
  add_ball(surface, 14, 1, 0.2, Tensor<1, 3>({1.25, 0.4, 0.2}), 0.5);
  return surface;
}

struct Sums {
  Tensor<1, 3> force, moment;
  double scale = 0.;
};

Sums sum_up(const Positions &positions, const Positions &forces) {
  Sums sums;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    sums.force += forces[i];
    sums.moment += dealii::cross_product_3d(positions[i], forces[i]);
    sums.scale += forces[i].norm();
  }
  return sums;
}

void check_known_force(const FacetMethod method, const std::string &name) {
  const double depth = 0.01;
  const Surface surface = make_press(depth);
  const Part part = everything(surface);
  const Positions positions = part.take(surface.positions);
  for (const bool two_pass : {false, true}) {
    FacetContact contact = make_contact(MPI_COMM_SELF, make_settings(method, nullptr, two_pass), part);
    Positions forces(positions.size());
    contact.add_forces(positions, positions, 0., forces);
    const FacetContactLoad load = contact.works().compute_load();
    const std::string pass = name + (two_pass ? ", two passes" : ", one pass");
    // Below the smaller sheet's border, nodes of the larger one reach beyond its edge: their share of the
    // area is the quadrature's.
    report(pass + ": force on the sheet", std::abs(load.force[2] / (penalty.normal * depth) - 1.),
           two_pass ? 0.05 : 1e-12);
    report(pass + ": no other", std::hypot(load.force[0], load.force[1]) / load.force[2], 1e-12);
    report(pass + ": energy", std::abs(load.stored_energy / (0.5 * load.force[2] * depth) - 1.), 1e-12);
    report(pass + ": deepest", std::abs(load.deepest - depth), 1e-15);
    Tensor<1, 3> sum;
    for (const auto &facet : part.facets)
      if (facet.surface == 0)
        for (const unsigned int node : facet.nodes) {
          sum += forces[node];
          forces[node] = Tensor<1, 3>();
        }
    report(pass + ": that is what its nodes feel", (sum - load.force).norm() / load.force.norm(), 1e-12);
    double area = 0.;
    for (const auto &node : contact.measures().report())
      area += node.area;
    report(pass + ": reported area", std::abs(area / load.area - 1.), 1e-12);
    // Rigid sheets: ω² of the contact is below its bound, and not by far.
    std::vector<double> row_sums(positions.size());
    contact.bounds().add_row_sums(row_sums);
    const double maximum = *std::max_element(row_sums.begin(), row_sums.end());
    const double spring = penalty.normal / 35.; // of one node inside the smaller sheet
    report(pass + ": bound of the time step", maximum < 2. * spring || maximum > 10. * spring ? 1. : 0., 0.);
  }
}

void check_balance(const FacetMethod method, const FrictionPointer &law, const std::string &name) {
  Random random;
  const Surface surface = make_balls();
  const Part part = everything(surface);
  RandomMotion motion(random, 2, 2e-3);
  FacetContact contact = make_contact(MPI_COMM_SELF, make_settings(method, law, true), part);
  WorstError force, moment, reported;
  double min_touching = 1e3, dissipation = 0.;
  Positions whole = surface.positions;
  for (unsigned int step = 0; step < 30; ++step) {
    const Positions positions_n = part.take(whole);
    motion.advance(surface, surface.slaves(), whole, Tensor<1, 3>());
    const Positions positions = part.take(whole);
    Positions forces(positions.size());
    contact.add_forces(positions_n, positions, 1., forces);
    const FacetContactLoad load = contact.works().compute_load();
    contact.commit();
    const Sums sums = sum_up(positions, forces);
    force.add(sums.force.norm() / sums.scale);
    moment.add(sums.moment.norm() / sums.scale);
    reported.add((load.residual_force.norm() + load.residual_moment.norm()) / load.absolute_force);
    min_touching = std::min(min_touching, load.n_touching);
    dissipation += load.dissipation;
  }
  report(name + ": many nodes touch", 1. / min_touching, 0.1);
  report(name + ": forces balance", force.value(), 1e-15);
  report(name + ": moments balance", moment.value(), 1e-15);
  report(name + ": so says the load", reported.value(), 1e-14);
  report(name + ": friction dissipates", (law == nullptr) == (dissipation > 0.) ? 1. : 0., 0.);
}

/// A sheet of free nodes that flies onto one of nodes a hundred times as heavy; central differences.
void check_impact(const FacetMethod method, const std::string &name) {
  Surface surface;
  add_sheet(surface, 5, 4, 0, 0.05, [&](const double s, const double t) {
    return Tensor<1, 3>({0.2 + 0.5 * t, 0.2 + 0.5 * s, 0.01 + 0.002 * s});
  });
  add_sheet(surface, 4, 4, 1, 0.05, [](const double s, const double t) {
    return Tensor<1, 3>({s, t, 0.005 * std::sin(3. * s + 2. * t)});
  });
  const Part part = everything(surface);
  Positions x = part.take(surface.positions), v(x.size()), forces(x.size());
  std::vector<double> mass(x.size(), 100.);
  for (const auto &facet : part.facets)
    for (const unsigned int node : facet.nodes)
      if (facet.surface == 0) {
        v[node] = Tensor<1, 3>({0.01, 0.005, -0.1});
        mass[node] = 1.;
      }
  const auto kinetic = [&] {
    double sum = 0.;
    for (std::size_t i = 0; i < v.size(); ++i)
      sum += 0.5 * mass[i] * v[i].norm_square();
    return sum;
  };
  const auto momentum = [&] {
    Positions p(v.size());
    for (std::size_t i = 0; i < v.size(); ++i)
      p[i] = mass[i] * v[i];
    return sum_up(x, p);
  };
  FacetContact contact(MPI_COMM_SELF, make_settings(method, nullptr, false), part.node_keys, part.facets,
                       std::vector<ContactStiffness>(x.size(), {1e5, 1e5}),
                       std::vector<double>(x.size(), 0.1));
  const double energy = kinetic(), dt = 1e-3;
  const Sums before = momentum();
  double max_stored = 0.;
  for (unsigned int step = 0; step < 500; ++step) {
    const Positions x_n = x;
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] += dt * v[i];
    forces.assign(x.size(), {});
    contact.add_forces(x_n, x, dt, forces);
    contact.commit();
    max_stored = std::max(max_stored, contact.works().compute_load().stored_energy);
    for (std::size_t i = 0; i < x.size(); ++i)
      v[i] += dt / mass[i] * forces[i];
  }
  const Sums after = momentum();
  report(name + ": impact: momentum", (after.force - before.force).norm() / before.scale, 1e-14);
  report(name + ": impact: angular momentum", (after.moment - before.moment).norm() / before.scale, 1e-14);
  report(name + ": impact: a rebound",
         max_stored > 0.5 * energy && contact.works().compute_load().n_touching == 0. ? 0. : 1., 0.);
  // What is lost, or won, over the facets' seams, and by mean planes, whose gap has not quite this gradient.
  report(name + ": impact: energy after it", std::abs(kinetic() / energy - 1.),
         method == FacetMethod::planed ? 5e-3 : 1e-3);
}

/// Blocks of one facet a side, the upper one of which stands on its edge above the lower one's, which it
/// crosses at right angles: no node of either is in the other.
Surface make_roofs(const double depth, const Tensor<1, 3> &aside = Tensor<1, 3>({0.3, 0.2, 0.})) {
  Surface surface;
  const auto add_roof = [&](const unsigned int label, const Tensor<2, 3> &R, const Tensor<1, 3> &shift) {
    const auto first = static_cast<unsigned int>(surface.positions.size());
    for (const double y : {-1., 1.}) // two flanks that meet in the y axis
      for (const double x : {-1., 0., 1.})
        surface.positions.push_back(shift + R * Tensor<1, 3>({x, y, -std::abs(x)}));
    for (const unsigned int i : {0u, 1u})
      surface.facets.push_back(
          {{first + i, first + i + 1, first + i + 3, first + i + 4}, label, surface.facets.size(), 0.1});
  };
  Tensor<2, 3> upright, over; // over: turned about the y axis by 180, then about the z axis by 90 degrees
  for (unsigned int i = 0; i < 3; ++i)
    upright[i][i] = 1.;
  over[0][1] = -1.;
  over[1][0] = -1.;
  over[2][2] = -1.;
  add_roof(1, upright, Tensor<1, 3>());
  add_roof(0, over, aside + Tensor<1, 3>({0., 0., -depth}));
  return surface;
}

void check_edges() {
  const std::size_t n = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const double depth = 0.01;
  FacetContactSettings settings = make_settings(FacetMethod::planed, nullptr, true);
  double of_nodes = 0.; // which are near
  for (const bool edges : {false, true}) {
    settings.edges = edges;
    const Surface surface = make_roofs(depth, {}); // in the middle of both, where the area is whole
    const Part part(surface, [&](const std::size_t f) { return f % n == rank(); });
    FacetContact contact = make_contact(MPI_COMM_WORLD, settings, part);
    const Positions positions = part.take(surface.positions);
    Positions forces(positions.size());
    contact.add_forces(positions, positions, 0., forces);
    const FacetContactLoad load = contact.works().compute_load();
    std::vector<double> rows(positions.size());
    contact.bounds().add_row_sums(rows);
    double sum_of_rows = 0.;
    for (const double row : rows)
      sum_of_rows += row;
    sum_of_rows = dealii::Utilities::MPI::sum(sum_of_rows, MPI_COMM_WORLD);
    if (!edges) {
      report("roofs: nodes do not see each other", load.absolute_force, 0.);
      of_nodes = sum_of_rows;
      continue;
    }
    std::vector<double> sums(6);
    for (std::size_t i = 0; i < forces.size(); ++i) {
      const Tensor<1, 3> moment = dealii::cross_product_3d(positions[i], forces[i]);
      for (unsigned int c = 0; c < 3; ++c) {
        sums[c] += forces[i][c];
        sums[3 + c] += moment[c];
      }
    }
    dealii::Utilities::MPI::sum(sums, MPI_COMM_WORLD, sums);
    WorstError residual;
    for (const double sum : sums)
      residual.add(std::abs(sum) / load.absolute_force);
    residual.add((load.residual_force.norm() + load.residual_moment.norm()) / load.absolute_force);
    // Edges of length 2: an area of 1.
    const double expected = penalty.normal * depth;
    report("roofs: their edges do", (load.force - Tensor<1, 3>({0., 0., expected})).norm() / expected, 1e-12);
    report("roofs: energy of edges", std::abs(load.stored_energy / (0.5 * expected * depth) - 1.), 1e-12);
    report("roofs: forces and moments balance", residual.value(), 1e-14);
    // And a little for the area that changes.
    const double excess = (sum_of_rows - of_nodes) / (4. * penalty.normal) - 1.;
    report("roofs: sums of rows", excess > 0. ? excess : 1., 0.05);
  }
  settings.edges = true;
  const Surface apart = make_roofs(-depth);
  const Part part = everything(apart);
  FacetContact contact = make_contact(MPI_COMM_SELF, settings, part);
  const Positions positions = part.take(apart.positions);
  Positions forces(positions.size());
  contact.add_forces(positions, positions, 0., forces);
  report("roofs: apart they are free", contact.works().compute_load().absolute_force, 0.);
}

/// Roofs of any shape: the forces are those of the energy, also where an edge crosses near the end of the
/// other, or both do.
void check_potential_of_edges(const std::string &name, const Tensor<1, 3> &aside) {
  FacetContactSettings settings = make_settings(FacetMethod::planed, nullptr, true);
  settings.edges = true;
  Surface surface = make_roofs(0.05, aside);
  Random random;
  for (auto &position : surface.positions)
    for (unsigned int i = 0; i < 3; ++i)
      position[i] += random(-0.02, 0.02);
  const Part part = everything(surface);
  FacetContact contact = make_contact(MPI_COMM_SELF, settings, part);
  const Positions at = part.take(surface.positions);
  const auto forces_at = [&](const Positions &positions) {
    Positions forces(positions.size());
    contact.add_forces(positions, positions, 0., forces);
    return forces;
  };
  const Positions forces = forces_at(at);
  const FacetContactLoad load = contact.works().compute_load();
  WorstError gradient;
  for (std::size_t node = 0; node < at.size(); ++node)
    for (unsigned int i = 0; i < 3; ++i) {
      const double slope = central_difference(
          [&](const double h) {
            Positions positions = at;
            positions[node][i] += h;
            forces_at(positions);
            return contact.works().compute_load().stored_energy;
          },
          1e-4);
      gradient.add(std::abs(forces[node][i] + slope) / load.absolute_force);
    }
  report(name + ": edges touch", load.absolute_force > 1e-4 * penalty.normal ? 0. : 1., 0.);
  report(name + ": forces are those of the energy", gradient.value(), 1e-6);
  report(name + ": forces and moments balance",
         (load.residual_force.norm() + load.residual_moment.norm()) / load.absolute_force, 1e-13);
}

Tensor<1, 3> warped(const double s, const double t) {
  return Tensor<1, 3>({s, t, 0.05 * std::sin(5. * s + 3. * t)});
}

/// A small facet slides below a warped surface of 4 x 4 facets, along seams and over corners.
void check_sliding(const FacetMethod method, const double zone, const bool expected,
                   const std::string &name) {
  Surface surface;
  add_sheet(surface, 1, 1, 0, 0.05, [](const double s, const double t) {
    return Tensor<1, 3>({0.02 * t, 0.02 * s, 0.}); // looks down
  });
  add_sheet(surface, 4, 4, 1, 0.05, warped);
  const Part part = everything(surface);
  FacetContactSettings settings = make_settings(method, nullptr, false);
  settings.limits.zone = zone;
  const Positions start = part.take(surface.positions);
  double maximum = 0., jump = 0.;
  Tensor<1, 3> last;
  const unsigned int n_steps = 2000;
  for (unsigned int step = 0; step <= n_steps; ++step) {
    const double along = 0.2 + 0.6 * step / n_steps;
    Positions positions = start;
    for (const auto &facet : part.facets)
      if (facet.surface == 0)
        for (const unsigned int node : facet.nodes)
          positions[node] = start[node] + warped(along, 0.99 * along) - Tensor<1, 3>({0., 0., 0.01});
    FacetContact contact = make_contact(MPI_COMM_SELF, settings, part);
    Positions forces(positions.size());
    contact.add_forces(positions, positions, 0., forces);
    const Tensor<1, 3> force = contact.works().compute_load().force;
    maximum = std::max(maximum, force.norm());
    if (step > 0)
      jump = std::max(jump, (force - last).norm());
    last = force;
  }
  report(name, (jump < 0.01 * maximum) == expected && maximum > 0. ? 0. : 1., 0.);
}

/// Nodes around the corner of four facets: the same from whichever facet, and in whichever order.
template <class Facet> void check_sharing(const std::string &name) {
  Surface surface;
  add_sheet(surface, 4, 4, 0, 0.05, warped);
  FacetSearch search(FacetSearch::Partners::other_surfaces, 0.05), reversed = search;
  search.set_surface(surface.facets, {});
  reversed.set_surface({surface.facets.rbegin(), surface.facets.rend()}, {});
  const ContactLimits limits;
  Random random;
  WorstError differ, sum_of_shares;
  double max_shares = 0.;
  for (unsigned int i = 0; i < 1000; ++i) {
    const Tensor<1, 3> x = warped(0.5 + random(-0.02, 0.02), 0.5 + random(-0.02, 0.02)) -
                           Tensor<1, 3>({0., 0., random(0., 0.01)});
    bool is_first = true;
    SharedGap expected{Tensor<1, 3>(), 0.};
    for (const FacetSearch *at : {&search, &reversed})
      for (unsigned int f = 0; f < at->facets().size(); ++f) {
        const TouchedFacet touched{f, Facet(corners_of(at->facets()[f], surface.positions))
                                          .project(x, make_limits(limits.zone, limits))};
        if (!touched.projection.exists || !(touched.projection.share > 0.))
          continue;
        std::vector<FacetShare> shares;
        const SharedGap result =
            share_facets<Facet>(MovedFacets(*at, surface.positions), touched, x, limits, shares);
        double sum = 0.;
        for (const auto &share : shares)
          sum += share.share;
        sum_of_shares.add(std::abs(sum - 1.));
        max_shares = std::max(max_shares, static_cast<double>(shares.size()));
        if (is_first)
          expected = result;
        is_first = false;
        differ.add((result.normal - expected.normal).norm() + std::abs(result.gap - expected.gap));
      }
  }
  report(name + ": corner: four facets share a node", std::abs(max_shares - 4.), 0.);
  report(name + ": corner: all of it", sum_of_shares.value(), 1e-15);
  report(name + ": corner: whichever facet was chosen", differ.value(), 1e-14);
}

/// A node that goes to and fro between the flanks of a valley, behind both, in the iterations of one step.
void check_restless() {
  Surface surface;
  add_sheet(surface, 1, 1, 0, 0.1, [](const double s, const double t) {
    return Tensor<1, 3>({1e-3 * t, 0.5 + 1e-3 * s, 0.}); // looks down
  });
  add_sheet(surface, 2, 1, 1, 0.1, [](const double s, const double t) {
    return Tensor<1, 3>({2. * s - 1., t, std::abs(2. * s - 1.)});
  });
  const Part part = everything(surface);
  const Positions above = part.take(surface.positions);
  constexpr unsigned int n_iterations = 30;
  for (const unsigned int maximum : {0u, 4u}) {
    FacetContactSettings settings = make_settings(FacetMethod::planed, nullptr, false);
    settings.max_changes = maximum;
    FacetContact contact = make_contact(MPI_COMM_SELF, settings, part);
    contact.restart();
    unsigned int n_changes = 0;
    double last = 0.;
    for (unsigned int i = 0; i < n_iterations; ++i) {
      Positions positions = above;
      for (const auto &facet : part.facets)
        if (facet.surface == 0)
          for (const unsigned int node : facet.nodes)
            positions[node] += Tensor<1, 3>({i % 2 == 0 ? 0.01 : -0.01, 0., -0.02});
      Positions forces(positions.size());
      contact.add_forces(above, positions, 0., forces);
      const double sideways = contact.works().compute_load().force[0];
      n_changes += last * sideways < 0. ? 1 : 0;
      last = sideways;
    }
    const std::string name = maximum == 0 ? "a node may flip as it likes" : "or so often, and is held then";
    report(name, std::abs(n_changes - (maximum == 0 ? n_iterations - 1. : maximum + 1.)), 0.);
    double worst = 0.;
    for (const auto &node : contact.measures().find_restless())
      worst = std::max<double>(worst, node.n_changes);
    report(name + ": so it is reported", std::abs(worst - (maximum == 0 ? 0. : maximum + 1.)), 0.);
  }
}

/// Below a flat facet, which one target holds already, another one comes up in parallel: the forces of what
/// begins to touch begin at zero.
void check_new_overlap(const FrictionPointer &friction, const std::string &name) {
  const auto forces_at = [&](const double height, double &scale) {
    Surface surface;
    add_sheet(surface, 1, 1, 0, 0.5, [](const double s, const double t) {
      return Tensor<1, 3>({2. * t, s, 0.}); // looks down
    });
    const auto add_target = [&](const double x, const double z) {
      add_sheet(surface, 1, 1, 1, 0.5, [=](const double s, const double t) {
        return Tensor<1, 3>({x + s, t, z});
      });
    };
    add_target(0., 0.01);
    add_target(1., height);
    const Part part = everything(surface);
    const Positions positions = part.take(surface.positions);
    Positions positions_n = positions;
    for (unsigned int node = 0; node < 4; ++node)
      positions_n[node][0] -= 1e-3; // it slips
    FacetContact contact =
        make_contact(MPI_COMM_SELF, make_settings(FacetMethod::overlap, friction, false), part);
    Positions forces(positions.size());
    contact.add_forces(positions_n, positions, 1., forces);
    scale = contact.works().compute_load().absolute_force;
    return forces;
  };
  double scale = 0.;
  const Positions before = forces_at(-1e-9, scale), after = forces_at(1e-9, scale);
  double jump = 0.;
  for (std::size_t i = 0; i < before.size(); ++i)
    jump = std::max(jump, (after[i] - before[i]).norm());
  report(name + ": a new overlap begins without a force", jump / scale, 1e-5);
}

void check_ranks(const Surface &surface, const FacetContactSettings &settings, const std::string &name) {
  const std::size_t n = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  Random random;
  const Part whole = everything(surface),
             part(surface, [&](const std::size_t f) { return f / 5 % n == rank(); });
  RandomMotion motion(random, 2, 2e-3);
  FacetContact serial = make_contact(MPI_COMM_SELF, settings, whole),
               contact = make_contact(MPI_COMM_WORLD, settings, part);
  WorstError forces_differ, rows_differ, loads_differ;
  double max_touching = 0.;
  Positions positions = surface.positions;
  for (unsigned int step = 0; step < 30; ++step) {
    const Positions positions_n = positions;
    motion.advance(surface, surface.slaves(), positions, Tensor<1, 3>({0.1, 0.2, -0.3}));
    // Four numbers a node: force and sum of its row.
    const auto evaluate = [&](FacetContact &at, const Part &nodes) {
      Positions forces(nodes.nodes.size());
      std::vector<double> rows(nodes.nodes.size());
      at.add_forces(nodes.take(positions_n), nodes.take(positions), 1., forces);
      at.bounds().add_row_sums(rows);
      std::vector<double> result(4 * positions.size());
      for (std::size_t i = 0; i < forces.size(); ++i) {
        for (unsigned int c = 0; c < 3; ++c)
          result[4 * nodes.nodes[i] + c] = forces[i][c];
        result[4 * nodes.nodes[i] + 3] = rows[i];
      }
      return result;
    };
    const std::vector<double> expected = evaluate(serial, whole);
    std::vector<double> sums = evaluate(contact, part);
    dealii::Utilities::MPI::sum(sums, MPI_COMM_WORLD, sums);
    const FacetContactLoad serial_load = serial.works().compute_load(), load = contact.works().compute_load();
    double max_row = 0.;
    for (std::size_t i = 3; i < expected.size(); i += 4)
      max_row = std::max(max_row, expected[i]);
    for (std::size_t i = 0; i < sums.size(); ++i)
      if (i % 4 == 3)
        rows_differ.add(std::abs(sums[i] - expected[i]) / max_row);
      else
        forces_differ.add(std::abs(sums[i] - expected[i]) / serial_load.absolute_force);
    loads_differ.add((load.force - serial_load.force).norm() / serial_load.absolute_force);
    loads_differ.add(std::abs(load.stored_energy / serial_load.stored_energy - 1.));
    loads_differ.add(std::abs(load.dissipation - serial_load.dissipation) / serial_load.stored_energy);
    loads_differ.add(std::abs(load.area / serial_load.area - 1.));
    loads_differ.add(std::abs(load.deepest - serial_load.deepest));
    loads_differ.add(std::abs(load.deepest_relative - serial_load.deepest_relative));
    max_touching = std::max(max_touching, serial_load.n_touching);
    serial.commit();
    contact.commit();
  }
  report(name + ": nodes touch", 1. / max_touching, 0.1);
  report(name + ": forces are those of one rank", forces_differ.value(), 1e-12);
  report(name + ": sums of rows too", rows_differ.value(), 1e-12);
  report(name + ": loads too", loads_differ.value(), 1e-12);
  report(name + ": lists are made when one rank makes them",
         serial.search().n_rebuilds() == contact.search().n_rebuilds() && serial.search().n_rebuilds() < 20
             ? 0.
             : 1.,
         0.);
}

} // namespace

BILLET_MPI_TEST(facet_contact) {
  for (const auto &[method, name] : {std::make_pair(FacetMethod::planed, std::string("planed")),
                                     std::make_pair(FacetMethod::bilinear, std::string("bilinear"))}) {
    check_known_force(method, name);
    check_balance(method, nullptr, name + ", frictionless");
    check_balance(method, make_coulomb(0.2), name + ", Coulomb");
    check_impact(method, name);
    check_sliding(method, 0.1, true, name + ": forces do not jump across seams");
    check_sliding(method, 1e-6, false, name + ": but would if facets did not share nodes");
    FacetContactSettings settings = make_settings(method, make_coulomb(0.2), true);
    settings.edges = true;
    check_ranks(make_balls(), settings, name);
    settings.partners = FacetSearch::Partners::other_surfaces_and_self;
    settings.limits.max_alignment = 0.;
    check_ranks(make_strip(0.015), settings, name + ", self-contact");
  }
  check_sharing<PlanedFacet>("planed");
  check_sharing<BilinearFacet>("bilinear");
  check_restless();
  check_new_overlap(nullptr, "frictionless");
  check_new_overlap(make_coulomb(0.2), "Coulomb");
  check_edges();
  check_potential_of_edges("roofs, skew", Tensor<1, 3>({0.3, 0.2, 0.}));
  check_potential_of_edges("roofs at an end", Tensor<1, 3>({0.3, 0.9, 0.}));
  check_potential_of_edges("roofs at both ends", Tensor<1, 3>({-0.7, 0.8, 0.}));
}

} // namespace facet_contact_test
