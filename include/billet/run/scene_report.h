// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_SCENE_REPORT_H
#define BILLET_RUN_SCENE_REPORT_H

#include <deal.II/base/tensor.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace billet {

/// Faces of a body that share a boundary id, undeformed.
struct BoundaryReport {
  unsigned int id = 0;
  std::vector<std::string> names; ///< groups of the mesh file that contain them
  std::size_t n_faces = 0;
  double area = 0.;
  dealii::Tensor<1, 3> centre; ///< of the area
  /// Unit vector along the sum of all area vectors, out of the body; 0 if that is 0.
  dealii::Tensor<1, 3> normal;
  double flatness = 0.; ///< length of that sum over the area: 1 for a plane, 0 for a closed surface
};

/// A body, undeformed.
struct BodyReport {
  std::string name;
  std::size_t n_elements = 0, n_nodes = 0;
  std::size_t n_parts = 0; ///< separate sets of elements, without a common node
  dealii::Tensor<1, 3> low, high;
  double volume = 0.;
  double mass = 0.; ///< 0 without a density
  /// Volume without facets, where it is known; see find_smooth_volume().
  std::optional<double> smooth_volume;
  /// Volume and mass of the full circle over those of the body, which is a wedge; 1 if it is none.
  double circle_factor = 1.;
  /// Edges of the elements [length], without those of no length that prisms on an axis have; in the
  /// mean, each element counts its own.
  double min_edge = 0., mean_edge = 0., max_edge = 0.;
  /// Least scaled Jacobian: the product of three edges' unit vectors at a corner, or of the three
  /// axes through the centre. An axis stands for an edge of no length. 1 for a box, <= 0 if
  /// inverted.
  double min_quality = 0.;
  dealii::Tensor<1, 3> worst_element;     ///< centre of the element that has it
  std::vector<BoundaryReport> boundaries; ///< by ascending id
};

/// Gaps at time 0 between nodes and what they may touch.
struct GapReport {
  std::size_t n_nodes = 0; ///< of the pair's surfaces
  /// Number of these that are in front of the other surface or behind it, and do not look away. If
  /// 0, the rest is unset.
  std::size_t n_facing = 0;
  double least = 0., mean = 0.; ///< [length]; a penetration is negative
  dealii::Tensor<1, 3> nearest; ///< node of the least gap
};

/// First contact of a pair.
struct MeetingReport {
  double time = 0.;
  std::size_t n_nodes = 0;    ///< that meet at this time
  dealii::Tensor<1, 3> first; ///< undeformed position of one of them
};

/// A contact pair, undeformed.
struct PairReport {
  std::string name;
  bool is_self_contact = false;         ///< then there are no gaps
  bool is_sheet = false;                ///< whether its penalty may fall to that of sheets on tools
  GapReport gap;                        ///< at time 0
  std::optional<MeetingReport> meeting; ///< by the prescribed motions; none: never
  /// Whether loads, forces on tools or the deformation by supports may change that.
  bool depends_on_forces = false;
};

/// Stable step of an explicit scene at its start.
struct StableStepReport {
  double of_elements = 0.;      ///< undeformed and at rest [time]
  std::string body;             ///< of the element that sets it
  dealii::Tensor<1, 3> element; ///< its centre
  double min_edge = 0.;         ///< of this element [length]
  double step = 0.;             ///< with contact, loads and 'Safety factor' [time]
  /// Steps that contact makes shorter later, as the prescribed motions bring pairs together: the
  /// shortest, and when they begin.
  double shortest = 0., shortest_from = 0.;
  bool is_short_by_contact = false; ///< whether steps are less than a third of that of the elements
};

/// Forecast of the run.
struct RunReport {
  std::size_t n_dofs = 0;
  double memory = 0.; ///< estimate for all ranks [bytes]
  /// Approximate number of explicit and fixed steps, as the run prints; minimum of automatic ones.
  double n_steps = 0.;
  /// Number of explicit steps if contact lasts from where pairs meet; 0: it shortens none.
  double max_steps = 0.;
  bool is_minimum = false; ///< whether there may be many more steps
  std::optional<StableStepReport> stable_step;
};

/// The physics of a scene at its start, for --check. The same on all ranks.
struct SceneReport {
  std::vector<BodyReport> bodies;
  /// Reports of pairs, those with tools first; none for a restart, which begins deformed.
  std::vector<PairReport> pairs;
  std::optional<RunReport> run; ///< none for a restart
};

} // namespace billet

#endif
