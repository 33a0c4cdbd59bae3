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

/// Finds bodies that go into each other, or into a tool, although no contact pair connects them. Scenes whose
/// bodies and tools all share pairs cost nothing.
///
/// Of two bodies whose boxes overlap, nodes of the surface of one count that are inside elements of the
/// other, deeper below its surface than a tenth of a facet and a fifth of the element's thickness there.
/// Bodies that are so at the start are left out. Nodes count as inside a tool if they were in front of it at
/// the check before, and are a tenth of a facet behind it now.
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
  struct Couple {
    std::size_t body, other; ///< another body, or a tool
    bool is_open = true;     ///< not yet reported
    std::vector<bool> is_in_front;
  };
  /// The deepest node of one body in another.
  struct Deepest {
    double depth = 0., relative = 0.; ///< [length], [what is allowed]
    dealii::Tensor<1, 3> position;
  };
  using Positions = std::vector<std::vector<dealii::Tensor<1, 3>>>; ///< of surface nodes, by body

  Positions positions_at(const Vector *displacements) const;
  std::vector<BoundingBox> boxes_around(const Positions &positions) const;
  /// Of body `a` in body `b`, whose boxes overlap. Collective.
  Deepest find_deepest(std::size_t a, std::size_t b, const Positions &positions,
                       const std::vector<BoundingBox> &boxes, const Vector *displacements) const;
  std::optional<Deepest> find_overlap(const Couple &couple, const Positions &positions,
                                      const std::vector<BoundingBox> &boxes,
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
  std::vector<Couple> bodies_, tools_;             ///< without a pair
  std::string told_;                               ///< lines of name_of()
};

} // namespace billet

#endif
