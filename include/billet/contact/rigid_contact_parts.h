// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_RIGID_CONTACT_PARTS_H
#define BILLET_CONTACT_RIGID_CONTACT_PARTS_H

#include "billet/contact/contact_interface.h"
#include "billet/contact/missed_edge.h"
#include "billet/contact/projected_areas.h"
#include "billet/contact/restless_nodes.h"
#include "billet/contact/thin_tool_watch.h"
#include "billet/contact/tool_friction.h"

#include <cmath>
#include <optional>
#include <vector>

namespace billet {

/// Indices of nodes in schemes without a matrix.
struct BoundNodes {
  std::vector<unsigned int> local; ///< of each node of the mesh, in LocalNodes
  std::vector<bool> is_owned;      ///< as in LocalNodes; points inside facets are owned

  dealii::Tensor<1, 3> vector_of(const std::size_t i, const NodalVectors &vectors) const {
    return get_vector(vectors.data(), local[i]);
  }
};

/// State of contact with a rigid tool, which RigidContact advances and its evaluations and measures
/// read.
struct RigidContactParts {
  RigidContactParts(const Scene &scene, const ContactPair &pair, const Discretization &discretization);
  RigidContactParts(const RigidContactParts &) = delete;
  RigidContactParts &operator=(const RigidContactParts &) = delete;

  const ContactPair &pair;
  const Tool &tool;
  const Discretization &discretization;
  const MPI_Comm communicator;
  const bool has_inertia;
  const bool is_explicit; ///< works are those of the trapezoidal rule
  SlaveSurface slaves;
  BoundNodes bound;                     ///< empty in schemes with a matrix
  std::vector<ToolContactState> states; ///< at the last update()
  ToolStep step;
  NeighbouringTools neighbours;
  MissedEdge missed_edge;
  RestlessNodes restless{RestlessNodes::max_changes}; ///< in iterations
  PressureRecord pressures;                           ///< not known in explicit schemes
  std::optional<ToolFriction> friction;               ///< none without friction
  std::optional<ThinToolWatch> thin_tool;             ///< none unless the tool is thin on any rank
  /// None unless a mesh became finer in contact.
  std::optional<FadingGaps> fading_gaps;
  double tool_reach = 0.; ///< maximum radius of curvature, at most the tool's size [length]
  HeldMemory memory{Capability::contact};

  CornerStates states_of(const ContactFacet &facet) const {
    return {&states[facet.nodes[0]], &states[facet.nodes[1]], &states[facet.nodes[2]],
            &states[facet.nodes[3]]};
  }
  /// Calls visit(node, depth) for the nodes that press with their full penalty, so that only their
  /// springs give their depths [length].
  template <class Visit> void visit_penetrations(const Visit &visit) const {
    for (std::size_t i = 0; i < states.size(); ++i)
      if (const ContactPoint &node = slaves.nodes[i];
          states[i].pressure > 0. && states[i].share == 1. && !node.is_fixed)
        visit(node, std::abs(states[i].gap + node.multiplier_offset));
  }

  /// Counts the changes of patch and status since the last iteration.
  void count_changes();
  /// Returns the part of initial penetrations that counts as none at time t.
  double allowed_part(const double t) const {
    return fading_gaps ? fading_gaps->part(t) : pair.overlap.allowed_part(t);
  }
  /// Does what ContactInterface::fade_gaps() says, (R7) of doc/theory.
  void fade_gaps(const FadingGaps &gaps, bool is_finer);
  /// Removes the tool: from now on no node touches it.
  void remove_tool();
  /// Makes the state of the last update() the start of the next step.
  void commit();
  /// Starts without contact in place of a load(), at these displacements of the nodes of the mesh.
  void begin(const ContactStep &at, const std::vector<dealii::Tensor<1, 3>> &displacements);

private:
  /// Allows the nodes the depths by which they exceed the interpolated ones of a coarser mesh.
  void keep_gaps();
  /// Takes from a node that is open the depth that it does not need any more.
  void leave_depth(std::size_t i);
  /// Sets the gaps of nodes at their positions, and those that the pair changes at the start.
  /// Returns the projections of the nodes. Collective.
  std::vector<RigidSurface::Projection> start_gaps();
  /// Whether an initial gap counts as closed, or an initial penetration as allowed.
  bool allows(const RigidSurface::Projection &projection) const;
  /// Carries changed initial gaps to the nodes that had no partner at the start, (C15). Collective.
  void carry_gaps(const std::vector<RigidSurface::Projection> &projections);
  /// Starts the histories of friction at the current positions.
  void start_friction();
  /// Stores the positions of nodes that might pass through a thin tool, for the next step.
  void record_positions();
  /// Stores the pressures of the last update() for the works of the next step.
  void record_pressures();
};

} // namespace billet

#endif
