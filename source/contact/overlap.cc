// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/overlap.h"

#include "billet/algebra/gather.h"
#include "billet/contact/facet_overlaps.h"
#include "billet/contact/surface_correction.h"
#include "billet/discretization/boundary_facets.h"
#include "billet/errors.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/box_tree.h"
#include "billet/geometry/segment_pair.h"

#include <deal.II/base/geometry_info.h>
#include <deal.II/fe/mapping_q1.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <sstream>

namespace billet {

using dealii::Tensor;

namespace {

struct OverlapLimits {
  /// Overlap over the chords of both faces, up to which faces that fit each other start. Heights of
  /// chords neglect higher powers of the facet size over the radius.
  static constexpr double beyond_chords = 1.01;
  /// Depth of the middle of a facet over that of its edges: on a sphere, chords of both directions
  /// add up, (C8).
  static constexpr double chords_of_sphere = 2., chords_of_cylinder = 1.;
};

template <class Points> BoundingBox box_around(const Points &points) {
  BoundingBox box = BoundingBox::empty();
  for (const auto &point : points)
    box.add(point);
  return box;
}

/// Search in the elements of this rank.
class Elements {
public:
  explicit Elements(const std::vector<Element> &elements)
      : elements_(elements), tree_(make_boxes(elements)) {}

  /// Returns the number of elements that contain the point, up to a tolerance in reference
  /// coordinates.
  unsigned int count_around(const dealii::Point<3> &x, const double tolerance) const {
    unsigned int n = 0;
    const double nowhere_else = 0.;
    tree_.visit_near(x, nowhere_else, [&](const unsigned int e) {
      try {
        if (dealii::GeometryInfo<3>::is_inside_unit_cell(
                mapping_.transform_real_to_unit_cell(elements_[e].cell, x), tolerance))
          ++n;
      } catch (const dealii::Mapping<3>::ExcTransformationFailed &) {
        // The point is far outside a distorted element.
      }
    });
    return n;
  }

private:
  static std::vector<BoundingBox> make_boxes(const std::vector<Element> &elements) {
    std::vector<BoundingBox> boxes;
    for (const auto &element : elements) {
      std::vector<Tensor<1, 3>> corners;
      for (const unsigned int v : element.cell->vertex_indices())
        corners.emplace_back(element.cell->vertex(v));
      boxes.push_back(box_around(corners));
    }
    return boxes;
  }

  const std::vector<Element> &elements_;
  BoxTree tree_;
  dealii::MappingQ1<3> mapping_;
};

/// Distance to the faces of this rank; infinite where there are none.
class Faces {
public:
  explicit Faces(const std::vector<BoundaryFacet> &facets) : facets_(facets), tree_(make_boxes(facets)) {}

  double distance(const Tensor<1, 3> &x) const {
    double nearest = std::numeric_limits<double>::infinity();
    tree_.visit_near(x, nearest, [&](const unsigned int f) {
      FacetCorners corners;
      std::copy(facets_[f].corners.begin(), facets_[f].corners.end(), corners.begin());
      const FacetProjection projection = BilinearFacet(corners).project(x, {0.});
      const Tensor<1, 3> way = x - facet::interpolate(projection.weights, corners);
      nearest = std::min(nearest, way.norm_square());
    });
    return std::sqrt(nearest);
  }

private:
  static std::vector<BoundingBox> make_boxes(const std::vector<BoundaryFacet> &facets) {
    std::vector<BoundingBox> boxes;
    boxes.reserve(facets.size());
    for (const auto &facet : facets)
      boxes.push_back(box_around(facet.corners));
    return boxes;
  }

  const std::vector<BoundaryFacet> &facets_;
  BoxTree tree_;
};

/// Returns where a segment meets a triangle, as a parameter in [0, 1] from its first end. Returns
/// nothing if it does not, or if it lies in the triangle's plane. The edges belong to the triangle.
std::optional<double> meet(const Segment &segment, const Tensor<1, 3> &a, const Tensor<1, 3> &b,
                           const Tensor<1, 3> &c) {
  constexpr double rounding = 1e-9;
  const Tensor<1, 3> along = segment[1] - segment[0], e_1 = b - a, e_2 = c - a, from_a = segment[0] - a;
  const Tensor<1, 3> across = dealii::cross_product_3d(along, e_2);
  const double determinant = e_1 * across;
  if (!(std::abs(determinant) > rounding * along.norm() * e_1.norm() * e_2.norm()))
    return {};
  const Tensor<1, 3> other = dealii::cross_product_3d(from_a, e_1);
  const double u = from_a * across / determinant, v = along * other / determinant,
               t = e_2 * other / determinant;
  const bool is_in =
      u >= -rounding && v >= -rounding && u + v <= 1. + rounding && t >= -rounding && t <= 1. + rounding;
  return is_in ? std::optional<double>(t) : std::nullopt;
}

/// Facets of all ranks, each with its normal [length].
struct ProbedFacet {
  FacetCorners corners;
  double thickness; ///< of the element below
  Tensor<1, 3> normal;
};

std::vector<ProbedFacet> gather_facets(const std::vector<BoundaryFacet> &facets, MPI_Comm communicator) {
  std::vector<std::array<double, 16>> own;
  for (const auto &facet : facets) {
    const Tensor<1, 3> area = facet.area_vector();
    if (!(area.norm() > 0.))
      continue;
    std::array<double, 16> numbers{};
    for (unsigned int i = 0; i < 3; ++i) {
      for (unsigned int a = 0; a < 4; ++a)
        numbers[3 * a + i] = facet.corners[a][i];
      numbers[12 + i] = area[i] / area.norm();
    }
    numbers[15] = facet.thickness;
    own.push_back(numbers);
  }
  std::vector<ProbedFacet> all;
  for (const auto &part : all_gather(communicator, own))
    for (const auto &numbers : part) {
      ProbedFacet facet{{}, numbers[15], Tensor<1, 3>({numbers[12], numbers[13], numbers[14]})};
      for (std::size_t a = 0; a < 4; ++a)
        facet.corners[a] = Tensor<1, 3>({numbers[3 * a], numbers[3 * a + 1], numbers[3 * a + 2]});
      all.push_back(facet);
    }
  return all;
}

/// Returns the side of a facet between two consecutive corners around it.
Segment side_of(const FacetCorners &corners, const unsigned int side) {
  return {corners[facet::around[side]], corners[facet::around[(side + 1) % 4]]};
}

/// Test points inside the bodies below these facets.
class Probes {
public:
  explicit Probes(const std::vector<ProbedFacet> &facets) : facets_(facets) {}

  /// Adds a grid just below each facet and within its edges, and the middle of the element.
  void add_grids() {
    constexpr std::array<double, 3> along{-1. + 2. * inset, 0., 1. - 2. * inset};
    for (const auto &facet : facets_) {
      for (const double xi : along)
        for (const double eta : along)
          add(facet, {xi, eta}, inset);
      add(facet, {0., 0.}, 0.5);
    }
  }

  /// Adds points where sides of the facets pierce the other body's faces. Between two such
  /// intersections, or between one and its end, a side is either entirely inside or entirely
  /// outside the other body. `facets` are those of this rank. Bodies that overlap have such a side
  /// unless one contains the other.
  void add_pierced_sides(const std::vector<BoundaryFacet> &facets, MPI_Comm communicator) {
    std::vector<BoundingBox> boxes;
    boxes.reserve(facets.size());
    for (const auto &facet : facets)
      boxes.push_back(box_around(facet.corners));
    const BoxTree tree(boxes);
    std::vector<std::array<double, 3>> own; // facet, side, parameter
    for (std::size_t f = 0; f < facets_.size(); ++f)
      for (unsigned int side = 0; side < 4; ++side) {
        const Segment segment = side_of(facets_[f].corners, side);
        const double square = 0.25 * (segment[1] - segment[0]).norm_square() * (1. + 1e-9);
        tree.visit_near(0.5 * (segment[0] + segment[1]), square, [&](const unsigned int other) {
          const auto &c = facets[other].corners;
          // Both diagonals, for a facet that is not plane.
          for (const auto &corners : {std::array<unsigned int, 3>{0, 1, 3}, {0, 3, 2}, {0, 1, 2}, {1, 3, 2}})
            if (const auto t = meet(segment, c[corners[0]], c[corners[1]], c[corners[2]]))
              own.push_back({static_cast<double>(f), static_cast<double>(side), *t});
        });
      }
    std::map<std::array<double, 2>, std::vector<double>> sides;
    for (const auto &part : all_gather(communicator, own))
      for (const auto &met : part)
        sides[{met[0], met[1]}].push_back(met[2]);
    for (auto &entry : sides) {
      std::vector<double> &places = entry.second;
      places.push_back(0.);
      places.push_back(1.);
      std::sort(places.begin(), places.end());
      for (std::size_t i = 0; i + 1 < places.size(); ++i)
        if (places[i + 1] - places[i] > inset)
          add_below_side(facets_[static_cast<std::size_t>(entry.first[0])],
                         static_cast<unsigned int>(entry.first[1]), 0.5 * (places[i] + places[i + 1]));
    }
  }

  /// Adds the corners themselves.
  void add_corners() {
    for (const auto &facet : facets_)
      for (const auto &corner : facet.corners)
        points_.push_back(corner);
  }

  const std::vector<Tensor<1, 3>> &points() const { return points_; }

private:
  /// Depth relative to the element's thickness, so that no points of a touching body are in
  /// elements of the other body.
  static constexpr double inset = 1e-3;

  void add(const ProbedFacet &facet, const std::array<double, 2> &parameters, const double penetration) {
    points_.push_back(facet::interpolate(facet::weights(parameters), facet.corners) -
                      penetration * facet.thickness * facet.normal);
  }

  void add_below_side(const ProbedFacet &facet, const unsigned int side, const double t) {
    for (const double penetration : {inset, 0.1, 0.25, 0.5}) {
      const double inner = 1. - 2. * penetration, along = 2. * t - 1.;
      // In the order of facet::around: η = −1, ξ = 1, η = 1, ξ = −1.
      const std::array<std::array<double, 2>, 4> parameters{
          {{along, -inner}, {inner, along}, {-along, inner}, {-inner, -along}}};
      add(facet, parameters[side], penetration);
    }
  }

  const std::vector<ProbedFacet> &facets_;
  std::vector<Tensor<1, 3>> points_;
};

/// Finds the deepest of these points, which are the same on all ranks, among those in at least
/// `n_elements` elements of the body. The depth is the distance to its faces.
Overlap find_deepest(const Discretization &discretization, const std::vector<Tensor<1, 3>> &points,
                     const std::size_t body, const std::vector<BoundaryFacet> &faces,
                     const unsigned int n_elements, const double tolerance) {
  const MPI_Comm communicator = discretization.communicator();
  const Elements elements(discretization.elements(body));
  const Faces surface(faces);
  std::vector<unsigned int> own_counts;
  own_counts.reserve(points.size());
  for (const auto &x : points)
    own_counts.push_back(elements.count_around(dealii::Point<3>(x), tolerance));
  std::vector<unsigned int> counts(own_counts.size());
  dealii::Utilities::MPI::sum(own_counts, communicator, counts);
  std::vector<double> distances;
  for (std::size_t i = 0; i < points.size(); ++i)
    distances.push_back(counts[i] >= n_elements ? surface.distance(points[i]) : 0.);
  std::vector<double> penetrations(distances.size());
  dealii::Utilities::MPI::min(distances, communicator, penetrations);

  Overlap overlap;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (penetrations[i] > overlap.penetration) {
      overlap.penetration = penetrations[i];
      overlap.position = points[i];
    }
  return overlap;
}

} // namespace

std::vector<BoundaryFacet> collect_free_boundary(const Discretization &discretization, const std::size_t body,
                                                 const std::vector<Constraint> &constraints) {
  std::vector<BoundaryFacet> facets = collect_boundary_facets(discretization, body);
  const double tolerance = Constraint::rounding * discretization.radius();
  facets.erase(
      std::remove_if(
          facets.begin(), facets.end(),
          [&](const BoundaryFacet &facet) {
            return std::any_of(constraints.begin(), constraints.end(), [&](const Constraint &constraint) {
              return constraint.on_plane &&
                     std::all_of(facet.corners.begin(), facet.corners.end(), [&](const dealii::Point<3> &x) {
                       return std::abs(x * constraint.normal - constraint.offset) <= tolerance;
                     });
            });
          }),
      facets.end());
  return facets;
}

Overlap find_overlap(const Discretization &discretization, const std::size_t body,
                     const std::vector<unsigned int> &boundary_ids, const std::size_t other_body,
                     const std::vector<unsigned int> &other_boundary_ids,
                     const std::vector<Constraint> &other_constraints) {
  const MPI_Comm communicator = discretization.communicator();
  const auto facets =
      gather_facets(collect_boundary_facets(discretization, body, boundary_ids), communicator);
  Probes probes(facets);
  probes.add_corners();
  probes.add_grids();
  probes.add_pierced_sides(collect_boundary_facets(discretization, other_body, other_boundary_ids),
                           communicator);
  constexpr double rounding = 1e-9; // a point on the face between two elements is in both
  return find_deepest(discretization, probes.points(), other_body,
                      collect_free_boundary(discretization, other_body, other_constraints), 1, rounding);
}

Overlap find_self_overlap(const Discretization &discretization, const std::size_t body,
                          const std::vector<unsigned int> &boundary_ids) {
  const MPI_Comm communicator = discretization.communicator();
  const auto faces = collect_boundary_facets(discretization, body, boundary_ids);
  const auto facets = gather_facets(faces, communicator);
  Probes probes(facets);
  probes.add_grids();
  probes.add_pierced_sides(faces, communicator);
  constexpr double rounding = 1e-6; // a point on the face between two elements is in neither
  return find_deepest(discretization, probes.points(), body, faces, 2, -rounding);
}

double contact_reach(const BoundaryFacet &facet) {
  constexpr double part_of_facet = 0.1, part_of_wall = 0.4;
  return std::min(part_of_facet * std::sqrt(facet.area_vector().norm()), part_of_wall * facet.thickness);
}

void check_overlap(const Scene &scene, const std::size_t pair, const Discretization &discretization) {
  const BodyPair &bodies = scene.body_pairs()[pair];
  check_correction(scene, bodies, discretization);
  const MPI_Comm communicator = discretization.communicator();
  std::array<double, 2> sums{}; // area and number of facets
  double min_reach = std::numeric_limits<double>::infinity();
  std::array<double, 2> chords{}; // distances of facets of both sides from the true surface
  for (unsigned int side = 0; side < (bodies.is_self_contact ? 1 : 2); ++side)
    for (const auto &facet :
         collect_boundary_facets(discretization, bodies.bodies[side], bodies.boundary_ids[side])) {
      sums[0] += facet.area_vector().norm();
      sums[1] += 1.;
      min_reach = std::min(min_reach, contact_reach(facet));
      for (const double height : bulge_of(facet, bodies.correction))
        chords[side] = std::max(chords[side], std::abs(height));
    }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, communicator);
  min_reach = dealii::Utilities::MPI::min(min_reach, communicator);
  MPI_Allreduce(MPI_IN_PLACE, chords.data(), 2, MPI_DOUBLE, MPI_MAX, communicator);
  const double size = std::sqrt(sums[0] / sums[1]);
  Overlap deepest;
  const bool is_one_body = bodies.bodies[0] == bodies.bodies[1];
  if (is_one_body) {
    std::vector<unsigned int> ids = bodies.boundary_ids[0];
    if (!bodies.is_self_contact)
      ids.insert(ids.end(), bodies.boundary_ids[1].begin(), bodies.boundary_ids[1].end());
    deepest = find_self_overlap(discretization, bodies.bodies[0], ids);
  }
  for (unsigned int side = 0; side < 2 && !is_one_body; ++side) {
    const Overlap overlap =
        find_overlap(discretization, bodies.bodies[side], bodies.boundary_ids[side], bodies.bodies[1 - side],
                     bodies.boundary_ids[1 - side], scene.bodies()[bodies.bodies[1 - side]].constraints);
    if (overlap.penetration > deepest.penetration)
      deepest = overlap;
  }
  // Allowed penetrations are limited to those that contact finds: half of those that a step loses.
  const bool is_by_overlaps = bodies.facets == FacetMethod::overlap;
  const double found = min_reach * (is_by_overlaps ? 0.5 * FacetOverlaps::penetration : 1.);
  const bool is_sphere = bodies.correction.kind == parameters::ContactPair::Correction::Kind::sphere;
  const double of_edges = OverlapLimits::beyond_chords *
                          (is_sphere ? OverlapLimits::chords_of_sphere : OverlapLimits::chords_of_cylinder);
  const double allowed = bodies.overlap.is_allowed ? found
                                                   : bodies.input->initial.allowed_penetration.value * size +
                                                         of_edges * (chords[0] + chords[1]);
  if (deepest.penetration <= allowed)
    return;
  std::ostringstream message;
  message << bodies.input->origin << ": the "
          << (is_one_body ? "body starts with a penetration of " : "bodies start with a penetration of ")
          << deepest.penetration << " (" << deepest.penetration / size << " facet sizes) in "
          << (is_one_body ? "itself" : "each other") << ", deepest at (" << deepest.position[0] << ", "
          << deepest.position[1] << ", " << deepest.position[2] << "); ";
  if (bodies.overlap.is_allowed)
    message << "contact detects a penetration of up to " << found << ", "
            << (is_by_overlaps ? "half of the smallest facet or two walls" : "a tenth of the smallest facet")
            << ". Reduce the overlap, and move the bodies by 'Supports'"
            << (is_by_overlaps ? "" : ", or use 'Facets = overlap'");
  else
    message << "allowed are " << bodies.input->initial.allowed_penetration.value
            << " facet sizes ('Allowed initial penetration')";
  throw InputError(message.str());
}

} // namespace billet
