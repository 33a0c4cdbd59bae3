// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/missing_pairs.h"

#include "billet/algebra/gather.h"
#include "billet/contact/overlap.h"
#include "billet/diagnostic_kinds.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/box_tree.h"
#include "billet/mechanics/reference_point.h"

#include <deal.II/base/geometry_info.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>

namespace billet {

using dealii::Point;
using dealii::Tensor;

namespace {

struct MissingPairsLimits {
  /// Depths from which on a node counts as inside: in sizes of the facet above it, and in
  /// thicknesses of its element.
  static constexpr double part_of_facet = 0.1, part_of_thickness = 0.2;
  /// Depth from which on a node counts as inside a tool [facet size].
  static constexpr double in_tool = 0.1;
  /// Depth within an element from which on a body penetrates itself [element size].
  static constexpr double in_itself = 0.1;
  /// Margin of an element for round-off [element size].
  static constexpr double rounding = 1e-9;
  /// Newton's method for reference coordinates, see ReferenceLimits.
  static constexpr unsigned int max_iterations = 15;
  static constexpr double far = 3.;
};

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

/// Whether a point is in a trilinear element, or beside it by at most `margin` of its size.
bool is_inside(const ElementVectors &corners, const Tensor<1, 3> &x, const double margin) {
  const auto xi =
      find_reference_point(corners, x, {MissingPairsLimits::max_iterations, MissingPairsLimits::far});
  return xi && dealii::GeometryInfo<3>::is_inside_unit_cell(*xi, margin);
}

BoundingBox box_around(const ElementVectors &corners) {
  BoundingBox box = BoundingBox::empty();
  for (unsigned int v = 0; v < n_element_nodes; ++v)
    box.add(Tensor<1, 3>({corners[3 * v], corners[3 * v + 1], corners[3 * v + 2]}));
  return box;
}

/// Returns the number of elements of this rank that contain each point; `margin` as in is_inside().
std::vector<unsigned int> count_elements(const std::vector<ElementVectors> &elements,
                                         const std::vector<Tensor<1, 3>> &points, const double margin) {
  std::vector<BoundingBox> boxes;
  for (const ElementVectors &corners : elements)
    boxes.push_back(box_around(corners));
  const BoxTree tree(boxes);
  std::vector<unsigned int> counts(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double nowhere_else = 0.;
    tree.visit_near(points[p], nowhere_else, [&](const unsigned int e) {
      counts[p] += is_inside(elements[e], points[p], margin) ? 1 : 0;
    });
  }
  return counts;
}

/// Returns the depth below this facet from which on a node counts as inside, the smaller of two
/// lengths.
double allowed_penetration(const BoundaryFacet &facet) {
  return std::min(MissingPairsLimits::part_of_facet * std::sqrt(facet.area_vector().norm()),
                  MissingPairsLimits::part_of_thickness * facet.thickness);
}

Tensor<1, 3> position_of(const Point<3> &X, const std::array<DofIndex, 3> &dofs,
                         const Vector *displacements) {
  Tensor<1, 3> x = X;
  if (displacements != nullptr)
    for (unsigned int i = 0; i < 3; ++i)
      x[i] += (*displacements)(dofs[i]);
  return x;
}

ElementVectors corners_of(const Element &element, const Vector *displacements) {
  ElementVectors corners = nodal_positions(element.cell);
  for (unsigned int i = 0; displacements != nullptr && i < n_element_dofs; ++i)
    corners[i] += (*displacements)(element.dofs[i]);
  return corners;
}

/// Position, and whether a pair names it.
using TestedPoint = std::array<double, 4>;

std::vector<Tensor<1, 3>> positions_of(const std::vector<TestedPoint> &tested) {
  std::vector<Tensor<1, 3>> positions;
  for (const auto &x : tested)
    positions.emplace_back(Tensor<1, 3>({x[0], x[1], x[2]}));
  return positions;
}

} // namespace

MissingPairs::MissingPairs(const Scene &scene, const Discretization &discretization)
    : scene_(scene), discretization_(discretization), nodes_(scene.bodies().size()),
      facets_(scene.bodies().size()) {
  const std::size_t n_bodies = scene.bodies().size();
  for (std::size_t b = 0; b < n_bodies; ++b) {
    std::map<DofIndex, Node> nodes;
    facets_[b] = collect_free_boundary(discretization, b, scene.bodies()[b].constraints);
    for (const BoundaryFacet &facet : facets_[b]) {
      const double size = std::sqrt(facet.area_vector().norm());
      for (unsigned int v = 0; v < 4; ++v) {
        const auto found = nodes.emplace(facet.dofs[v][0], Node{facet.dofs[v], facet.corners[v], size}).first;
        found->second.facet_size = std::min(found->second.facet_size, size);
      }
    }
    for (const auto &entry : nodes)
      nodes_[b].push_back(entry.second);
  }
  const auto add_ids = [](std::vector<unsigned int> &ids, const std::vector<unsigned int> &more) {
    ids.insert(ids.end(), more.begin(), more.end());
  };
  for (std::size_t a = 0; a < n_bodies; ++a) {
    for (std::size_t b = a; b < n_bodies; ++b) {
      std::array<std::vector<unsigned int>, 2> ids;
      bool has_pair = false;
      for (const BodyPair &pair : scene.body_pairs())
        for (const unsigned int first : {0U, 1U})
          if (pair.bodies[first] == a && pair.bodies[1 - first] == b) {
            has_pair = true;
            add_ids(ids[0], pair.boundary_ids[first]);
            add_ids(ids[1], pair.boundary_ids[1 - first]);
          }
      if (a == b) {
        if (!has_pair)
          selves_.push_back({a, a, false, {}, true, {}});
        continue;
      }
      Couple couple{a, b, has_pair, {name_surface(a, ids[0]), name_surface(b, ids[1])}, true, {}};
      if (!is_complete(couple))
        bodies_.push_back(std::move(couple));
    }
    for (std::size_t t = 0; t < scene.tools().size(); ++t) {
      std::vector<unsigned int> ids;
      bool has_pair = false;
      for (const ContactPair &pair : scene.pairs())
        if (pair.body == a && pair.tool == t) {
          has_pair = true;
          add_ids(ids, pair.boundary_ids);
        }
      Couple couple{a, t, has_pair, {name_surface(a, ids), {}}, true, {}};
      if (!is_complete(couple))
        tools_.push_back(std::move(couple));
    }
  }
  const Positions positions = positions_at(nullptr);
  const auto boxes = boxes_around(positions);
  for (Couple &couple : bodies_)
    couple.is_open = !find_overlap(couple, positions, boxes, nullptr);
  for (Couple &couple : selves_)
    couple.is_open = !find_self_overlap(couple, nullptr);
  if (!scene.parameters().restart.is_wanted())
    for (Couple &couple : tools_)
      enter_tool(couple, positions, scene.tools()[couple.other].placement(0.));
}

MissingPairs::Named MissingPairs::name_surface(const std::size_t body,
                                               const std::vector<unsigned int> &boundary_ids) const {
  std::set<std::uint64_t> keys;
  Vector marks = discretization_.make_additive_vector();
  for (const auto &facet : collect_boundary_facets(discretization_, body, boundary_ids)) {
    keys.insert(facet.key);
    for (const auto &dofs : facet.dofs) {
      const double mark = 1.;
      marks.add(1, dofs.data(), &mark);
    }
  }
  marks.compress(dealii::VectorOperation::add);
  Vector ghosted = discretization_.make_ghosted_vector();
  ghosted = marks;
  Named named;
  for (const Node &node : nodes_[body])
    named.nodes.push_back(ghosted(node.dofs[0]) > 0.);
  for (const BoundaryFacet &facet : facets_[body])
    named.facets.push_back(keys.count(facet.key) > 0);
  return named;
}

bool MissingPairs::is_complete(const Couple &couple) const {
  bool is_complete = true;
  for (const Named &named : couple.named)
    for (const auto *part : {&named.nodes, &named.facets})
      is_complete = is_complete && std::find(part->begin(), part->end(), false) == part->end();
  return dealii::Utilities::MPI::min(is_complete ? 1U : 0U, discretization_.communicator()) > 0;
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

MissingPairs::Deepest MissingPairs::find_deepest(const Couple &couple, const bool other_in_first,
                                                 const Positions &positions,
                                                 const std::vector<BoundingBox> &boxes,
                                                 const Vector *displacements) const {
  const MPI_Comm communicator = discretization_.communicator();
  const std::size_t a = other_in_first ? couple.other : couple.body,
                    b = other_in_first ? couple.body : couple.other;
  const Named &named_a = couple.named[other_in_first ? 1 : 0],
              &named_b = couple.named[other_in_first ? 0 : 1];
  std::vector<TestedPoint> own;
  for (std::size_t n = 0; n < positions[a].size(); ++n) {
    const Tensor<1, 3> &x = positions[a][n];
    if (contains(boxes[b], x))
      own.push_back({x[0], x[1], x[2], named_a.nodes[n] ? 1. : 0.});
  }
  const std::vector<TestedPoint> tested = gather_all(communicator, own);
  if (tested.empty())
    return {};

  std::vector<ElementVectors> elements;
  for (const Element &element : discretization_.elements(b)) {
    const ElementVectors corners = corners_of(element, displacements);
    if (overlap(box_around(corners), boxes[a]))
      elements.push_back(corners);
  }
  const std::vector<Tensor<1, 3>> points = positions_of(tested);
  std::vector<unsigned int> counts = count_elements(elements, points, MissingPairsLimits::rounding);
  dealii::Utilities::MPI::sum(counts, communicator, counts);
  std::vector<Tensor<1, 3>> inside;
  std::vector<bool> is_named;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (counts[p] > 0) {
      inside.push_back(points[p]);
      is_named.push_back(tested[p][3] > 0.);
    }
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
  // Distance, allowed depth, and whether a pair names the face, on this rank.
  std::vector<std::array<double, 3>> nearest;
  for (const auto &x : inside) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<double, 3> found{infinity, infinity, 0.};
    double square = infinity;
    surface.visit_near(x, square, [&](const unsigned int f) {
      const FacetProjection projection = BilinearFacet(faces[f]).project(x, {0.});
      const double other = (x - facet::interpolate(projection.weights, faces[f])).norm_square();
      if (!(other < square))
        return;
      square = other;
      found = {std::sqrt(other), allowed_penetration(facets_[b][f]), named_b.facets[f] ? 1. : 0.};
    });
    nearest.push_back(found);
  }
  Deepest deepest;
  const auto of_ranks = all_gather(communicator, nearest);
  for (std::size_t p = 0; p < inside.size(); ++p) {
    std::array<double, 3> found = of_ranks[0][p];
    for (const auto &of_rank : of_ranks)
      found = std::min(found, of_rank[p]);
    if (is_named[p] && found[2] > 0.)
      continue;
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
  Deepest deepest = find_deepest(couple, false, positions, boxes, displacements);
  const Deepest back = find_deepest(couple, true, positions, boxes, displacements);
  if (back.relative > deepest.relative)
    deepest = back;
  return deepest.relative > 1. ? std::optional<Deepest>(deepest) : std::nullopt;
}

std::optional<Tensor<1, 3>> MissingPairs::find_self_overlap(const Couple &couple,
                                                            const Vector *displacements) const {
  const MPI_Comm communicator = discretization_.communicator();
  // Centres of facets: in a body one element thick no node is within an element.
  std::vector<TestedPoint> own;
  for (const BoundaryFacet &facet : facets_[couple.body]) {
    Tensor<1, 3> x;
    for (unsigned int v = 0; v < 4; ++v)
      x += 0.25 * position_of(facet.corners[v], facet.dofs[v], displacements);
    own.push_back({x[0], x[1], x[2], 0.});
  }
  const std::vector<Tensor<1, 3>> points = positions_of(gather_all(communicator, own));
  std::vector<ElementVectors> elements;
  for (const Element &element : discretization_.elements(couple.body))
    elements.push_back(corners_of(element, displacements));
  std::vector<unsigned int> counts = count_elements(elements, points, -MissingPairsLimits::in_itself);
  dealii::Utilities::MPI::sum(counts, communicator, counts);
  const auto found = std::find_if(counts.begin(), counts.end(), [](const unsigned int n) { return n > 0; });
  if (found == counts.end())
    return {};
  return points[static_cast<std::size_t>(found - counts.begin())];
}

MissingPairs::Deepest MissingPairs::enter_tool(Couple &couple, const Positions &positions,
                                               const Placement &placement) const {
  const RigidSurface &surface = scene_.tools()[couple.other].surface();
  const std::vector<Node> &nodes = nodes_[couple.body];
  const bool is_first = couple.is_in_front.empty();
  const std::vector<bool> &is_named = couple.named[0].nodes;
  // Depths of nodes that were in front at the last check, or may have been before a restart.
  std::vector<double> penetrations(nodes.size());
  std::vector<bool> is_in_front(nodes.size());
  double followed = 0.; // penetration of nodes in pairs
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const auto projection = surface.project(placement.to_tool(Point<3>(positions[couple.body][n])));
    if (!projection.exists)
      continue;
    is_in_front[n] = projection.gap >= 0.;
    if (is_first ? scene_.parameters().restart.is_wanted() : couple.is_in_front[n])
      penetrations[n] = std::max(0., -projection.gap);
    if (is_named[n])
      followed = std::max(followed, penetrations[n]);
  }
  followed = dealii::Utilities::MPI::max(followed, discretization_.communicator());
  std::array<double, 5> own{}; // relative, depth, position
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const double allowed = followed + MissingPairsLimits::in_tool * nodes[n].facet_size;
    const bool is_inside = !is_first && !is_named[n] && penetrations[n] >= allowed;
    // A node that enters slowly counts as in front until it is inside.
    is_in_front[n] = is_in_front[n] || (penetrations[n] > 0. && !is_inside);
    const Tensor<1, 3> &x = positions[couple.body][n];
    if (is_inside)
      own = std::max(own, {penetrations[n] / allowed, penetrations[n], x[0], x[1], x[2]});
  }
  couple.is_in_front = std::move(is_in_front);
  const auto of_ranks = all_gather(discretization_.communicator(), own);
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

void MissingPairs::save(StateWriter &writer) const { writer.write_text("missing pairs", reported_); }

void MissingPairs::load(const StateReader &reader) {
  reported_ = reader.read_text("missing pairs");
  const auto is_reported = [&](const std::string &name) {
    return ("\n" + reported_).find("\n" + name) != std::string::npos;
  };
  for (auto *couples : {&bodies_, &selves_})
    for (Couple &couple : *couples)
      couple.is_open = couple.is_open && !is_reported(name_of(couple, describe_body(couple)));
  for (Couple &couple : tools_)
    couple.is_open = couple.is_open && !is_reported(name_of(couple, describe_tool(couple)));
}

DiagnosticList MissingPairs::check(const SolutionState &state) {
  DiagnosticList diagnostics;
  const auto is_open = [](const Couple &couple) { return couple.is_open; };
  if (std::none_of(bodies_.begin(), bodies_.end(), is_open) &&
      std::none_of(selves_.begin(), selves_.end(), is_open) &&
      std::none_of(tools_.begin(), tools_.end(), is_open))
    return diagnostics;
  const Positions positions = positions_at(&state.displacements);
  const auto boxes = boxes_around(positions);
  const auto report = [&](Couple &couple, const std::string &other, const Deepest &deepest) {
    couple.is_open = false;
    reported_ += name_of(couple, other);
    const std::string &body = scene_.bodies()[couple.body].name;
    std::ostringstream text;
    text.precision(3);
    text << "Body '" << body << "' and " << other;
    if (couple.has_pair)
      text << " penetrate by " << deepest.penetration << " at faces that no contact pair of theirs names";
    else
      text << " share no contact pair, and penetrate by " << deepest.penetration;
    diagnostics.push_back(Diagnostic(diagnostic::missing_pair, text.str())
                              .body(body)
                              .at(deepest.position)
                              .time(state.time)
                              .value("depth [length]", deepest.penetration));
  };
  for (Couple &couple : bodies_)
    if (couple.is_open)
      if (const auto deepest = find_overlap(couple, positions, boxes, &state.displacements)) {
        report(couple, describe_body(couple), *deepest);
        diagnostics.back().body(scene_.bodies()[couple.other].name);
      }
  for (Couple &couple : selves_)
    if (couple.is_open)
      if (const auto position = find_self_overlap(couple, &state.displacements)) {
        couple.is_open = false;
        reported_ += name_of(couple, describe_body(couple));
        const std::string &body = scene_.bodies()[couple.body].name;
        diagnostics.push_back(
            Diagnostic(diagnostic::missing_pair,
                       "Body '" + body + "' penetrates itself, and has no contact pair with itself")
                .body(body)
                .at(*position)
                .time(state.time));
      }
  for (Couple &couple : tools_) {
    const Tool &tool = scene_.tools()[couple.other];
    if (!couple.is_open || state.time >= tool.removal_time())
      continue;
    const Deepest deepest = enter_tool(couple, positions, state.placements[couple.other]);
    if (deepest.penetration > 0.) {
      report(couple, describe_tool(couple), deepest);
      diagnostics.back().tool(tool.name());
    }
  }
  return diagnostics;
}

} // namespace billet
