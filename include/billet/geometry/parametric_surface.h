// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_PARAMETRIC_SURFACE_H
#define BILLET_GEOMETRY_PARAMETRIC_SURFACE_H

#include "billet/geometry/facet_tree.h"

#include <array>
#include <functional>
#include <optional>

namespace billet {

/// Point p(u, v) of a surface, with derivatives.
struct SurfacePoint {
  dealii::Tensor<1, 3> p, p_u, p_v, p_uu, p_uv, p_vv;
};

/// Returns the contact data of x whose foot is `foot`. The normal is along side p,u × p,v, with
/// `side` 1 or −1. g and b are the fundamental forms, b positive where the surface is convex. With
/// J = (p,u p,v)
///   ∂n/∂x = J (g + gap b)⁻¹ b g⁻¹ Jᵀ,
/// which is set to zero at a centre of curvature. The caller decides whether x is beyond the edge.
ClosestPoint at_foot(const SurfacePoint &foot, const dealii::Tensor<1, 3> &x, double side);

/// Range of a parameter of a surface.
struct ParameterRange {
  double low, high;
  bool is_periodic; ///< the surface continues beyond; low and high are no bounds
  bool is_closed;   ///< both ends are the same line on the surface
};

/// Local minimum of the distance of x from a surface.
struct SurfaceFoot {
  double u, v;
  SurfacePoint point;
  bool is_at_bound; ///< x is beyond an end of the range
};

/// Finds a local minimum by Newton's method with line search from (u, v). The iterate follows
/// bounds where it meets them; past a bound of a closed surface it continues at the other one.
SurfaceFoot descend_to_foot(const std::function<SurfacePoint(double, double)> &surface,
                            const std::array<ParameterRange, 2> &ranges, const dealii::Tensor<1, 3> &x,
                            double u, double v);

/// Surface given by its values, and a triangulation of a part of it.
class SampledSurface {
public:
  using Surface = std::function<SurfacePoint(double, double)>;

  /// `parameters` are those of the mesh's points, which lie on the surface.
  SampledSurface(Surface surface, const std::array<ParameterRange, 2> &ranges, TriangleMesh mesh,
                 std::vector<std::array<double, 2>> parameters);

  /// Returns the nearest foot of x that `accept` admits and that is nearer than the edge; none if
  /// there is no such foot. `edge_distance` is called only if the foot on the nearest facet is not
  /// accepted. Newton's method starts at the nearest facet, and at others that may be as near but
  /// are far from earlier starting points.
  std::optional<SurfacePoint> nearest(const dealii::Tensor<1, 3> &x,
                                      const std::function<bool(const SurfaceFoot &)> &accept,
                                      const std::function<double()> &edge_distance) const;

  SurfacePoint at(const double u, const double v) const { return surface_(u, v); }
  const TriangleMesh &mesh() const { return facets_.mesh(); }

private:
  SurfaceFoot descend(const dealii::Tensor<1, 3> &x, const FacetTree::Foot &start) const;
  std::array<double, 2> turn_about_pole(const dealii::Tensor<1, 3> &x, std::array<double, 2> uv,
                                        unsigned int around) const;

  Surface surface_;
  std::array<ParameterRange, 2> ranges_;
  FacetTree facets_;
  std::vector<std::array<double, 2>> parameters_;
  std::vector<unsigned char> poles_; ///< per point: 1 or 2 where p,u or p,v is zero, otherwise 0
  double deviation_ = 0.;            ///< maximum distance of the surface from its facets [length]
  double facet_size_ = 0.;
};

} // namespace billet

#endif
