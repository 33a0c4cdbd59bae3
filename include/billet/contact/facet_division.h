// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_DIVISION_H
#define BILLET_CONTACT_FACET_DIVISION_H

#include "billet/geometry/rigid_surface.h"

#include <vector>

namespace billet {

/// Finds the number of parts into which facets must be divided so that no tool enters undetected
/// between the parts' corners, (T10).
///
/// Each sample of the tool's surface is a point x with a normal n. It meets a square of side s in
/// its tangent plane, with x in the middle. The square is tested along the tool's axes of the
/// sample and turned by 45 degrees. The square moves by L/8 along −n, L the facet's length, or by a
/// half, a quarter or an eighth of that. At least one of its corners must then be inside the tool,
/// where the tool's normal is within 60 degrees of n.
///
/// Thus the side is about s² ≤ R L/2 for a sphere of radius R, and s² ≤ R L for a cylinder. It is
/// s ≤ L/4 for an edge of 90 degrees, and about s ≤ t for a fin of width t. For a plane, or a
/// sphere of R ≥ 2.1 L, the corners of the facet suffice.
///
/// At convex edges, normals between those of both sides are samples, too.
class FacetDivision {
public:
  /// Maximum number of parts along a side.
  static constexpr unsigned int max_parts = 16;

  /// Samples the surface's triangulation of a region.
  FacetDivision(const RigidSurface &surface, const OutputRegion &region);

  /// Returns the number of parts along a side of this length: 1, 4, 8 or 16. `is_enough` is false
  /// where even the maximum number is too small.
  struct Parts {
    unsigned int n;
    bool is_enough;
  };
  Parts find_parts(double length) const;

private:
  struct Sample {
    dealii::Tensor<1, 3> position, normal;
  };
  bool is_seen(double spacing, double length) const;
  void add_samples(const dealii::Tensor<1, 3> &position, double distance);

  const RigidSurface &surface_;
  std::vector<Sample> samples_;
};

} // namespace billet

#endif
