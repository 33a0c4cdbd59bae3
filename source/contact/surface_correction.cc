// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/surface_correction.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/geometry/bilinear_facet.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace billet {

using dealii::Tensor;

std::vector<SmoothFacet> collect_smooth_facets(const Discretization &discretization, const std::size_t body,
                                               const std::vector<unsigned int> &boundary_ids,
                                               const Vector *displacements, std::size_t &n_own_facets) {
  const auto own = collect_boundary_facets(discretization, body, boundary_ids);
  n_own_facets = own.size();
  return make_smooth_facets(discretization, own, displacements);
}

Tensor<1, 3> arm_to(const Tensor<1, 3> &x, const parameters::ContactPair::Correction &correction) {
  const Tensor<1, 3> from_point = x - correction.point;
  return correction.kind == parameters::ContactPair::Correction::Kind::cylinder
             ? from_point - (from_point * correction.axis) * correction.axis
             : from_point;
}

FacetBulge bulge_of(const BoundaryFacet &facet, const parameters::ContactPair::Correction &correction) {
  using Correction = parameters::ContactPair::Correction;
  FacetBulge bulge{};
  const double area = facet.area_vector().norm();
  if (correction.kind == Correction::Kind::none || !(area > 0.))
    return bulge;
  const auto arm = [&](const Tensor<1, 3> &x) { return arm_to(x, correction); };
  const Tensor<1, 3> normal = facet.area_vector() / area;
  for (unsigned int i = 0; i < 4; ++i) {
    const Tensor<1, 3> a = facet.corners[facet::around[i]], b = facet.corners[facet::around[(i + 1) % 4]],
                       middle = arm(0.5 * (a + b));
    if (!(middle.norm() > 0.))
      continue;
    // Along the facet's normal, which on a cone is not radial.
    const double radial = 0.5 * (arm(a).norm() + arm(b).norm()) - middle.norm();
    bulge[i] = radial * (middle * normal) / middle.norm();
  }
  return bulge;
}

double tilt_of(const BoundaryFacet &facet, const parameters::ContactPair::Correction &correction) {
  const Tensor<1, 3> area = facet.area_vector();
  if (!(area.norm() > 0.))
    return 0.;
  Tensor<1, 3> arm;
  for (const auto &corner : facet.corners)
    arm += 0.25 * (corner - correction.point);
  if (correction.kind == parameters::ContactPair::Correction::Kind::cylinder) {
    const Tensor<1, 3> around = dealii::cross_product_3d(correction.axis, arm);
    return around.norm() > 0. ? std::abs(area * around) / (area.norm() * around.norm()) : 0.;
  }
  return arm.norm() > 0. ? dealii::cross_product_3d(arm, area).norm() / (arm.norm() * area.norm()) : 1.;
}

void check_correction(const Scene &scene, const BodyPair &pair, const Discretization &discretization) {
  using Correction = parameters::ContactPair::Correction;
  if (pair.correction.kind == Correction::Kind::none)
    return;
  constexpr double min_part = 0.5;
  const MPI_Comm communicator = discretization.communicator();
  const std::string point = pair.correction.kind == Correction::Kind::cylinder ? "axis" : "centre";
  for (unsigned int side = 0; side < 2; ++side) {
    std::size_t n_own_facets = 0;
    const auto facets = collect_smooth_facets(discretization, pair.bodies[side], pair.boundary_ids[side],
                                              nullptr, n_own_facets);
    std::array<double, 4> worst{};      // tilt, position
    double named = 0., of_normals = 0.; // sums of heights
    for (const auto &facet : facets) {  // of all ranks
      BoundaryFacet boundary{};
      std::copy(facet.corners.begin(), facet.corners.end(), boundary.corners.begin());
      for (const double height : bulge_of(boundary, pair.correction))
        named += std::abs(height);
      for (const double height : facet.bulge)
        of_normals += std::abs(height);
      const double tilt = tilt_of(boundary, pair.correction);
      const Tensor<1, 3> middle = facet::interpolate(facet::weights({0., 0.}), facet.corners);
      worst = std::max(worst, {tilt, middle[0], middle[1], middle[2]});
    }
    // The order of summation differs between ranks, but their decisions must agree.
    named = dealii::Utilities::MPI::max(named, communicator);
    of_normals = dealii::Utilities::MPI::max(of_normals, communicator);
    const std::string &body = scene.bodies()[pair.bodies[side]].name;
    std::ostringstream text;
    text.precision(3);
    text << pair.input->origin << ": the face of body '" << body
         << "' does not lie on the surface of 'Surface correction': ";
    if (worst[0] > max_tilt)
      text << "at (" << worst[1] << ", " << worst[2] << ", " << worst[3] << ") its normal misses the "
           << point << " by " << worst[0] << " of the distance to it; allowed is " << max_tilt;
    else if (named < min_part * of_normals)
      text << "the surface rises above the chords by " << 100. * named / of_normals
           << " % of the height that normals of neighbouring facets give; allowed are " << 100. * min_part
           << " %";
    else
      continue;
    text << ". Check the " << point << " and the boundary ids of both bodies";
    throw InputError(Diagnostic(diagnostic::bad_input, text.str()).body(body).pair(pair.name));
  }
}

double find_correction_error(const Discretization &discretization, const BodyPair &pair) {
  constexpr std::array<double, 3> along{-0.5, 0., 0.5};
  double sum = 0.;
  for (unsigned int side = 0; side < 2; ++side) {
    double worst = 0.;
    for (const auto &boundary :
         collect_boundary_facets(discretization, pair.bodies[side], pair.boundary_ids[side])) {
      FacetCorners corners;
      std::copy(boundary.corners.begin(), boundary.corners.end(), corners.begin());
      const FacetBulge bulge = bulge_of(boundary, pair.correction);
      const Tensor<1, 3> area = boundary.area_vector();
      if (!(area.norm() > 0.))
        continue;
      for (const double xi : along)
        for (const double eta : along) {
          const auto weights = facet::weights({xi, eta});
          const Tensor<1, 3> x = facet::interpolate(weights, corners) +
                                 facet::height<double>(bulge, {xi, eta}) * area / area.norm();
          double radius = 0.;
          for (unsigned int a = 0; a < 4; ++a)
            radius += weights[a] * arm_to(corners[a], pair.correction).norm();
          worst = std::max(worst, std::abs(arm_to(x, pair.correction).norm() - radius));
        }
    }
    sum += dealii::Utilities::MPI::max(worst, discretization.communicator());
  }
  return sum;
}

} // namespace billet
