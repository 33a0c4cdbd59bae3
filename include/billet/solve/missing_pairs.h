// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_MISSING_PAIRS_H
#define BILLET_SOLVE_MISSING_PAIRS_H

#include "billet/diagnostics.h"
#include "billet/discretization/boundary_facets.h"
#include "billet/scene/scene.h"
#include "billet/solve/solution.h"
#include "billet/state.h"

#include <optional>
#include <vector>

namespace billet {

/// Finds bodies that penetrate each other, a tool, or themselves where no contact pair connects the
/// faces that meet. Bodies and tools all of whose faces are in pairs need no check.
///
/// For two bodies with overlapping bounding boxes, a surface node of one counts if it is inside an
/// element of the other. Its depth below the surface must exceed a tenth of a facet or a fifth of
/// the element's thickness there, whichever is smaller. Faces on symmetry planes, as of a wedge,
/// are not surfaces. The node does not count if both it and the nearest face are in pairs of the
/// two bodies. Bodies that overlap at the start are left out.
///
/// A node that is in no pair with a tool counts as inside it under two conditions. It was in front
/// of the tool at the last check. It is now behind by a tenth of a facet more than the nodes in
/// pairs. A body without a pair with itself penetrates itself if the centre of a facet is well
/// within an element.
class MissingPairs {
public:
  /// Collective.
  MissingPairs(const Scene &scene, const Discretization &discretization);

  /// Checks an accepted step; in explicit scenes a step now and then. Each couple is reported once.
  /// Collective.
  DiagnosticList check(const SolutionState &state);

  /// Saves which couples have been reported.
  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  struct Node {
    std::array<DofIndex, 3> dofs;
    dealii::Point<3> position; ///< undeformed
    double facet_size;         ///< the smallest around it [length]
  };
  /// Flags of the nodes and facets of a surface, in the order of nodes_ and facets_, that are in
  /// pairs of the couple.
  struct Named {
    std::vector<bool> nodes, facets;
  };
  struct Couple {
    std::size_t body, other;    ///< another body, the same one, or a tool
    bool has_pair;              ///< a pair that leaves out some faces
    std::array<Named, 2> named; ///< of the body, and of the other one
    bool is_open = true;        ///< not yet reported
    std::vector<bool> is_in_front;
  };
  /// Deepest node of one body in another.
  struct Deepest {
    double penetration = 0., relative = 0.; ///< [length], [allowed depth]
    dealii::Tensor<1, 3> position;
  };
  using Positions = std::vector<std::vector<dealii::Tensor<1, 3>>>; ///< of surface nodes, by body

  Named name_surface(std::size_t body, const std::vector<unsigned int> &boundary_ids) const;
  /// Whether pairs name all nodes and facets. Collective.
  bool is_complete(const Couple &couple) const;
  Positions positions_at(const Vector *displacements) const;
  std::vector<BoundingBox> boxes_around(const Positions &positions) const;
  /// Finds the deepest node of the couple's first body in the other, whose boxes overlap, or the
  /// reverse. Collective.
  Deepest find_deepest(const Couple &couple, bool other_in_first, const Positions &positions,
                       const std::vector<BoundingBox> &boxes, const Vector *displacements) const;
  std::optional<Deepest> find_overlap(const Couple &couple, const Positions &positions,
                                      const std::vector<BoundingBox> &boxes,
                                      const Vector *displacements) const;
  /// Returns the centre of a facet of a body that is well within an element of it. Collective.
  std::optional<dealii::Tensor<1, 3>> find_self_overlap(const Couple &couple,
                                                        const Vector *displacements) const;
  std::string describe_body(const Couple &couple) const;
  std::string describe_tool(const Couple &couple) const;
  /// Returns a line that names both.
  std::string name_of(const Couple &couple, const std::string &other) const;
  Deepest enter_tool(Couple &couple, const Positions &positions, const Placement &placement) const;

  const Scene &scene_;
  const Discretization &discretization_;
  std::vector<std::vector<Node>> nodes_;           ///< of these facets, by body, on this rank
  std::vector<std::vector<BoundaryFacet>> facets_; ///< of surfaces except symmetry planes
  std::vector<Couple> bodies_, tools_, selves_;    ///< that pairs do not connect completely
  std::string reported_;                           ///< lines of name_of() that have been reported
};

} // namespace billet

#endif
