// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/overlap.h"

#include "billet/discretization/boundary_facets.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/box_tree.h"

#include <deal.II/base/geometry_info.h>
#include <deal.II/fe/mapping_q1.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace billet {

using dealii::Tensor;

namespace {

using Coordinates = std::array<double, 3>;

/// Points that tell what is inside the body below a facet where no node of it need be in the other body: a
/// grid a thousandth of the element below the facet and within its border, and the middle of the element.
/// Points of bodies that only touch are in none of the other's elements.
void add_probes(const BoundaryFacet &facet, std::vector<Coordinates> &points) {
  constexpr double inset = 1e-3;
  FacetCorners corners;
  std::copy(facet.corners.begin(), facet.corners.end(), corners.begin());
  const Tensor<1, 3> area = facet.area_vector();
  if (!(area.norm() > 0.))
    return;
  const auto add = [&](const double xi, const double eta, const double depth) {
    const Tensor<1, 3> x = facet::interpolate(facet::weights({xi, eta}), corners) -
                           (depth * facet.thickness / area.norm()) * area;
    points.push_back({x[0], x[1], x[2]});
  };
  constexpr std::array<double, 3> along{-1. + 2. * inset, 0., 1. - 2. * inset};
  for (const double xi : along)
    for (const double eta : along)
      add(xi, eta, inset);
  add(0., 0., 0.5);
}

/// The nodes of these faces and points below them, on all ranks, each once or more.
std::vector<Coordinates> gather_points(const Discretization &discretization, const std::size_t body,
                                       const std::vector<unsigned int> &boundary_ids) {
  std::map<DofIndex, Coordinates> nodes;
  std::vector<Coordinates> own, all;
  for (const auto &facet : collect_boundary_facets(discretization, body, boundary_ids)) {
    for (unsigned int a = 0; a < 4; ++a)
      nodes[facet.dofs[a][0]] = {facet.corners[a][0], facet.corners[a][1], facet.corners[a][2]};
    add_probes(facet, own);
  }
  for (const auto &entry : nodes)
    own.push_back(entry.second);
  for (const auto &part : dealii::Utilities::MPI::all_gather(discretization.communicator(), own))
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

template <class Points> BoundingBox box_around(const Points &points) {
  BoundingBox box = BoundingBox::empty();
  for (const auto &point : points)
    box.add(point);
  return box;
}

/// Whether the point is in one of the elements of this rank.
class Elements {
public:
  explicit Elements(const std::vector<Element> &elements)
      : elements_(elements), tree_(make_boxes(elements)) {}

  bool contain(const dealii::Point<3> &x) const {
    bool is_inside = false;
    const double nowhere_else = 0.;
    constexpr double rounding = 1e-9; // a point on the face between two elements is in both
    tree_.visit_near(x, nowhere_else, [&](const unsigned int e) {
      try {
        is_inside = is_inside || dealii::GeometryInfo<3>::is_inside_unit_cell(
                                     mapping_.transform_real_to_unit_cell(elements_[e].cell, x), rounding);
      } catch (const dealii::Mapping<3>::ExcTransformationFailed &) { // far outside of a distorted element
      }
    });
    return is_inside;
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
    for (const auto &facet : facets)
      boxes.push_back(box_around(facet.corners));
    return boxes;
  }

  const std::vector<BoundaryFacet> &facets_;
  BoxTree tree_;
};

} // namespace

Overlap find_overlap(const Discretization &discretization, const std::size_t body,
                     const std::vector<unsigned int> &boundary_ids, const std::size_t other_body,
                     const std::vector<unsigned int> &other_boundary_ids) {
  const std::vector<Coordinates> points = gather_points(discretization, body, boundary_ids);
  const Elements elements(discretization.elements(other_body));
  const auto facets = collect_boundary_facets(discretization, other_body, other_boundary_ids);
  const Faces faces(facets);

  std::vector<int> is_inside;
  for (const auto &x : points)
    is_inside.push_back(elements.contain(dealii::Point<3>(x[0], x[1], x[2])) ? 1 : 0);
  std::vector<int> on_any_rank(is_inside.size());
  dealii::Utilities::MPI::max(is_inside, discretization.communicator(), on_any_rank);
  std::vector<double> distances;
  for (std::size_t i = 0; i < points.size(); ++i)
    distances.push_back(
        on_any_rank[i] == 1 ? faces.distance(Tensor<1, 3>({points[i][0], points[i][1], points[i][2]})) : 0.);
  std::vector<double> depths(distances.size());
  dealii::Utilities::MPI::min(distances, discretization.communicator(), depths);

  Overlap overlap;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (depths[i] > overlap.depth) {
      overlap.depth = depths[i];
      overlap.position = Tensor<1, 3>({points[i][0], points[i][1], points[i][2]});
    }
  return overlap;
}

} // namespace billet
