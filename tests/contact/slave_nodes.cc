// SPDX-License-Identifier: LGPL-2.1-or-later
// Slave nodes by themselves: which nodes they are in one pass and in two, their penalties, and what they
// touched at the start of the step when facets get other indices.
#include "billet/contact/slave_nodes.h"
#include "billet/contact/slave_start.h"

#include "../testing.h"

#include <vector>

namespace slave_nodes_test {

using namespace billet;
using namespace billet::testing;

namespace {

SurfaceFacet make_facet(const std::array<unsigned int, 4> &nodes, const unsigned int surface,
                        const std::uint64_t key) {
  SurfaceFacet facet{};
  facet.nodes = nodes;
  facet.surface = surface;
  facet.key = key;
  return facet;
}

/// Two facets of surface 0 with an edge in common, and one of surface 1.
std::vector<SurfaceFacet> make_facets() {
  return {make_facet({0, 1, 2, 3}, 0, 7), make_facet({1, 4, 3, 5}, 0, 3), make_facet({6, 7, 8, 9}, 1, 5)};
}

void check_slaves() {
  std::vector<double> sizes(10);
  std::vector<ContactStiffness> stiffness(10);
  for (unsigned int i = 0; i < 10; ++i) {
    sizes[i] = 1. + i;
    stiffness[i] = {100. * (1. + i), 10. * (1. + i)};
  }
  for (const bool two_pass : {false, true}) {
    const SlaveNodes slaves(make_facets(), two_pass, sizes);
    const std::string name = two_pass ? "two passes: " : "one pass: ";
    check(name + "each node is a slave once", slaves.size() == (two_pass ? 10 : 6));
    const SlavePenalties penalties(slaves, stiffness, two_pass, true);
    bool are_right = true;
    for (std::size_t s = 0; s < slaves.size(); ++s) {
      const unsigned int node = slaves.node(s);
      are_right = are_right && slaves.facet_size(s) == sizes[node] &&
                  slaves.surface(s) == (node < 6 ? 0U : 1U) &&
                  penalties[s].normal == (two_pass ? 0.5 : 1.) * stiffness[node].normal &&
                  penalties[s].tangential == (two_pass ? 0.5 : 1.) * stiffness[node].tangential;
    }
    check(name + "with its size, surface and part of the penalty", are_right);
  }
  const SlaveNodes slaves(make_facets(), false, sizes);
  SlavePenalties penalties(slaves, stiffness, false, true);
  penalties.scale(2., 4.);
  penalties.scale(8., 0.5);
  check("factors on penalties multiply", penalties.stiffening() == 16. &&
                                             penalties.tangential_stiffening() == 2. &&
                                             penalties[0].normal == 1600. && penalties[0].tangential == 20.);
  const SlavePenalties frictionless(slaves, stiffness, false, false);
  check("without friction there is no tangential penalty",
        frictionless[0].normal == 100. && frictionless[0].tangential == 0.);
}

void check_start() {
  const std::vector<SurfaceFacet> facets = make_facets();
  SlaveStart start(2);
  check("nothing is touched before the first step ends",
        !start.has_started() && !start.touched(0).exists() && !start.pressed_anywhere());
  TouchedFacet touched;
  touched.facet = 1;
  touched.offset = 0.25;
  start.commit();
  start.set(0, touched, facets, {3., 0.5, 2., dealii::Tensor<1, 3>({0., 0., 1.})});
  touched.facet = 2;
  start.set(1, touched, facets, {});
  check("the end of a step becomes the start of the next", start.has_started() && start.pressed_anywhere() &&
                                                               start.touched(0).facet == 1 &&
                                                               start.pressed(0).area == 2.);
  start.find_facets({facets[1], facets[0]});
  check("facets are found again by their keys",
        start.touched(0).facet == 0 && start.touched(0).offset == 0.25);
  check("  and what is no longer near is not touched", !start.touched(1).exists());
  start.divide_penetration(0, 2.);
  check("a stiffer penalty is pressed less deep",
        start.pressed(0).penetration == 0.25 && start.pressed(0).pressure == 3.);
}

} // namespace

BILLET_TEST(slave_nodes) {
  check_slaves();
  check_start();
}

} // namespace slave_nodes_test
