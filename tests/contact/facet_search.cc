// SPDX-License-Identifier: LGPL-2.1-or-later
// Candidates are never missed while surfaces move at random, and lists are seldom made anew; the choice
// between facets at ridges, in valleys, beside blocks, behind walls, and of fast nodes.
#include "billet/contact/facet_search.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/planed_facet.h"

#include "surfaces.h"

#include <algorithm>
#include <set>

namespace facet_search_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

Tensor<1, 3> vector(const double x, const double y, const double z) { return Tensor<1, 3>({x, y, z}); }

double distance(const SurfaceFacet &facet, const Positions &positions, const Tensor<1, 3> &x) {
  const FacetCorners corners = corners_of(facet, positions);
  const FacetProjection p = BilinearFacet(corners).project(x, {0.});
  return (x - facet::interpolate(p.weights, corners)).norm();
}

bool is_candidate(const FacetSearch &search, const std::size_t slave, const unsigned int facet) {
  bool found = false;
  search.visit_candidates(slave, [&](const unsigned int candidate) { found = found || candidate == facet; });
  return found;
}

/// The node's facets, and those that share a node with them.
bool is_around(const Surface &surface, const unsigned int node, const SurfaceFacet &facet) {
  for (const auto &own : surface.facets)
    if (std::count(own.nodes.begin(), own.nodes.end(), node) > 0)
      for (const unsigned int other : own.nodes)
        if (std::count(facet.nodes.begin(), facet.nodes.end(), other) > 0)
          return true;
  return false;
}

void check_nothing_is_missed(const FacetSearch::Partners partners, const double speed,
                             const unsigned int n_steps, const std::string &name) {
  Random random;
  Surface surface;
  add_ball(surface, 10, 0, 0.05, vector(0., 0., 0.), 1.);
  add_ball(surface, 7, 1, 0.08, vector(0.9, 0.2, 0.3), 0.6);
  add_sheet(surface, 6, 6, 2, 0.05,
            [](const double s, const double t) { return vector(2. * s - 1., 2. * t - 1., 0.3 * s * t); });
  const auto slaves = surface.slaves();
  std::vector<bool> around(slaves.size() * surface.facets.size());
  for (std::size_t s = 0; s < slaves.size(); ++s)
    for (std::size_t f = 0; f < surface.facets.size(); ++f)
      around[s * surface.facets.size() + f] = is_around(surface, slaves[s].node, surface.facets[f]);

  RandomMotion motion(random, 3, speed);
  FacetSearch search(partners, 0.1);
  search.set_surface(surface.facets, slaves);
  Positions positions = surface.positions;
  std::size_t n_pairs = 0, n_missed = 0, n_forbidden = 0;
  for (unsigned int step = 0; step < n_steps; ++step) {
    const Positions positions_n = positions;
    motion.advance(surface, slaves, positions, vector(0.3, -0.2, 0.1)); // far more than the margin
    update(search, positions_n, positions);
    Positions between = positions;
    for (std::size_t i = 0; i < positions.size(); ++i)
      between[i] = 0.5 * (positions_n[i] + positions[i]);
    for (std::size_t s = 0; s < slaves.size(); ++s)
      for (unsigned int f = 0; f < surface.facets.size(); ++f) {
        const SurfaceFacet &facet = surface.facets[f];
        const unsigned int node = slaves[s].node;
        const bool is_own_surface = facet.surface == slaves[s].surface;
        const bool is_forbidden = is_own_surface && (partners == FacetSearch::Partners::other_surfaces ||
                                                     around[s * surface.facets.size() + f]);
        if (is_forbidden) {
          n_forbidden += is_candidate(search, s, f) ? 1 : 0;
          continue;
        }
        // Something quick first: facets are up to 0.5 long.
        if ((positions[node] - positions[facet.nodes[0]]).norm() > 0.8)
          continue;
        if (distance(facet, positions, positions[node]) <= facet.reach ||
            distance(facet, between, between[node]) <= facet.reach) {
          ++n_pairs;
          n_missed += is_candidate(search, s, f) ? 0 : 1;
        }
      }
  }
  check(name + ": no pair within reach is missed", n_missed == 0 && n_pairs > 100);
  check(name + ": nodes and the facets around them are no pairs", n_forbidden == 0);
  if (speed < 0.01)
    check(name + ": lists are seldom made anew", static_cast<double>(search.n_rebuilds()), 0.2 * n_steps);
}

void check_motion() {
  Surface surface;
  add_sheet(surface, 2, 2, 0, 0.1, [](const double s, const double t) { return vector(s, t, 0.); });
  FacetSearch search(FacetSearch::Partners::other_surfaces_and_self, 0.2);
  search.set_surface(surface.facets, surface.slaves());
  Positions x = surface.positions;
  update(search, x, x);
  for (unsigned int step = 0; step < 100; ++step) {
    for (auto &position : x)
      position += vector(1., 2., 3.);
    update(search, x, x);
  }
  check("what moves all together needs no new lists", search.n_rebuilds() == 1);
  x[4] += vector(0.19, 0., 0.);
  update(search, x, x);
  const std::size_t n_within = search.n_rebuilds();
  x[0] -= vector(0.02, 0., 0.);
  update(search, x, x);
  check("more than the margin apart does", n_within == 1 && search.n_rebuilds() == 2);
  search.set_surface({}, {});
  update(search, {}, {});
  check("nothing has no candidates", search.n_candidates() == 0);
}

/// A node against the facets of `surface`; the node comes last.
struct Probe {
  Surface surface;
  FacetSearch search{FacetSearch::Partners::other_surfaces, 1e-6};
  ContactLimits limits;

  explicit Probe(Surface targets) : surface(std::move(targets)) {
    const auto node = static_cast<unsigned int>(surface.positions.size());
    surface.positions.push_back({});
    search.set_surface(surface.facets, {{node, 99}});
  }

  template <class Facet>
  TouchedFacet operator()(const Tensor<1, 3> &from, const Tensor<1, 3> &to, const TouchedFacet &last = {}) {
    Positions positions_n = surface.positions, positions = surface.positions;
    positions_n.back() = from;
    positions.back() = to;
    update(search, positions_n, positions);
    return choose_facet<Facet>(MovedFacets(search, positions), 0, positions_n, last, limits);
  }
};

/// Two planes of 4 × 4 facets of size 0.25 that meet in the line x = 0: at an angle, up (> 0) or down from
/// the horizontal plane on each side.
Surface make_fold(const double angle, const double reach) {
  Surface surface;
  add_sheet(surface, 8, 4, 0, reach, [&](const double s, const double t) {
    const double x = 2. * s - 1.;
    return vector(x * std::cos(angle), t, std::abs(x) * std::sin(angle));
  });
  return surface;
}

template <class Facet> void check_choice(const std::string &name) {
  { // a ridge at 45 degrees: the nearer flank
    Probe probe(make_fold(-M_PI / 4., 0.1));
    const TouchedFacet left = probe.operator()<Facet>(vector(-0.02, 0.4, 0.01), vector(-0.02, 0.4, -0.05)),
                       right = probe.operator()<Facet>(vector(0.02, 0.4, 0.01), vector(0.02, 0.4, -0.05));
    check(name + ": ridge: the shortest way out", left.exists() && right.exists() &&
                                                      left.projection.normal[0] < 0. &&
                                                      right.projection.normal[0] > 0.);
    check(name + ": ridge: a node before it is free",
          !probe.operator()<Facet>(vector(0., 0.4, 0.1), vector(0.01, 0.4, 0.001)).exists());
    const TouchedFacet kept =
        probe.operator()<Facet>(vector(0.02, 0.4, -0.05), vector(-0.005, 0.4, -0.05), right);
    check(name + ": ridge: the last facet stays while it is one", kept.facet == right.facet);
  }
  { // a valley: the flank in which the node is deeper, also against the last one, and below both ends
    Probe probe(make_fold(M_PI / 4., 0.1));
    const TouchedFacet right = probe.operator()<Facet>(vector(0.1, 0.4, 0.12), vector(0.1, 0.4, 0.09));
    check(name + ": valley: one flank", right.exists() && right.projection.normal[0] < 0.);
    const TouchedFacet bottom =
        probe.operator()<Facet>(vector(0.001, 0.4, 0.01), vector(0.001, 0.4, -0.002), right);
    check(name + ": valley: the bottom", bottom.exists());
    const TouchedFacet held =
        probe.operator()<Facet>(vector(0.001, 0.4, -0.002), vector(0.01, 0.4, -0.06), bottom);
    check(name + ": valley: below both flanks",
          held.exists() && held.projection.gap < -0.03 && held.projection.excess > probe.limits.tolerance);
  }
  { // a step of two walls: a node that is held by the floor and runs into the wall
    Surface surface;
    add_sheet(surface, 4, 4, 0, 0.1, [](const double s, const double t) { return vector(s, t, 0.); });
    add_sheet(surface, 4, 4, 0, 0.1, [](const double s, const double t) { return vector(1., t, s); });
    Probe probe(surface);
    const TouchedFacet floor = probe.operator()<Facet>(vector(0.9, 0.4, 0.01), vector(0.9, 0.4, -0.01));
    const TouchedFacet wall =
        probe.operator()<Facet>(vector(0.9, 0.4, -0.01), vector(1.02, 0.4, 0.005), floor);
    check(name + ": step: floor, then wall", floor.exists() && floor.projection.normal[2] == 1. &&
                                                 wall.exists() && wall.projection.normal[0] == -1.);
  }
  { // a block: the top face and a side
    Surface surface;
    add_sheet(surface, 4, 4, 0, 0.1, [](const double s, const double t) { return vector(s, t, 0.); });
    add_sheet(surface, 4, 4, 0, 0.1, [](const double s, const double t) { return vector(1., s, t - 1.); });
    // They share the nodes of the edge.
    for (auto &facet : surface.facets)
      for (auto &node : facet.nodes)
        for (unsigned int other = 0; other < node; ++other)
          if ((surface.positions[node] - surface.positions[other]).norm() == 0.)
            node = other;
    Probe probe(surface);
    check(name + ": block: a node beside it is free",
          !probe.operator()<Facet>(vector(1.003, 0.4, 0.01), vector(1.003, 0.4, -0.04)).exists());
    const TouchedFacet top = probe.operator()<Facet>(vector(0.99, 0.4, 0.01), vector(0.99, 0.4, -0.005));
    check(name + ": block: a node on its top is not", top.exists() && top.projection.normal[2] == 1.);
    check(name + ": block: one that slides off it is",
          !probe.operator()<Facet>(vector(0.99, 0.4, -0.005), vector(1.001, 0.4, -0.005), top).exists());
  }
  { // a wall of thickness 0.15: its far side does not see what is on its near side
    Surface surface;
    add_sheet(surface, 4, 4, 0, 0.06, [](const double s, const double t) { return vector(s, t, 0.); });
    add_sheet(surface, 4, 4, 0, 0.06, [](const double s, const double t) { return vector(t, s, -0.15); });
    Probe probe(surface);
    TouchedFacet touched;
    bool is_front = true;
    double z = 0.005;
    for (unsigned int step = 0; step < 26; ++step, z -= 0.01) {
      touched = probe.operator()<Facet>(vector(0.4, 0.4, z), vector(0.4, 0.4, z - 0.01), touched);
      is_front = is_front && touched.exists() && touched.projection.normal[2] == 1.;
    }
    check(name + ": wall: a node stays on the side from which it came", is_front);
    check(name + ": wall: one that is deep inside has not come through",
          !probe.operator()<Facet>(vector(0.4, 0.4, -0.07), vector(0.4, 0.4, -0.075)).exists());
    const TouchedFacet fast = probe.operator()<Facet>(vector(0.4, 0.4, 0.1), vector(0.4, 0.4, -0.12));
    check(name + ": wall: one that is fast has", fast.exists() && fast.projection.normal[2] == 1.);
    const TouchedFacet shot = probe.operator()<Facet>(vector(0.4, 0.4, 5.), vector(0.4, 0.4, -2.));
    check(name + ": wall: and one that is very fast too", shot.exists() && shot.projection.normal[2] == 1.);
  }
}

void check_self_contact() {
  const Surface surface = make_strip(0.01);
  FacetSearch search(FacetSearch::Partners::other_surfaces_and_self, 0.02);
  const auto slaves = surface.slaves();
  search.set_surface(surface.facets, slaves);
  update(search, surface.positions, surface.positions);
  unsigned int n_front = 0;
  const MovedFacets facets(search, surface.positions);
  for (std::size_t s = 0; s < slaves.size(); ++s) {
    const auto touched = choose_facet<PlanedFacet>(facets, s, surface.positions, {}, ContactLimits());
    if (touched.exists() && surface.positions[slaves[s].node][0] > 0.3)
      ++n_front;
  }
  check("a strip folded onto itself touches itself", n_front > 40);
}

/// Sheets, of which the upper one is a little below the other.
void check_alignment() {
  for (const bool is_opposed : {true, false}) {
    Surface surface;
    add_sheet(surface, 5, 5, 0, 0.1, [](const double s, const double t) { return vector(s, t, 0.); });
    add_sheet(surface, 4, 4, 1, 0.1, [&](const double s, const double t) {
      return vector(is_opposed ? t : s, is_opposed ? s : t, -0.01);
    });
    FacetSearch search(FacetSearch::Partners::other_surfaces, 0.02);
    search.set_surface(surface.facets, surface.slaves());
    update(search, surface.positions, surface.positions);
    const MovedFacets facets(search, surface.positions);
    unsigned int n_touching = 0;
    for (std::size_t s = 0; s < search.slaves().size(); ++s)
      n_touching +=
          choose_facet<PlanedFacet>(facets, s, surface.positions, {}, ContactLimits()).exists() ? 1 : 0;
    check(is_opposed ? "sheets that face each other touch" : "sheets that face the same way do not",
          n_touching == (is_opposed ? search.slaves().size() : 0));
  }
}

} // namespace

BILLET_TEST(facet_search) {
  using Partners = FacetSearch::Partners;
  check_nothing_is_missed(Partners::other_surfaces, 1e-3, 100, "three bodies");
  check_nothing_is_missed(Partners::other_surfaces_and_self, 1e-3, 60, "with themselves");
  check_nothing_is_missed(Partners::other_surfaces, 0.1, 30, "fast");
  check_motion();
  check_choice<PlanedFacet>("planed");
  check_choice<BilinearFacet>("bilinear");
  check_self_contact();
  check_alignment();
}

} // namespace facet_search_test
