// SPDX-License-Identifier: LGPL-2.1-or-later
// Load paths, what penetration takes of them, and forces that few nodes carry.
#include "billet/solve/contact_review.h"
#include "../testing.h"

#include <cmath>

namespace contact_review_test {

using namespace billet;
using billet::testing::check;

namespace {

/// Springs of a body and its contact in series, pressed by a growing displacement.
double softness(const double body, const double contact, const double share_of_all = 1.) {
  PathSoftness path;
  for (unsigned int i = 0; i <= 10; ++i) {
    const double force = i / (1. / body + 1. / contact), of_body = 0.5 * force * force / body,
                 of_contact = 0.5 * force * force / contact;
    path.add(0.1 * i, of_contact, of_body, (of_body + of_contact) / share_of_all);
  }
  return path.part();
}

ForceSpread spread(const std::vector<double> &forces, const double images = 1.) {
  ForceSpread result;
  for (const double force : forces) {
    result.force += images * force;
    result.squares += images * force * force;
    result.nodes += 1.;
    result.pressures += force;
    result.pressure_squares += force * force;
  }
  result.indentation = 1.;
  return result;
}

} // namespace

BILLET_TEST(contact_review) {
  {
    const auto paths = find_load_paths(5, {{0}, {0, 1}, {2, 2}, {1, 3}});
    check("bodies that touch are a path", paths.size() == 2 && paths[0].bodies.size() == 3 &&
                                              paths[0].pairs == std::vector<std::size_t>{0, 1, 3});
    check("one that touches itself is its own",
          paths[1].bodies == std::vector<std::size_t>{2} && paths[1].pairs == std::vector<std::size_t>{2});
  }
  {
    // k = 1/(1/k_b + 1/k_c): too small by the part k_b/(k_b + k_c).
    check("the part by which springs in series are softer", std::abs(softness(3., 7.) - 0.3), 1e-12);
    PathSoftness single;
    single.add(1., 0.2, 0.8, 1.);
    check("a run of one step is judged, too", std::abs(single.part() - 0.2), 1e-12);
    check("beside much other energy it is no matter",
          softness(3., 7., 0.001) == 0. && softness(3., 7., 0.5) > 0.);
    PathSoftness path;
    path.add(0., 0., 1., 1.);
    path.add(1., 0., 1., 1.);
    check("nor where nothing presses", path.part() == 0.);
    path.add(2., 1., 1., 2.);
    const double part = path.part();
    path.add(3., 0., 1., 1.);
    path.add(100., 0., 1., 1.);
    check("what lasts after contact does not count", part > 0.3 && path.part() > 0.3);
    std::vector<double> numbers;
    path.save(numbers);
    PathSoftness other;
    other.load(numbers.data());
    check("it survives a restart", numbers.size() == PathSoftness::n_numbers && other.part() == path.part());
  }
  {
    check("one node is few", spread({1.}).has_few_nodes() && spread({1.}).effective_nodes() == 1.);
    check("so is a node with eight that bear little",
          spread({1., 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1}).has_few_nodes());
    check("a flat face needs no more than its corners", !spread({1., 1., 1., 1.}).has_few_nodes());
    check("two nodes are few", spread({1., 0.9}).has_few_nodes());
    check("mirror images count", !spread({1., 0.5}, 4.).has_few_nodes());
    check("many are not few", !spread({1., 0.9, 0.9, 0.9, 0.9, 0.4, 0.4, 0.4, 0.4}).has_few_nodes());
    ForceSpread bent = spread({1.});
    bent.deformation = 1000.;
    check("nor where the bodies hardly indent each other", !bent.has_few_nodes());
    bent.deformation = 1.;
    check("beside their deformation", bent.has_few_nodes());
    check("pressures are alike or not",
          spread({1., 1., 0.9}).is_uniform() && !spread({1., 1., 0.}).is_uniform());
    check("without force there is nothing", !ForceSpread().has_few_nodes());
    ForceSpread curved = spread({1., 1.});
    curved.on_coarse_curves = 1.;
    check("half of the force is on coarse curves", curved.part_on_coarse() == 0.5);
    check("without force none is", ForceSpread().part_on_coarse() == 0.);
  }
}

} // namespace contact_review_test
