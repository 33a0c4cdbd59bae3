// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_DIVISION_H
#define BILLET_CONTACT_FACET_DIVISION_H

#include "billet/geometry/rigid_surface.h"

#include <vector>

namespace billet {

/// Finds the number of parts into which facets must be divided so that a tool cannot enter
/// undetected between the corners of the parts of (T10).
///
/// Each sample of the tool's surface, a point x with a normal n, meets a square of side s in its
/// tangent plane, with x in the middle. The square is tested along the tool's axes of the sample
/// and turned by 45 degrees. The square moves by L/8 along −n, L the facet's length, or by a half,
/// a quarter or an eighth of that. At least one of its corners must then be inside the tool, where
/// the tool's normal is within 60 degrees of n. Thus a sphere of radius R needs about s² ≤ R L/2, a
/// cylinder s² ≤ R L, an edge of 90 degrees s ≤ L/4, and a fin of width t about s ≤ t. For a plane,
/// or a sphere of R ≥ 2.1 L, the corners of the facet suffice.
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
