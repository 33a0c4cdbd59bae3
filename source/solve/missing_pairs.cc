// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/missing_pairs.h"

#include "billet/contact/overlap.h"
#include "billet/diagnostic_kinds.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/box_tree.h"

#include <deal.II/base/geometry_info.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

namespace billet {

using dealii::Point;
using dealii::Tensor;

namespace {

using Corners = std::array<Tensor<1, 3>, 8>;

bool overlap(const BoundingBox &a, const BoundingBox &b) {
  for (unsigned int i = 0; i < 3; ++i)
    if (!(a.low[i] <= b.high[i] && b.low[i] <= a.high[i]))
      return false;
  return true;
}

bool contains(const BoundingBox &box, const Tensor<1, 3> &x) {
  constexpr double none = 0.;
  return box.distance_square(x) <= none;
}

/// Whether a point is in a trilinear element, by Newton's method for its reference coordinates.
bool is_inside(const Corners &corners, const Tensor<1, 3> &x) {
  using Unit = dealii::GeometryInfo<3>;
  constexpr unsigned int max_iterations = 15;
  constexpr double rounding = 1e-9, converged = 1e-10, far = 3.;
  Point<3> xi(0.5, 0.5, 0.5);
  for (unsigned int iteration = 0; iteration < max_iterations; ++iteration) {
    Tensor<1, 3> miss = x;
    Tensor<2, 3> jacobian;
    for (unsigned int v = 0; v < 8; ++v) {
      miss -= Unit::d_linear_shape_function(xi, v) * corners[v];
      jacobian += dealii::outer_product(corners[v], Unit::d_linear_shape_function_gradient(xi, v));
    }
    if (!(std::abs(dealii::determinant(jacobian)) > 0.))
      return false;
    const Tensor<1, 3> change = dealii::invert(jacobian) * miss;
    xi += change;
    if ((xi - Point<3>(0.5, 0.5, 0.5)).norm() > far)
      return false;
    if (change.norm() < converged)
      return Unit::is_inside_unit_cell(xi, rounding);
  }
  return false;
}

/// The smaller one of two lengths that a node may be below this facet before it counts as inside.
double allowed_depth(const BoundaryFacet &facet) {
  return std::min(0.1 * std::sqrt(facet.area_vector().norm()), 0.2 * facet.thickness);
}

Tensor<1, 3> position_of(const Point<3> &X, const std::array<DofIndex, 3> &dofs,
                         const Vector *displacements) {
  Tensor<1, 3> x = X;
  if (displacements != nullptr)
    for (unsigned int i = 0; i < 3; ++i)
      x[i] += (*displacements)(dofs[i]);
  return x;
}

} // namespace

MissingPairs::MissingPairs(const Scene &scene, const Discretization &discretization)
    : scene_(scene), discretization_(discretization), nodes_(scene.bodies().size()),
      facets_(scene.bodies().size()) {
  const std::size_t n_bodies = scene.bodies().size();
  const auto share_pair = [&](const std::size_t a, const std::size_t b) {
    return std::any_of(scene.body_pairs().begin(), scene.body_pairs().end(), [&](const BodyPair &pair) {
      return (pair.bodies[0] == a && pair.bodies[1] == b) || (pair.bodies[0] == b && pair.bodies[1] == a);
    });
  };
  for (std::size_t a = 0; a < n_bodies; ++a) {
    for (std::size_t b = a + 1; b < n_bodies; ++b)
      if (!share_pair(a, b))
        bodies_.push_back({a, b, true, {}});
    for (std::size_t t = 0; t < scene.tools().size(); ++t)
      if (std::none_of(scene.pairs().begin(), scene.pairs().end(),
                       [&](const ContactPair &pair) { return pair.body == a && pair.tool == t; }))
        tools_.push_back({a, t, true, {}});
  }
  std::vector<bool> is_in_couple(n_bodies);
  for (const Couple &couple : bodies_)
    is_in_couple[couple.body] = is_in_couple[couple.other] = true;
  for (const Couple &couple : tools_)
    is_in_couple[couple.body] = true;
  for (std::size_t b = 0; b < n_bodies; ++b) {
    if (!is_in_couple[b])
      continue;
    std::map<DofIndex, Node> nodes;
    for (const auto &facet : collect_boundary_facets(discretization, b)) {
      const double size = std::sqrt(facet.area_vector().norm());
      for (unsigned int v = 0; v < 4; ++v) {
        const auto found = nodes.emplace(facet.dofs[v][0], Node{facet.dofs[v], facet.corners[v], size}).first;
        found->second.facet_size = std::min(found->second.facet_size, size);
      }
    }
    for (const auto &entry : nodes)
      nodes_[b].push_back(entry.second);
    facets_[b] = collect_free_boundary(discretization, b, scene.bodies()[b].holds);
  }
  const Positions positions = positions_at(nullptr);
  const auto boxes = boxes_around(positions);
  for (Couple &couple : bodies_)
    couple.is_open = !find_overlap(couple, positions, boxes, nullptr);
  if (!scene.parameters().restart.is_wanted())
    for (Couple &couple : tools_)
      enter_tool(couple, positions, scene.tools()[couple.other].placement(0.));
}

MissingPairs::Positions MissingPairs::positions_at(const Vector *displacements) const {
  Positions positions(nodes_.size());
  for (std::size_t b = 0; b < nodes_.size(); ++b) {
    positions[b].reserve(nodes_[b].size());
    for (const Node &node : nodes_[b])
      positions[b].push_back(position_of(node.position, node.dofs, displacements));
  }
  return positions;
}

std::vector<BoundingBox> MissingPairs::boxes_around(const Positions &positions) const {
  std::vector<double> ends; // of each body −low, high
  for (const auto &of_body : positions) {
    BoundingBox box = BoundingBox::empty();
    for (const auto &x : of_body)
      box.add(x);
    for (unsigned int i = 0; i < 3; ++i)
      ends.push_back(-box.low[i]);
    for (unsigned int i = 0; i < 3; ++i)
      ends.push_back(box.high[i]);
  }
  dealii::Utilities::MPI::max(ends, discretization_.communicator(), ends);
  std::vector<BoundingBox> boxes(positions.size());
  for (std::size_t b = 0; b < boxes.size(); ++b)
    for (unsigned int i = 0; i < 3; ++i) {
      boxes[b].low[i] = -ends[6 * b + i];
      boxes[b].high[i] = ends[6 * b + 3 + i];
    }
  return boxes;
}

MissingPairs::Deepest MissingPairs::find_deepest(const std::size_t a, const std::size_t b,
                                                 const Positions &positions,
                                                 const std::vector<BoundingBox> &boxes,
                                                 const Vector *displacements) const {
  const MPI_Comm communicator = discretization_.communicator();
  std::vector<std::array<double, 3>> own;
  for (const auto &x : positions[a])
    if (contains(boxes[b], x))
      own.push_back({x[0], x[1], x[2]});
  std::vector<Tensor<1, 3>> points;
  for (const auto &of_rank : dealii::Utilities::MPI::all_gather(communicator, own))
    for (const auto &x : of_rank)
      points.emplace_back(Tensor<1, 3>({x[0], x[1], x[2]}));
  if (points.empty())
    return {};

  std::vector<Corners> elements;
  std::vector<BoundingBox> element_boxes;
  for (const Element &element : discretization_.elements(b)) {
    Corners corners;
    BoundingBox box = BoundingBox::empty();
    for (unsigned int v = 0; v < 8; ++v) {
      const std::size_t first = std::size_t{3} * v;
      corners[v] =
          position_of(element.cell->vertex(v),
                      {element.dofs[first], element.dofs[first + 1], element.dofs[first + 2]}, displacements);
      box.add(corners[v]);
    }
    if (!overlap(box, boxes[a]))
      continue;
    elements.push_back(corners);
    element_boxes.push_back(box);
  }
  const BoxTree tree(element_boxes);
  std::vector<unsigned int> counts(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double nowhere_else = 0.;
    tree.visit_near(points[p], nowhere_else,
                    [&](const unsigned int e) { counts[p] += is_inside(elements[e], points[p]) ? 1 : 0; });
  }
  dealii::Utilities::MPI::sum(counts, communicator, counts);
  std::vector<Tensor<1, 3>> inside;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (counts[p] > 0)
      inside.push_back(points[p]);
  if (inside.empty())
    return {};

  std::vector<FacetCorners> faces;
  std::vector<BoundingBox> face_boxes;
  for (const BoundaryFacet &facet : facets_[b]) {
    faces.emplace_back();
    face_boxes.push_back(BoundingBox::empty());
    for (unsigned int v = 0; v < 4; ++v) {
      faces.back()[v] = position_of(facet.corners[v], facet.dofs[v], displacements);
      face_boxes.back().add(faces.back()[v]);
    }
  }
  const BoxTree surface(face_boxes);
  std::vector<std::array<double, 2>> nearest; // distance and what is allowed there, of this rank
  for (const auto &x : inside) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<double, 2> found{infinity, infinity};
    double square = infinity;
    surface.visit_near(x, square, [&](const unsigned int f) {
      const FacetProjection projection = BilinearFacet(faces[f]).project(x, {0.});
      const double other = (x - facet::interpolate(projection.weights, faces[f])).norm_square();
      if (!(other < square))
        return;
      square = other;
      found = {std::sqrt(other), allowed_depth(facets_[b][f])};
    });
    nearest.push_back(found);
  }
  Deepest deepest;
  const auto of_ranks = dealii::Utilities::MPI::all_gather(communicator, nearest);
  for (std::size_t p = 0; p < inside.size(); ++p) {
    std::array<double, 2> found = of_ranks[0][p];
    for (const auto &of_rank : of_ranks)
      found = std::min(found, of_rank[p]);
    const double relative = found[0] / found[1];
    if (std::isfinite(found[0]) && relative > deepest.relative)
      deepest = {found[0], relative, inside[p]};
  }
  return deepest;
}

std::optional<MissingPairs::Deepest> MissingPairs::find_overlap(const Couple &couple,
                                                                const Positions &positions,
                                                                const std::vector<BoundingBox> &boxes,
                                                                const Vector *displacements) const {
  if (!overlap(boxes[couple.body], boxes[couple.other]))
    return {};
  Deepest deepest = find_deepest(couple.body, couple.other, positions, boxes, displacements);
  const Deepest back = find_deepest(couple.other, couple.body, positions, boxes, displacements);
  if (back.relative > deepest.relative)
    deepest = back;
  return deepest.relative > 1. ? std::optional<Deepest>(deepest) : std::nullopt;
}

MissingPairs::Deepest MissingPairs::enter_tool(Couple &couple, const Positions &positions,
                                               const Placement &placement) const {
  constexpr double part = 0.1; // of a facet
  const RigidSurface &surface = scene_.tools()[couple.other].surface();
  const std::vector<Node> &nodes = nodes_[couple.body];
  const bool is_first = couple.is_in_front.empty();
  std::array<double, 5> own{}; // relative, depth, position
  std::vector<bool> is_in_front(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Tensor<1, 3> &x = positions[couple.body][n];
    const auto projection = surface.project(placement.to_tool(Point<3>(x)));
    if (!projection.exists)
      continue;
    const double allowed = part * nodes[n].facet_size;
    // What comes in little by little stays in front until it is in; where a run resumes it may have begun.
    const bool was_in_front = is_first ? scene_.parameters().restart.is_wanted() : couple.is_in_front[n];
    is_in_front[n] = projection.gap >= 0. || (was_in_front && projection.gap > -allowed);
    if (!is_first && was_in_front && projection.gap <= -allowed)
      own = std::max(own, {-projection.gap / allowed, -projection.gap, x[0], x[1], x[2]});
  }
  couple.is_in_front = std::move(is_in_front);
  const auto of_ranks = dealii::Utilities::MPI::all_gather(discretization_.communicator(), own);
  const auto deepest = *std::max_element(of_ranks.begin(), of_ranks.end());
  return {deepest[1], deepest[0], Tensor<1, 3>({deepest[2], deepest[3], deepest[4]})};
}

std::string MissingPairs::describe_body(const Couple &couple) const {
  return "body '" + scene_.bodies()[couple.other].name + "'";
}

std::string MissingPairs::describe_tool(const Couple &couple) const {
  return "tool '" + scene_.tools()[couple.other].name() + "'";
}

std::string MissingPairs::name_of(const Couple &couple, const std::string &other) const {
  return scene_.bodies()[couple.body].name + " and " + other + "\n";
}

void MissingPairs::save(StateWriter &writer) const { writer.write_text("missing pairs", told_); }

void MissingPairs::load(const StateReader &reader) {
  told_ = reader.read_text("missing pairs");
  const auto is_told = [&](const std::string &name) {
    return ("\n" + told_).find("\n" + name) != std::string::npos;
  };
  for (Couple &couple : bodies_)
    couple.is_open = couple.is_open && !is_told(name_of(couple, describe_body(couple)));
  for (Couple &couple : tools_)
    couple.is_open = couple.is_open && !is_told(name_of(couple, describe_tool(couple)));
}

DiagnosticList MissingPairs::check(const SolutionState &state) {
  DiagnosticList diagnostics;
  if (std::none_of(bodies_.begin(), bodies_.end(), [](const Couple &c) { return c.is_open; }) &&
      std::none_of(tools_.begin(), tools_.end(), [](const Couple &c) { return c.is_open; }))
    return diagnostics;
  const Positions positions = positions_at(&state.displacements);
  const auto boxes = boxes_around(positions);
  const auto report = [&](Couple &couple, const std::string &other, const Deepest &deepest) {
    couple.is_open = false;
    told_ += name_of(couple, other);
    const std::string &body = scene_.bodies()[couple.body].name;
    std::ostringstream text;
    text.precision(3);
    text << "Body '" << body << "' and " << other << " share no contact pair, and are " << deepest.depth
         << " deep in each other";
    diagnostics.push_back(Diagnostic(diagnostic::missing_pair, text.str())
                              .body(body)
                              .at(deepest.position)
                              .time(state.time)
                              .value("depth [length]", deepest.depth));
  };
  for (Couple &couple : bodies_)
    if (couple.is_open)
      if (const auto deepest = find_overlap(couple, positions, boxes, &state.displacements)) {
        report(couple, describe_body(couple), *deepest);
        diagnostics.back().body(scene_.bodies()[couple.other].name);
      }
  for (Couple &couple : tools_) {
    const Tool &tool = scene_.tools()[couple.other];
    if (!couple.is_open || state.time >= tool.removal_time())
      continue;
    const Deepest deepest = enter_tool(couple, positions, state.placements[couple.other]);
    if (deepest.depth > 0.) {
      report(couple, describe_tool(couple), deepest);
      diagnostics.back().tool(tool.name());
    }
  }
  return diagnostics;
}

} // namespace billet
