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

/// Finds bodies that go into each other, into a tool, or into themselves, where no contact pair connects the
/// faces that meet. Bodies and tools all of whose faces are in pairs cost nothing.
///
/// Of two bodies whose boxes overlap, nodes of the surface of one count that are inside elements of the
/// other, deeper below its surface than a tenth of a facet and a fifth of the element's thickness there; not
/// if both the node and the face nearest to it are in pairs of the two. Bodies that are so at the start are
/// left out. Nodes that are in no pair with a tool count as inside it if they were in front of it at the
/// check before, and are now behind it, by a tenth of a facet more than those that are in one. A body without
/// a pair with itself is inside itself where the middle of a facet is well within an element.
class MissingPairs {
public:
  /// Collective.
  MissingPairs(const Scene &scene, const Discretization &discretization);

  /// After an accepted step; of explicit scenes now and then. Each couple is reported once. Collective.
  DiagnosticList check(const SolutionState &state);

  /// What has been reported.
  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  struct Node {
    std::array<DofIndex, 3> dofs;
    dealii::Point<3> position; ///< undeformed
    double facet_size;         ///< the smallest around it [length]
  };
  /// Which nodes and facets of a surface are in pairs of the couple, as nodes_ and facets_ list them.
  struct Named {
    std::vector<bool> nodes, facets;
  };
  struct Couple {
    std::size_t body, other;    ///< another body, the same one, or a tool
    bool has_pair;              ///< of which faces are missing
    std::array<Named, 2> named; ///< of the body, and of the other one
    bool is_open = true;        ///< not yet reported
    std::vector<bool> is_in_front;
  };
  /// The deepest node of one body in another.
  struct Deepest {
    double depth = 0., relative = 0.; ///< [length], [what is allowed]
    dealii::Tensor<1, 3> position;
  };
  using Positions = std::vector<std::vector<dealii::Tensor<1, 3>>>; ///< of surface nodes, by body

  Named name_surface(std::size_t body, const std::vector<unsigned int> &boundary_ids) const;
  /// Whether pairs name all nodes and facets. Collective.
  bool is_complete(const Couple &couple) const;
  Positions positions_at(const Vector *displacements) const;
  std::vector<BoundingBox> boxes_around(const Positions &positions) const;
  /// Of the couple's first body in the other, whose boxes overlap, or the other way round. Collective.
  Deepest find_deepest(const Couple &couple, bool other_in_first, const Positions &positions,
                       const std::vector<BoundingBox> &boxes, const Vector *displacements) const;
  std::optional<Deepest> find_overlap(const Couple &couple, const Positions &positions,
                                      const std::vector<BoundingBox> &boxes,
                                      const Vector *displacements) const;
  /// The middle of a facet of a body that is well within an element of it. Collective.
  std::optional<dealii::Tensor<1, 3>> find_self_overlap(const Couple &couple,
                                                        const Vector *displacements) const;
  std::string describe_body(const Couple &couple) const;
  std::string describe_tool(const Couple &couple) const;
  /// A line that names both.
  std::string name_of(const Couple &couple, const std::string &other) const;
  Deepest enter_tool(Couple &couple, const Positions &positions, const Placement &placement) const;

  const Scene &scene_;
  const Discretization &discretization_;
  std::vector<std::vector<Node>> nodes_;           ///< of surfaces, by body, on this rank
  std::vector<std::vector<BoundaryFacet>> facets_; ///< of surfaces but for symmetry planes
  std::vector<Couple> bodies_, tools_, selves_;    ///< that pairs do not connect in full
  std::string told_;                               ///< lines of name_of()
};

} // namespace billet

#endif
