// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_APPROACH_H
#define BILLET_RUN_APPROACH_H

#include "billet/geometry/placement.h"
#include "billet/geometry/surface_patch.h"
#include "billet/run/scene_report.h"

#include <mpi.h>

#include <functional>
#include <vector>

namespace billet {

/// Place of a point relative to a surface.
struct PointGap {
  /// Whether it is in front of the surface or behind it, not beyond its edge.
  bool faces = false;
  double gap = 0.;      ///< if it faces the surface; negative behind [length]
  double distance = 0.; ///< at least 0 [length]
  /// Unit vector out of the surface at the nearest point, if it faces it.
  dealii::Tensor<1, 3> outward;
  unsigned int patch = 0; ///< guess for the next measurement of this point
};

/// Points that may touch a surface while both move as rigid bodies.
struct GapSide {
  std::vector<dealii::Tensor<1, 3>> points; ///< undeformed, in the same order on all ranks
  /// Unit vectors out of their own surface, or 0 if there is none.
  std::vector<dealii::Tensor<1, 3>> normals;
  /// Placement of the surface relative to the points. Throws SolutionFailure, on all ranks, if it
  /// is undefined.
  std::function<Placement(double t)> placement;
  /// Returns the gap of a point in the surface's own coordinates. `patch`: see PointGap.
  std::function<PointGap(const dealii::Tensor<1, 3> &x, unsigned int patch)> measure;

  /// Returns the gap of point i. If its own surface looks away from the other one, it does not face
  /// that.
  PointGap gap_of(std::size_t i, const Placement &placement, unsigned int patch = 0) const;
};

/// Returns the gaps at time t of all sides together. Each rank measures a part of the points.
/// Collective.
GapReport measure_gaps(const std::vector<GapSide> &sides, double t, MPI_Comm communicator);

/// Time span of a search for contact.
struct ApproachSpan {
  double end;                ///< search from 0 to this time
  std::vector<double> stops; ///< times at which motions may turn
  double size;               ///< of facets [length]
};

/// Returns the first time at which a point touches, by the gaps along the motions and bisection;
/// none if no point touches. There are 200 to 1000 of these gaps. In the interval between two, the
/// surface moves by a quarter of a facet if their number allows. Collective.
std::optional<MeetingReport> find_meeting(const std::vector<GapSide> &sides, const ApproachSpan &span,
                                          MPI_Comm communicator);

} // namespace billet

#endif
