// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_TRIMMED_SURFACE_H
#define BILLET_GEOMETRY_TRIMMED_SURFACE_H

#include "billet/geometry/parametric_curve.h"
#include "billet/geometry/parametric_surface.h"
#include "billet/geometry/trimming_loops.h"

namespace billet {

/// Part of a parametric surface within loops of edges.
class TrimmedSurface final : public SurfacePatch {
public:
  using Parameters = std::array<double, 2>;

  struct Edge {
    TrimmingLoops::Curve on_surface; ///< in the plane of the parameters
    /// Ascending parameters from end to end, with small changes of direction.
    std::vector<double> samples;
    bool is_seam; ///< where a closed surface meets itself: no free edge
    bool is_pole; ///< a point; the next two are empty
    std::function<double(const dealii::Tensor<1, 3> &)> nearest; ///< parameter of the nearest point
    std::function<dealii::Tensor<1, 3>(double)> position;
  };
  struct Description {
    SampledSurface surface;
    /// Returns the parameters of the nearest point of the untrimmed surface, if there is a closed
    /// form.
    std::function<Parameters(const dealii::Tensor<1, 3> &)> closed_form;
    std::array<double, 2> periods;   ///< periods of the parameters, 0: none
    std::array<double, 2> low, high; ///< bounds of the parameters
    std::vector<Edge> edges;
    double side;          ///< 1 or −1; the normal is side p,u × p,v
    double edge_accuracy; ///< [length]
    BoundingBox box;
  };

  explicit TrimmedSurface(Description description);

  ClosestPoint closest_point(const dealii::Tensor<1, 3> &x) const override;
  BoundingBox bounding_box() const override { return d_.box; }
  double edge_accuracy() const override { return d_.edge_accuracy; }
  void draw(const OutputRegion &region, SurfaceMesh &surface_mesh) const override;

private:
  bool is_inside(Parameters parameters) const;
  SurfacePoint regular_point(const Parameters &parameters) const;
  ClosestPoint nearest_on_edge(const dealii::Tensor<1, 3> &x) const;
  /// Surface near a pole that it surrounds smoothly.
  struct Cap {
    dealii::Tensor<1, 3> position, normal;
    dealii::Tensor<2, 3> curvature; ///< ∂n/∂x on the surface
    double radius;
    ClosestPoint project(const dealii::Tensor<1, 3> &x) const;
  };
  bool goes_around(const Edge &pole) const;
  std::vector<SurfacePoint> ring_about(const Edge &pole, double aside) const;
  dealii::Tensor<1, 3> mean_normal(const Edge &pole) const;
  void add_cap(const Edge &pole);

  Description d_;
  TrimmingLoops loops_;
  std::vector<Edge> edges_;
  std::vector<Cap> caps_;
};

} // namespace billet

#endif
