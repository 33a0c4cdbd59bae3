// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/pair_report.h"

#include "billet/algebra/gather.h"
#include "billet/contact/sheet_penalty.h"
#include "billet/diagnostic_kinds.h"
#include "billet/discretization/boundary_facets.h"
#include "billet/discretization/node_keys.h"
#include "billet/errors.h"
#include "billet/geometry/facet_projection.h"
#include "billet/geometry/facet_tree.h"
#include "billet/geometry/rigid_surface.h"
#include "billet/run/approach.h"
#include "billet/run/body_course.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <sstream>

namespace billet {

using dealii::Tensor;

namespace {

/// One surface of a pair, undeformed, from all ranks.
struct PairSurface {
  std::vector<Tensor<1, 3>> nodes; ///< by ascending keys
  /// Unit vectors at the nodes along the areas around.
  std::vector<Tensor<1, 3>> normals;
  std::vector<std::array<Tensor<1, 3>, 4>> facets; ///< by ascending keys
  /// Square root of the facets' mean area [length].
  double size = 0.;
};

PairSurface gather_surface(const Discretization &discretization, const NodeKeys &keys, const std::size_t body,
                           const std::vector<unsigned int> &boundary_ids) {
  std::vector<std::uint64_t> own_keys; // of each facet: its own, those of its nodes
  std::vector<double> own_corners;
  for (const BoundaryFacet &facet : collect_boundary_facets(discretization, body, boundary_ids)) {
    own_keys.push_back(facet.key);
    for (unsigned int v = 0; v < 4; ++v) {
      own_keys.push_back(keys(facet.dofs[v][0]));
      for (unsigned int i = 0; i < 3; ++i)
        own_corners.push_back(facet.corners[v][i]);
    }
  }
  const auto all_keys = all_gather(discretization.communicator(), own_keys);
  const auto all_corners = all_gather(discretization.communicator(), own_corners);
  std::map<std::uint64_t, Tensor<1, 3>> nodes;
  std::map<std::uint64_t, std::array<Tensor<1, 3>, 4>> facets;
  std::map<std::uint64_t, std::array<std::uint64_t, 4>> nodes_of; // of facets
  for (std::size_t rank = 0; rank < all_keys.size(); ++rank)
    for (std::size_t f = 0; 5 * f < all_keys[rank].size(); ++f) {
      std::array<Tensor<1, 3>, 4> &facet = facets[all_keys[rank][5 * f]];
      for (unsigned int v = 0; v < 4; ++v) {
        for (unsigned int i = 0; i < 3; ++i)
          facet[v][i] = all_corners[rank][12 * f + 3 * v + i];
        const std::uint64_t node = all_keys[rank][5 * f + 1 + v];
        nodes[node] = facet[v];
        nodes_of[all_keys[rank][5 * f]][v] = node;
      }
    }
  PairSurface surface;
  std::map<std::uint64_t, Tensor<1, 3>> sums;
  double area = 0.;
  for (const auto &[key, x] : facets) {
    surface.facets.push_back(x);
    const Tensor<1, 3> vector = 0.5 * dealii::cross_product_3d(x[3] - x[0], x[2] - x[1]);
    area += vector.norm();
    for (const std::uint64_t node : nodes_of[key])
      sums[node] += vector;
  }
  for (const auto &[key, x] : nodes) {
    surface.nodes.push_back(x);
    const Tensor<1, 3> &sum = sums[key];
    surface.normals.push_back(sum.norm() > 0. ? sum / sum.norm() : sum);
  }
  if (!facets.empty())
    surface.size = std::sqrt(area / static_cast<double>(facets.size()));
  return surface;
}

/// Facets as four triangles each, around their middle. Points within a facet's size behind them
/// have a gap, too.
class FacetedSurface {
public:
  explicit FacetedSurface(const PairSurface &surface) : tree_(divide(surface)), reach_(surface.size) {
    for (const auto &facet : tree_.mesh().facets) {
      const auto &points = tree_.mesh().points;
      const Tensor<1, 3> area =
          dealii::cross_product_3d(points[facet[1]] - points[facet[0]], points[facet[2]] - points[facet[0]]);
      normals_.push_back(area.norm() > 0. ? area / area.norm() : area);
    }
  }

  PointGap measure(const Tensor<1, 3> &x) const {
    const FacetTree::Foot foot = tree_.nearest(x);
    PointGap point;
    point.distance = std::sqrt(foot.square);
    if (point.distance <= touching_gap * reach_) { // on it: there is no direction
      point.faces = true;
      point.outward = normals_[foot.facet];
      return point;
    }
    // Triangles that meet at the nearest point. Over an edge between them, the direction to x is
    // between their normals; beyond a free edge it is not.
    std::vector<unsigned int> around;
    constexpr double rounding = 1e-9;
    const double limit = foot.square * (1. + rounding);
    const Tensor<1, 3> at = position(foot);
    tree_.visit_near(x, limit, [&](const FacetTree::Foot &other) {
      if (other.square <= limit && (position(other) - at).norm() <= rounding * (point.distance + reach_))
        around.push_back(other.facet);
    });
    Tensor<1, 3> mean;
    for (const unsigned int facet : around)
      mean += normals_[facet];
    const double side = (x - at) * mean < 0. ? -1. : 1.;
    const Tensor<1, 3> direction = side / point.distance * (x - at);
    point.faces = side > 0. || point.distance <= reach_;
    for (const unsigned int facet : around)
      point.faces = point.faces && is_between(direction, facet, around);
    point.gap = side * point.distance;
    point.outward = direction;
    return point;
  }

private:
  static TriangleMesh divide(const PairSurface &surface) {
    TriangleMesh mesh;
    for (const auto &x : surface.facets) {
      const auto first = static_cast<unsigned int>(mesh.points.size());
      mesh.points.insert(mesh.points.end(), x.begin(), x.end());
      mesh.points.push_back(0.25 * (x[0] + x[1] + x[2] + x[3]));
      for (unsigned int side = 0; side < 4; ++side)
        mesh.facets.push_back(
            {first + facet::around[side], first + facet::around[(side + 1) % 4], first + 4});
    }
    return mesh;
  }

  Tensor<1, 3> position(const FacetTree::Foot &foot) const {
    Tensor<1, 3> x;
    for (unsigned int i = 0; i < 3; ++i)
      x += foot.weights[i] * tree_.mesh().points[tree_.mesh().facets[foot.facet][i]];
    return x;
  }

  /// Whether the direction makes no larger angle with the facet's normal than the normals around
  /// do. In the angle, 0.02 are tolerated.
  bool is_between(const Tensor<1, 3> &direction, const unsigned int facet,
                  const std::vector<unsigned int> &around) const {
    constexpr double tolerance = 0.02;
    const auto angle = [&](const Tensor<1, 3> &other) {
      return std::acos(std::clamp(normals_[facet] * other, -1., 1.));
    };
    double largest = 0.;
    for (const unsigned int other : around)
      largest = std::max(largest, angle(normals_[other]));
    return angle(direction) <= largest + tolerance;
  }

  FacetTree tree_;
  std::vector<Tensor<1, 3>> normals_;
  double reach_; ///< [length]
};

/// Makes the reports of pairs.
class PairReporter {
public:
  PairReporter(const Scene &scene, const Discretization &discretization,
               const std::vector<BodyReport> &bodies)
      : scene_(scene), discretization_(discretization), keys_(discretization),
        courses_(find_courses(scene, bodies)) {}

  PairReport report(const ContactPair &pair) const {
    const Tool &tool = scene_.tools()[pair.tool];
    const BodyCourse &course = courses_[pair.body];
    const PairSurface surface = gather_surface(discretization_, keys_, pair.body, pair.boundary_ids);
    GapSide side;
    side.points = surface.nodes;
    side.normals = surface.normals;
    side.placement = [&tool, &course](const double t) {
      Placement placement = tool.placement(t);
      placement.translation -= course.displacement(t);
      return placement;
    };
    side.measure = [&tool](const Tensor<1, 3> &x, const unsigned int patch) {
      const RigidSurface::Projection projection = tool.surface().project(x, patch);
      return PointGap{projection.exists, projection.gap, std::abs(projection.gap), projection.normal,
                      projection.patch};
    };
    PairReport report = measure(pair.name, {side}, std::min(tool.removal_time(), end()), surface.size);
    report.is_sheet = may_have_sheet_penalty(
        pair, discretization_, collect_boundary_facets(discretization_, pair.body, pair.boundary_ids));
    report.depends_on_forces =
        tool.is_driven() || tool.control() == Tool::Control::stop || depends_on_forces(pair.body);
    return report;
  }

  PairReport report(const BodyPair &pair) const {
    if (pair.is_self_contact) {
      PairReport report;
      report.name = pair.name;
      report.is_self_contact = report.depends_on_forces = true;
      return report;
    }
    std::vector<PairSurface> surfaces;
    for (unsigned int k = 0; k < 2; ++k)
      surfaces.push_back(gather_surface(discretization_, keys_, pair.bodies[k], pair.boundary_ids[k]));
    std::vector<GapSide> sides;
    double size = std::numeric_limits<double>::infinity();
    for (unsigned int k = 0; k < 2; ++k) {
      if (surfaces[1 - k].facets.empty())
        continue;
      const BodyCourse &own = courses_[pair.bodies[k]], &other = courses_[pair.bodies[1 - k]];
      const auto faceted = std::make_shared<const FacetedSurface>(surfaces[1 - k]);
      GapSide side;
      side.points = surfaces[k].nodes;
      side.normals = surfaces[k].normals;
      side.placement = [&own, &other](const double t) {
        Placement placement;
        placement.translation = other.displacement(t) - own.displacement(t);
        return placement;
      };
      side.measure = [faceted](const Tensor<1, 3> &x, unsigned int /*patch*/) { return faceted->measure(x); };
      sides.push_back(std::move(side));
      size = std::min(size, surfaces[1 - k].size);
    }
    PairReport report = measure(pair.name, sides, end(), size);
    report.depends_on_forces = depends_on_forces(pair.bodies[0]) || depends_on_forces(pair.bodies[1]);
    return report;
  }

private:
  double end() const { return scene_.parameters().time_stepping.end_time; }

  bool depends_on_forces(const std::size_t body) const {
    return !scene_.bodies()[body].loads.empty() || !courses_[body].is_rigid();
  }

  PairReport measure(const std::string &name, const std::vector<GapSide> &sides, const double end,
                     const double size) const {
    PairReport report;
    report.name = name;
    try {
      report.gap = measure_gaps(sides, 0., discretization_.communicator());
      report.meeting = find_meeting(sides, {end, scene_.stops(), size}, discretization_.communicator());
    } catch (const SolutionFailure &) {
      // a motion is undefined at time 0, on all ranks: the run will report it.
      report.depends_on_forces = true;
    }
    return report;
  }

  const Scene &scene_;
  const Discretization &discretization_;
  const NodeKeys keys_;
  const std::vector<BodyCourse> courses_;
};

/// Whether the pair, counted as report_pairs() does, has this body.
bool has_body(const Scene &scene, const std::size_t pair, const std::size_t body) {
  const std::size_t n_of_tools = scene.pairs().size();
  if (pair < n_of_tools)
    return scene.pairs()[pair].body == body;
  const auto &bodies = scene.body_pairs()[pair - n_of_tools].bodies;
  return std::find(bodies.begin(), bodies.end(), body) != bodies.end();
}

} // namespace

std::vector<PairReport> report_pairs(const Scene &scene, const Discretization &discretization,
                                     const std::vector<BodyReport> &bodies) {
  const PairReporter reporter(scene, discretization, bodies);
  std::vector<PairReport> reports;
  for (const ContactPair &pair : scene.pairs())
    reports.push_back(reporter.report(pair));
  for (const BodyPair &pair : scene.body_pairs())
    reports.push_back(reporter.report(pair));
  return reports;
}

DiagnosticList check_flights(const Scene &scene, const std::vector<BodyReport> &bodies,
                             const std::vector<PairReport> &pairs) {
  DiagnosticList messages;
  const std::vector<BodyCourse> courses = find_courses(scene, bodies);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::vector<std::size_t> own; // pairs of the body with tools and with other bodies
    for (std::size_t p = 0; p < pairs.size(); ++p)
      if (!pairs[p].is_self_contact && has_body(scene, p, b))
        own.push_back(p);
    const Tensor<1, 3> &velocity = courses[b].initial_velocity();
    if (own.empty() || !(velocity.norm() > 0.) || std::any_of(own.begin(), own.end(), [&](const auto p) {
          return pairs[p].meeting || pairs[p].depends_on_forces;
        }))
      continue;
    std::ostringstream text;
    text << "The initial velocity (" << velocity[0] << ", " << velocity[1] << ", " << velocity[2]
         << ") brings the body to no other body and to no tool until the end";
    messages.push_back(Diagnostic(diagnostic::pair_never_touched, text.str()).body(scene.bodies()[b].name));
  }
  return messages;
}

} // namespace billet
