// SPDX-License-Identifier: LGPL-2.1-or-later
// Usage: facet_search_cost [LARGEST]
//
// Two wavy sheets slide over each other in contact, each half of all facets, from a thousand to LARGEST (a
// million). Prints a table: facets, time of one making of the lists and of one step of looking them up
// (planed, bilinear) in nanoseconds a facet, candidates a node, how many nodes touch, and steps between two
// lists.
#include "billet/contact/facet_choice.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/planed_facet.h"

#include "../contact/surfaces.h"

#include <chrono>
#include <cstdio>
#include <string>

using namespace billet;
using billet::testing::Positions;
using billet::testing::Surface;
using dealii::Tensor;

namespace {

double seconds(const std::function<void()> &action) {
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class Facet>
std::size_t choose_all(MovedFacets &facets, const Positions &positions_n,
                       std::vector<TouchedFacet> &touched) {
  facets.reset();
  std::size_t n = 0;
  for (std::size_t s = 0; s < touched.size(); ++s) {
    touched[s] = choose_facet<Facet>(facets, s, positions_n, touched[s], ContactLimits());
    n += touched[s].exists() ? 1 : 0;
  }
  return n;
}

/// With n facets along one side.
void measure(const unsigned int n, const bool is_shown = true) {
  Surface surface;
  const double h = 1. / n, depth = 0.01 * h;
  const auto height = [](const double x, const double y) {
    return 0.05 * std::sin(9. * x) * std::cos(7. * y);
  };
  billet::testing::add_sheet(surface, n, n, 0, 0.1 * h, [&](const double s, const double t) {
    return Tensor<1, 3>({s, t, height(s, t)});
  });
  billet::testing::add_sheet(surface, n, n, 1, 0.1 * h, [&](const double s, const double t) {
    return Tensor<1, 3>({t + 0.3 * h, s + 0.4 * h, height(t + 0.3 * h, s + 0.4 * h) - depth});
  });
  const auto slaves = surface.slaves();
  FacetSearch search(FacetSearch::Partners::other_surfaces, 0.5 * h);
  search.set_surface(surface.facets, slaves);
  Positions positions = surface.positions;
  const double making = seconds([&] { search.rebuild(positions, positions); });

  MovedFacets facets(search, positions);
  constexpr unsigned int n_steps = 10;
  std::array<double, 2> looking{};
  std::size_t n_touching = 0;
  std::vector<TouchedFacet> planed(slaves.size()), bilinear(slaves.size());
  for (unsigned int step = 0; step < n_steps; ++step) {
    const Positions positions_n = positions;
    for (const auto &slave : slaves)
      positions[slave.node][0] += slave.surface == 0 ? 0.01 * h : 0.;
    looking[0] += seconds([&] {
      billet::testing::update(search, positions_n, positions);
      n_touching = choose_all<PlanedFacet>(facets, positions_n, planed);
    });
    looking[1] += seconds([&] {
      billet::testing::update(search, positions_n, positions);
      choose_all<BilinearFacet>(facets, positions_n, bilinear);
    });
  }
  if (!is_shown)
    return;
  const auto n_facets = static_cast<double>(surface.facets.size());
  std::printf("%9.0f %12.0f %12.0f %12.0f %10.1f %9.0f %8.1f\n", n_facets, 1e9 * making / n_facets,
              1e9 * looking[0] / n_steps / n_facets, 1e9 * looking[1] / n_steps / n_facets,
              static_cast<double>(search.n_candidates()) / static_cast<double>(slaves.size()),
              static_cast<double>(n_touching), n_steps / static_cast<double>(search.n_rebuilds()));
}

} // namespace

int main(int argc, char *argv[]) {
  const double maximum = argc > 1 ? std::stod(argv[1]) : 1e6;
  std::printf("%9s %12s %12s %12s %10s %9s %8s\n", "facets", "lists", "planed", "bilinear", "candidates",
              "touching", "steps");
  measure(70, false); // so that the first row does not pay for a machine that was asleep
  for (double n_facets = 1e3; n_facets < 1.01 * maximum; n_facets *= std::sqrt(10.))
    measure(static_cast<unsigned int>(std::lround(std::sqrt(0.5 * n_facets))));
  return 0;
}
