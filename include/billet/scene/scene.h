// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_SCENE_H
#define BILLET_SCENE_SCENE_H

#include "billet/diagnostics.h"
#include "billet/friction/friction_law.h"
#include "billet/mechanics/element_block.h"
#include "billet/parameters/scene.h"
#include "billet/scene/mesh_builder.h"
#include "billet/scene/tool.h"

#include <deal.II/grid/tria.h>

#include <algorithm>
#include <iosfwd>
#include <memory>
#include <optional>
#include <vector>

namespace billet {

/// A plane or a prescribed displacement that holds boundary nodes.
struct Hold {
  std::string name;   ///< for messages and reports
  std::string origin; ///< where its value is set, the beginning of a message
  /// n · u = value; either nodes of these boundaries ...
  std::vector<unsigned int> boundary_ids;
  /// ... or, where there are none, boundary nodes on this plane.
  bool on_plane = false;
  dealii::Tensor<1, 3> normal;
  double offset = 0.;
  const Expression *value = nullptr; ///< none: 0
};

/// Load on a body of the scene.
struct AppliedLoad {
  std::string type; ///< for messages
  Load load;
  std::vector<unsigned int> boundary_ids; ///< none where it acts on the whole body
  std::vector<Expression> expressions;    ///< those of the load
};

/// Element of a body.
ElementFormulation make_formulation(const parameters::Body &parameters);

/// What a body is made of and how it is held; its mesh is elsewhere.
struct Body {
  std::string name;
  std::shared_ptr<const PointLaw> law;
  ElementFormulation formulation; ///< of implicit scenes
  double young_modulus;
  double largest_modulus; ///< of a strain that is held sideways, K + 4/3 G [stress]
  double density;         ///< of the undeformed body
  std::vector<Hold> holds;
  std::vector<std::unique_ptr<Expression>> expressions; ///< owned here, used by the holds
  std::vector<AppliedLoad> loads;
  std::vector<Expression> initial_velocity; ///< three, of the position
  /// Three, of the undeformed position; none with two points through the thickness.
  std::vector<Expression> thickness_direction;
};

/// How deep a pair may be in each other at the start.
struct InitialOverlap {
  bool is_allowed = false;
  double ramp_time = 0.;  ///< in which that ceases; 0: never
  double closed_gap = 0.; ///< up to which gaps count as closed [length]

  /// Whether a gap counts as closed.
  bool closes(const double gap) const { return gap > 0. && gap <= closed_gap; }
  /// What counts as no depth, of an initial one; < 0: a gap that is closed, for good.
  static double counted(const double depth, const double part) { return depth > 0. ? part * depth : depth; }

  /// The part of the initial depth that counts as none at time t.
  double allowed_part(const double t) const { return ramp_time > 0. ? std::max(0., 1. - t / ramp_time) : 1.; }
};

/// h, of which penalties E/h are made. Of penalties that no scene sets in dynamics it is the thickness of
/// thinner elements: they make the stable step short enough for such springs, and facets wider than thick
/// would give way as much as the elements.
inline double penalty_length(const bool counts_thickness, const double facet_size, const double thickness) {
  return counts_thickness ? std::min(facet_size, thickness) : facet_size;
}

/// What all contact pairs have.
struct PairSettings {
  std::string name;
  const parameters::ContactPair *input; ///< where it comes from, for messages
  FrictionPointer friction;             ///< null: none
  bool penalty_is_factor;
  bool penalty_counts_thickness; ///< penalty_length()
  double normal_penalty, tangential_penalty;
  std::optional<double> penetration_tolerance; ///< [facet sizes]; 0: penalties alone; none: (L7)
  bool is_raised;                              ///< in dynamics, while penetration takes too much, (L8)
  InitialOverlap overlap;

  /// Augmented until penetration takes little of the deformation.
  bool limits_softness() const { return !penetration_tolerance; }
  bool has_tolerance() const { return penetration_tolerance.value_or(0.) > 0.; }
  bool is_augmented() const { return limits_softness() || has_tolerance(); }
  bool has_friction() const { return friction != nullptr; }
};

/// Boundary faces of a body that may touch a tool.
struct ContactPair : PairSettings {
  std::size_t body;
  std::vector<unsigned int> boundary_ids;
  std::size_t tool;

  /// k [force/length³] from the scene's number, for a penalty_length() h on a body with Young's modulus E.
  double scaled_penalty(const double penalty, const double young_modulus, const double h) const {
    return penalty_is_factor ? penalty * young_modulus / h : penalty;
  }
};

/// Boundary faces of two bodies, or of one and the same, that may touch each other.
struct BodyPair : PairSettings {
  std::array<std::size_t, 2> bodies;
  std::array<std::vector<unsigned int>, 2> boundary_ids; ///< of a pair with itself: both alike
  bool is_self_contact;
  parameters::ContactPair::Facets facets;
  bool two_passes, edges;
  parameters::ContactPair::PenaltyOf penalty_of;
  double smoothing;     ///< ContactLimits::zone
  double search_margin; ///< [facet sizes]
  parameters::ContactPair::Correction correction;
};

/// What the scene asks of the program. Nothing that is false here is allocated or run.
struct Capabilities {
  bool plasticity = false;
  bool contact = false;
  bool friction = false;
  bool body_contact = false;
  bool moving_supports = false;
  bool stabilisation = false; ///< one-point elements
  bool unsymmetric_matrix = false;
};

/// What the user described, built once: everything but the mesh, which is distributed elsewhere.
class Scene {
public:
  /// Throws InputError.
  explicit Scene(const parameters::Scene &parameters);
  Scene(const Scene &) = delete; // parts of it refer to each other
  Scene &operator=(const Scene &) = delete;

  const parameters::Scene &parameters() const { return parameters_; }
  const std::vector<Body> &bodies() const { return bodies_; }
  const std::vector<Tool> &tools() const { return tools_; }
  const std::vector<ContactPair> &pairs() const { return pairs_; }
  const std::vector<BodyPair> &body_pairs() const { return body_pairs_; }
  const Capabilities &capabilities() const { return capabilities_; }
  /// The scene's choice, `automatic` resolved.
  parameters::ContactTangent contact_tangent() const { return contact_tangent_; }

  /// Times at which something begins or ends, so that a step has to end there. Where steps are long,
  /// corners() of amplitudes that drive something, too, unless they are as good as at another stop.
  std::vector<double> stops() const;

  /// Directions, x, y, z, in which nothing but the bodies themselves holds or drives them: no support, no
  /// symmetry plane, no tool; none where there are loads.
  std::array<bool, 3> free_directions() const;

  /// Builds the meshes of all bodies in one; see merge_bodies(). Then checks what needs a mesh: boundary ids,
  /// nodes on symmetry planes, supports, initial penetration. Throws InputError. Serial.
  void build_mesh(MeshDetail detail, dealii::Triangulation<3> &mesh) const;

  /// Number of elements of all bodies, from the outlines of the meshes.
  std::size_t count_elements() const;

  /// What will be modelled, for --check; from the outlines of the meshes.
  void describe(std::ostream &stream) const;
  /// The same as one JSON object, on one line, with these messages.
  std::string describe_as_json(const DiagnosticList &diagnostics) const;

private:
  /// A capability of the program: whether the scene needs it, and for what.
  struct CapabilityUse {
    std::string name;
    bool is_used;
    std::string how;
  };
  std::vector<CapabilityUse> capability_uses() const;
  void add_corners(std::vector<double> &times) const;
  void make_pairs();
  void allow_for_loads();
  void choose_material_tangents();
  void check_boundary_ids(const dealii::Triangulation<3> &mesh, MeshDetail detail) const;
  void check_supports(const dealii::Triangulation<3> &mesh) const;
  void check_initial_penetration(const dealii::Triangulation<3> &mesh) const;

  const parameters::Scene parameters_;
  std::vector<Body> bodies_;
  std::vector<Tool> tools_;
  std::vector<ContactPair> pairs_;
  std::vector<BodyPair> body_pairs_;
  Capabilities capabilities_;
  parameters::ContactTangent contact_tangent_;
};

/// Whether the boundary face is part of the hold's boundaries or has all nodes in its plane. `tolerance`
/// [length].
bool holds_face(const Hold &hold, const dealii::Triangulation<3>::active_face_iterator &face,
                double tolerance);

} // namespace billet

#endif
