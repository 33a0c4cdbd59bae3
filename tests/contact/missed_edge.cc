// SPDX-License-Identifier: LGPL-2.1-or-later
// Nodes that miss the edge of a tool's surface, here of the half plane z = 0, x < 0: from where they miss it,
// what another tool below the edge changes, what they meet when they move back in, and saved states.
#include "billet/contact/missed_edge.h"

#include "memory_state.h"

#include "../geometry/make_surface.h"
#include "../testing.h"

#include <cmath>

namespace missed_edge_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

Tensor<1, 3> at(const double x, const double z) { return Tensor<1, 3>({x, 0.3, z}); }

ContactPoint make_node() {
  ContactPoint node{};
  node.size = 1.; // w = 0.05
  return node;
}

struct Edge {
  SharedSurface surface = make_surface("extruded profile", "set Corners = -1, 0 ; 0, 0\nset Axis = 0, -1, 0\n"
                                                           "set Direction = 1, 0, 0");
  ToolStep step{*surface, Placement()};
  NeighbouringTools neighbours;
  MissedEdge edge{step, neighbours};

  bool misses(const ContactPoint &node, const Tensor<1, 3> &position) const {
    const Tensor<1, 3> on_tool = step.placement.to_tool(position);
    return edge.is_missed_by(node, position, on_tool, surface->project(on_tool));
  }
};

void check_zone() {
  Edge edge;
  ContactPoint node = make_node();
  check("beyond the edge and deep: missed", edge.misses(node, at(0.2, -0.1)));
  check("where pressure still fades: not", !edge.misses(node, at(0.04, -0.1)));
  check("less deep than w: not", !edge.misses(node, at(0.2, -0.04)));
  check("in front of the surface's plane: not", !edge.misses(node, at(0.2, 0.1)));
  check("farther than two facets away: not", !edge.misses(node, at(2.1, -0.1)));
  check("below the surface: not", !edge.misses(node, at(-0.2, -0.1)));
  node.initial_penetration = 0.07;
  check("an allowed penetration is no depth", !edge.misses(node, at(0.2, -0.1)));
  edge.step.allowed_part = 0.5;
  check("  except where it has faded", edge.misses(node, at(0.2, -0.1)));
  node.initial_penetration = 0.;
  edge.step.placement.translation[0] = 0.1;
  check("the tool moves: the edge does, too",
        !edge.misses(node, at(0.14, -0.1)) && edge.misses(node, at(0.16, -0.1)));
}

void check_neighbours() {
  Edge edge;
  const ContactPoint node = make_node();
  const SharedSurface plane = make_surface("plane", "set Point = 0, 0, -0.5");
  ToolStep other(*plane, Placement());
  edge.neighbours.add(other);
  check("another tool below the edge: no node misses it", !edge.misses(node, at(0.2, -0.1)));
  other.placement.translation[2] = -0.7;
  check("  but a facet away it does not count", edge.misses(node, at(0.2, -0.1)));
  other.placement.translation[2] = 0.;
  other.is_removed = true;
  check("  nor once it is removed", edge.misses(node, at(0.2, -0.1)));
  other.is_removed = false;

  const auto is_near = [&](const double size, const Tensor<1, 3> &facing) {
    return edge.neighbours.is_near(at(0.2, -0.1), size, facing);
  };
  const Tensor<1, 3> up({0., 0., 1.}), aslant({0.8, 0., 0.6}), across({1., 0., 0.});
  check("a tool that faces the same way", is_near(0.41, up) && is_near(0.41, aslant) && !is_near(0.39, up));
  check("  one that faces another way does not count", !is_near(1., across) && !is_near(1., -up));
  const auto turned = [](const double degrees) {
    return Tensor<1, 3>({std::sin(degrees * M_PI / 180.), 0., std::cos(degrees * M_PI / 180.)});
  };
  check("  up to 60 degrees away", is_near(1., turned(58.)) && !is_near(1., turned(62.)));
  other.placement.rotation = Tensor<2, 3>({{0., 0., 1.}, {0., 1., 0.}, {-1., 0., 0.}}); // z to x
  check("  and turns with its placement", is_near(1., across) && !is_near(1., up));
}

void check_return() {
  Edge edge;
  std::vector<ContactPoint> nodes(2, make_node());
  std::vector<ToolContactState> states(2);
  states[0].position = at(0.2, -0.1);
  states[0].is_behind = true;
  states[1].position = at(0.2, 0.2);
  edge.edge.commit(nodes, states);
  check("a node that has missed the edge is marked, at its position",
        nodes[0].is_behind && !nodes[1].is_behind && nodes[0].behind_at == states[0].position);
  check("nothing is found behind the surface yet", !edge.edge.has_nodes_behind());
  check("it misses the edge where another node would not, too",
        edge.misses(nodes[0], at(0.2, -0.01)) && !edge.misses(nodes[1], at(0.2, -0.01)));
  check("it moves back in: no contact from behind", edge.misses(nodes[0], at(-0.2, -0.1)));
  check("  until it comes out in front", !edge.misses(nodes[0], at(-0.2, 0.01)));
  nodes[1].is_behind = true;
  nodes[1].behind_at = at(0.2, 0.2);
  check("a surface that it comes to from the front is met", !edge.misses(nodes[1], at(-0.2, -0.1)));
  nodes[1].is_behind = false;

  states[0].is_passed = true;
  edge.edge.commit(nodes, states);
  check("a node behind the surface is found", edge.edge.has_nodes_behind());

  MemoryState saved;
  MemoryWriter writer(saved);
  const SlaveSurface::Range range{"", 0, 2, {7, 3}};
  MissedEdge::save(writer, nodes, range);
  std::vector<ContactPoint> loaded(2, make_node());
  MissedEdge::load(MemoryReader(saved), loaded, {"", 0, 2, {3, 7}});
  check("saved nodes are found by their keys",
        loaded[1].is_behind && !loaded[0].is_behind && loaded[1].behind_at == nodes[0].behind_at);
  std::vector<ContactPoint> points(2, make_node());
  const SlaveSurface::Range interior{"interior ", 0, 2, {8, 7}};
  MissedEdge::load(MemoryReader(saved), points, interior);
  saved.rows["interior behind"] = saved.rows["behind"];
  check("a state without points inside facets", !points[0].is_behind && !points[1].is_behind);
  MissedEdge::load(MemoryReader(saved), points, interior);
  check("  and with other points", !points[0].is_behind && points[1].is_behind);
}

} // namespace

BILLET_TEST(missed_edge) {
  check_zone();
  check_neighbours();
  check_return();
}

} // namespace missed_edge_test
