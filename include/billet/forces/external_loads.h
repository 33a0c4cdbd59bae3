// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FORCES_EXTERNAL_LOADS_H
#define BILLET_FORCES_EXTERNAL_LOADS_H

#include "billet/discretization/boundary_facets.h"
#include "billet/discretization/local_nodes.h"
#include "billet/discretization/supports.h"
#include "billet/usage.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace billet {

/// Loads of all bodies on the elements, faces and nodes of a rank. Their order is body loads, loads
/// on deformed faces, nodal loads, loads on surfaces, loads on points.
class ExternalLoads {
public:
  /// Places the loads. `masses` are this rank's shares of the nodal masses, on which body loads
  /// act. Throws InputError. Collective.
  ExternalLoads(const Scene &scene, const LocalNodes &nodes, std::vector<double> masses);
  ~ExternalLoads();

  /// Measures how surfaces under loads have moved as a whole; it precedes add_forces(). Collective.
  void follow(const NodalVectors &displacements);

  /// Adds the forces [force] at time t.
  void add_forces(double t, const NodalVectors &displacements, const NodalVectors &velocities,
                  NodalVectors &forces) const;

  /// Adds the forces of one load of the scene.
  void add_forces_of(const AppliedLoad &load, double t, const NodalVectors &displacements,
                     const NodalVectors &velocities, NodalVectors &forces) const;
  /// Returns the nodes on which a load acts, sorted.
  std::vector<unsigned int> nodes_of(const AppliedLoad &load) const;

  /// Adds −∂F/∂u − `damping_factor` ∂F/∂v [force/length]. Collective.
  void add_tangent(double t, const NodalVectors &displacements, const NodalVectors &velocities,
                   double damping_factor, const TangentSystem &system) const;

  /// Adds to the bounds at the nodes: component 0 bounds the stiffness [force/length], component 1
  /// the damping [force time/length].
  void add_bounds(NodalVectors &bounds) const;

private:
  /// One load and its sites on this rank.
  template <class Action, class Site> struct Placed {
    const AppliedLoad *load;
    const Action *action;
    std::vector<Site> sites;
    std::unique_ptr<LoadedSurface> surface; ///< that the sites refer to, or null
  };
  /// Node and its mass or volume.
  struct WeightedNode {
    unsigned int node;
    double weight;
  };
  /// Node and its part of a force on a point.
  struct TurnedNode {
    unsigned int node;
    double weight;
    dealii::Tensor<2, 3> turn; ///< of the force: to the side of a wedge that the node is on
  };
  void place(const AppliedLoad &load, const BodyLoad &action, std::size_t body);
  void place(const AppliedLoad &load, const FaceLoad &action, std::size_t body);
  void place(const AppliedLoad &load, const NodalLoad &action, std::size_t body);
  void place(const AppliedLoad &load, const SurfaceLoad &action, std::size_t body);
  void place(const AppliedLoad &load, const PointLoad &action, std::size_t body);
  void place_on_nodes(const AppliedLoad &load, const PointLoad &action, std::size_t body);
  TurnedNode turned_node(unsigned int node, double weight) const;
  /// Calls visit(placed) for each load, in their order.
  template <class Visit> void visit(const Visit &visit) const {
    std::for_each(on_bodies_.begin(), on_bodies_.end(), visit);
    std::for_each(on_faces_.begin(), on_faces_.end(), visit);
    std::for_each(on_nodes_.begin(), on_nodes_.end(), visit);
    std::for_each(on_surfaces_.begin(), on_surfaces_.end(), visit);
    std::for_each(on_points_.begin(), on_points_.end(), visit);
  }
  void add(const Placed<BodyLoad, WeightedNode> &placed, double t, const NodalMotion &at,
           NodalVectors &forces) const;
  void add(const Placed<FaceLoad, LoadedFace> &placed, double t, const NodalMotion &at,
           NodalVectors &forces) const;
  void add(const Placed<NodalLoad, LoadedNode> &placed, double t, const NodalMotion &at,
           NodalVectors &forces) const;
  void add(const Placed<SurfaceLoad, LoadedFace> &placed, double t, const NodalMotion &at,
           NodalVectors &forces) const;
  void add(const Placed<PointLoad, TurnedNode> &placed, double t, const NodalMotion &at,
           NodalVectors &forces) const;
  std::unique_ptr<LoadedSurface> measure_surface(const std::vector<BoundaryFacet> &facets) const;
  void add_surface_tangents(double t, const NodalMotion &motion, const TangentSystem &system) const;
  NodalMotion motion(const NodalVectors &displacements, const NodalVectors &velocities) const {
    return {nodes_.positions().data(), displacements.data(), velocities.data()};
  }

  const Scene &scene_;
  const LocalNodes &nodes_;
  std::vector<double> masses_;
  std::vector<Placed<BodyLoad, WeightedNode>> on_bodies_;
  std::vector<Placed<FaceLoad, LoadedFace>> on_faces_;
  std::vector<Placed<NodalLoad, LoadedNode>> on_nodes_;
  std::vector<Placed<SurfaceLoad, LoadedFace>> on_surfaces_;
  std::vector<Placed<PointLoad, TurnedNode>> on_points_;
  HeldMemory memory_{Capability::loads};
};

} // namespace billet

#endif
