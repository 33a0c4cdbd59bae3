// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_division.h"

#include "billet/geometry/frame.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

// Part of a facet's length by which a tool may enter undetected.
constexpr double unseen = 0.125;
constexpr std::size_t max_points = 4000; // of a triangulation; a finer one is thinned out
const double diagonal = std::sqrt(0.5);

/// Directions at angles of multiples of 45 degrees across a normal.
std::array<Tensor<1, 3>, 8> directions(const Tensor<1, 3> &normal) {
  const Frame frame = Frame::from_normal(normal);
  std::array<Tensor<1, 3>, 8> result;
  for (unsigned int i = 0; i < 8; ++i)
    result[i] = std::cos(0.25 * M_PI * i) * frame.q + std::sin(0.25 * M_PI * i) * frame.r;
  return result;
}

} // namespace

FacetDivision::FacetDivision(const RigidSurface &surface, const OutputRegion &region) : surface_(surface) {
  const SurfaceMesh surface_mesh = surface.surface_mesh(region);
  constexpr double relative_distance = 1e-3; // of the samples beside a point, to find edges
  const double distance = relative_distance * region.radius;
  const std::size_t stride = 1 + surface_mesh.points.size() / max_points;
  for (std::size_t i = 0; i < surface_mesh.points.size(); i += stride)
    add_samples(surface_mesh.points[i], distance);
  // Middles of facets are samples, too: a coarse triangulation has points only on its edges.
  for (std::size_t i = 0; i < surface_mesh.facets.size(); i += stride) {
    Tensor<1, 3> middle;
    for (const unsigned int point : surface_mesh.facets[i])
      middle += surface_mesh.points[point] / double(surface_mesh.facets[i].size());
    const auto above = surface.project(middle);
    if (above.exists)
      samples_.push_back({middle - above.gap * above.normal, above.normal});
  }
}

void FacetDivision::add_samples(const Tensor<1, 3> &position, const double distance) {
  // On a smooth surface the foot point moves by about the distance.
  constexpr double fixed_foot = 0.1;
  const auto at = surface_.project(position);
  const Tensor<1, 3> &normal = at.normal;
  if (at.exists)
    samples_.push_back({position, normal});
  for (const auto &aside : directions(normal)) {
    const Tensor<1, 3> x = position + distance * (normal + aside);
    const auto beside = surface_.project(x, at.patch);
    const Tensor<1, 3> foot = x - beside.gap * beside.normal;
    // On smooth surfaces the foot point moves along; at a convex edge the normal rotates about a
    // fixed foot point.
    if (beside.exists && beside.gap > 0. && (foot - position).norm() < fixed_foot * distance)
      samples_.push_back({position, beside.normal});
  }
}

bool FacetDivision::is_seen(const double spacing, const double length) const {
  constexpr double round_off = 1e-9;
  constexpr double min_unseen = 0.1 * unseen; // the smallest depth tried, for thin tools
  // Cosine of the angle above which contact on a flank lets the tool pass.
  constexpr double opposing = 0.5;
  const auto is_met_at = [&](const Tensor<1, 3> &x, const Tensor<1, 3> &normal) {
    const auto projection = surface_.project(x);
    return projection.exists && projection.gap <= round_off * length &&
           projection.normal * normal >= opposing - round_off;
  };
  return std::all_of(samples_.begin(), samples_.end(), [&](const Sample &sample) {
    const auto around = directions(sample.normal);
    for (const unsigned int turned : {0U, 1U}) {
      bool is_met = false;
      for (unsigned int corner = turned; corner < 8 && !is_met; corner += 2)
        // For thin tools, only some of the depths are inside.
        for (double penetration = unseen; penetration > min_unseen && !is_met; penetration *= 0.5)
          is_met = is_met_at(sample.position + diagonal * spacing * around[corner] -
                                 penetration * length * sample.normal,
                             sample.normal);
      if (!is_met)
        return false;
    }
    return true;
  });
}

FacetDivision::Parts FacetDivision::find_parts(const double length) const {
  if (is_seen(length, length))
    return {1, true};
  for (unsigned int n = 4; n <= max_parts; n *= 2)
    if (is_seen(length / n, length))
      return {n, true};
  return {max_parts, false};
}

} // namespace billet
