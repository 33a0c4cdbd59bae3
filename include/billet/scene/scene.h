// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_SCENE_H
#define BILLET_SCENE_SCENE_H

#include "billet/diagnostics.h"
#include "billet/error_notes.h"
#include "billet/friction/friction_law.h"
#include "billet/geometry/axes.h"
#include "billet/mechanics/element_block.h"
#include "billet/mesh/boundary_groups.h"
#include "billet/parameters/scene.h"
#include "billet/scene/mesh_builder.h"
#include "billet/scene/node_finder.h"
#include "billet/scene/tool.h"
#include "billet/scene/whole_section.h"
#include "billet/times.h"

#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <iosfwd>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <vector>

namespace billet {

struct ResolvedScene;

/// Times between which a support holds its nodes.
struct SupportTimes {
  double from = 0.;
  double until = std::numeric_limits<double>::infinity();
  double fade_time = 0.; ///< over which its forces fade after `until`; 0: at once

  /// Whether it begins within the run. Then it holds its nodes where they are at `from`.
  bool is_late() const { return from > 0.; }
  bool always() const { return !is_late() && !std::isfinite(until); }
  /// Whether it holds at time t, both ends included.
  bool acts_at(const double t) const { return !times::is_before(t, from) && !times::is_after(t, until); }
  /// Whether it holds in a step that starts at t.
  bool acts_after(const double t) const { return !times::is_before(t, from) && times::is_before(t, until); }
};

/// Constraint n · u = value on boundary nodes, from a symmetry plane or a support.
struct Constraint {
  std::string name;   ///< for messages and reports
  std::string origin; ///< place where its value is set, for messages
  /// Constrained nodes: either those of these boundaries ...
  std::vector<unsigned int> boundary_ids;
  /// ... or these nodes of the body ...
  std::shared_ptr<const NodePlaces> nodes = {};
  /// ... or, if there are neither, boundary nodes on this plane.
  bool on_plane = false;
  bool is_of_section = false; ///< a side of the layer or of the wedge
  dealii::Tensor<1, 3> normal;
  double offset = 0.;
  const Expression *value = nullptr; ///< null: 0
  std::shared_ptr<const Axes> axes;  ///< of a support with axes of its own, or null
  unsigned int component = 0;        ///< of these axes
  SupportTimes times;

  /// Distance from a plane or an axis, relative to the size of the body, below which a place is on
  /// it.
  static constexpr double rounding = 1e-8;

  /// Returns the unit normal at an undeformed position.
  dealii::Tensor<1, 3> direction(const dealii::Tensor<1, 3> &position) const {
    return axes ? axes->at(position)[component] : normal;
  }
  /// Whether it has a direction there: on the line of cylindrical axes, none is radial or
  /// circumferential.
  bool has_direction(const dealii::Tensor<1, 3> &position, const double tolerance) const {
    return !axes || !axes->are_cylindrical() || component == 2 || axes->radius(position) > tolerance;
  }
};

/// Times between which a load acts.
struct LoadTimes {
  double from = 0.;
  double until = std::numeric_limits<double>::infinity();
  double fade_time = 0.; ///< over which it fades after `until`; 0: at once

  /// Whether it acts during the whole run.
  bool always() const { return !(from > 0.) && !std::isfinite(until); }
  /// Whether it acts in a step that starts at t, before it fades.
  bool acts_after(const double t) const { return !times::is_before(t, from) && times::is_before(t, until); }
  /// Whether it begins or ends at t, the end of a step.
  bool changes_at(const double t) const {
    return acts_after(t) != acts_after(t * (1. - 4. * times::rounding)) && t > 0.;
  }
  /// Returns the factor of the load at time t. At `from` itself, the end of a step, there is none
  /// yet.
  double factor(const double t) const {
    if (from > 0. && !times::is_after(t, from))
      return 0.;
    if (!times::is_after(t, until))
      return 1.;
    return fade_time > 0. ? std::max(0., 1. - (t - until) / fade_time) : 0.;
  }
};

/// Load on a body of the scene.
struct AppliedLoad {
  std::string type; ///< for messages
  Load load;
  std::vector<unsigned int> boundary_ids; ///< empty if it acts on the whole body
  std::vector<Expression> expressions;    ///< expressions of the load
  LoadTimes times;
  std::string origin; ///< place in the scene file, for messages
  std::string name;
  std::shared_ptr<const NodePlaces> nodes = {}; ///< on which it acts; null: others
};

/// Returns the element formulation of a body.
ElementFormulation make_formulation(const parameters::Body &parameters);

/// Material, constraints and loads of a body, without its mesh.
struct Body {
  std::string name;
  BoundaryNames boundary_names; ///< of its mesh
  std::shared_ptr<const PointLaw> law;
  /// Number of the material, the same for bodies whose materials have the same parameters.
  std::size_t material;
  ElementFormulation formulation; ///< for implicit scenes
  double young_modulus;
  double max_modulus;                      ///< uniaxial-strain modulus, K + 4/3 G [stress]
  double density;                          ///< undeformed
  std::unique_ptr<Expression> temperature; ///< of the time; null if the law does not depend on it
  std::vector<Constraint> constraints;
  std::vector<std::unique_ptr<Expression>> expressions; ///< owned here, used by `holds`
  std::vector<AppliedLoad> loads;
  std::vector<Expression> initial_velocity; ///< three expressions of the position
  /// Three expressions of the undeformed position; none with two points through the thickness.
  std::vector<Expression> thickness_direction;
};

/// Treatment of initial overlap and initial gaps of a pair.
struct InitialOverlap {
  bool is_allowed = false;
  double ramp_time = 0.;  ///< over which the allowed overlap fades; 0: never
  double closed_gap = 0.; ///< maximum gap that counts as closed [length]

  /// Whether a gap counts as closed.
  bool closes(const double gap) const { return gap > 0. && gap <= closed_gap; }
  /// Returns the part of an initial penetration `penetration` that counts as none. A depth < 0 is
  /// an initial gap that counts as closed permanently.
  static double counted(const double penetration, const double part) {
    return penetration > 0. ? part * penetration : penetration;
  }

  /// Returns the fraction of the initial penetration that counts as none at time t.
  double allowed_part(const double t) const { return ramp_time > 0. ? std::max(0., 1. - t / ramp_time) : 1.; }
};

/// Returns the length h of penalties E/h. It is the facet size, or, for default penalties in
/// dynamics, the element thickness if that is smaller. Thin elements shorten the stable step enough
/// for such stiff springs; springs of wide facets would be as soft as these elements.
inline double penalty_length(const bool counts_thickness, const double facet_size, const double thickness) {
  return counts_thickness ? std::min(facet_size, thickness) : facet_size;
}

/// Settings that all contact pairs share.
struct PairSettings {
  std::string name;
  const parameters::ContactPair *input; ///< its parameters, for messages
  FrictionPointer friction;             ///< null: none
  bool penalty_is_factor;
  bool penalty_counts_thickness; ///< see penalty_length()
  double normal_penalty, tangential_penalty;
  std::optional<double> penetration_tolerance; ///< [facet sizes]; 0: pure penalty; none: (L7)
  /// Whether it is raised in dynamics while penetration is too large, (L8).
  bool is_raised;
  InitialOverlap overlap;

  /// Whether augmentation continues until penetration is a small part of the deformation.
  bool limits_softness() const { return !penetration_tolerance; }
  bool has_tolerance() const { return penetration_tolerance.value_or(0.) > 0.; }
  bool is_augmented() const { return limits_softness() || has_tolerance(); }
  bool has_friction() const { return friction != nullptr; }
};

/// Contact pair of boundary faces of a body and a tool.
struct ContactPair : PairSettings {
  std::size_t body;
  std::vector<unsigned int> boundary_ids;
  std::size_t tool;

  /// Returns k [force/length³] from the scene's number, for a penalty_length() h on a body with
  /// Young's modulus E.
  double scaled_penalty(const double penalty, const double young_modulus, const double h) const {
    return penalty_is_factor ? penalty * young_modulus / h : penalty;
  }
};

/// Contact pair of boundary faces of two bodies, or of one body with itself.
struct BodyPair : PairSettings {
  std::array<std::size_t, 2> bodies;
  std::array<std::vector<unsigned int>, 2> boundary_ids; ///< for self-contact both are the same
  bool is_self_contact;
  FacetMethod facets;
  bool two_passes, edges;
  parameters::ContactPair::PenaltyOf penalty_of;
  double smoothing;     ///< see ContactLimits::zone
  double search_margin; ///< [facet sizes]
  parameters::ContactPair::Correction correction;
};

/// Capabilities that the scene uses. Nothing that is false here is allocated or run.
struct Capabilities {
  bool plasticity = false;
  bool contact = false;
  bool friction = false;
  bool body_contact = false;
  bool moving_supports = false;
  bool stabilisation = false; ///< one-point elements
  bool unsymmetric_matrix = false;
};

/// Scene built from its parameters: everything except the distributed mesh.
class Scene {
public:
  /// Builds the scene. Throws InputError.
  explicit Scene(const parameters::Scene &parameters);
  ~Scene();
  Scene(const Scene &) = delete; // parts of it refer to each other
  Scene &operator=(const Scene &) = delete;

  const parameters::Scene &parameters() const { return parameters_; }
  const std::vector<Body> &bodies() const { return bodies_; }
  const std::vector<Tool> &tools() const { return tools_; }
  const std::vector<ContactPair> &pairs() const { return pairs_; }
  const std::vector<BodyPair> &body_pairs() const { return body_pairs_; }
  const Capabilities &capabilities() const { return capabilities_; }
  /// Returns what forces on the model are in the whole.
  const WholeSection &whole_section() const { return whole_section_; }
  /// Returns the scene's choice, with `automatic` resolved.
  parameters::ContactTangent contact_tangent() const { return contact_tangent_; }

  /// Returns the times at which something begins or ends, so that a step has to end there. In
  /// implicit schemes they include corners() of amplitudes in use, unless they are close to another
  /// stop.
  std::vector<double> stops() const;

  /// Returns for x, y, z whether the direction is unconstrained and unloaded: no support, symmetry
  /// plane, tool or load.
  std::array<bool, 3> free_directions() const;

  /// Builds the meshes of all bodies in one; see merge_bodies(). Checks boundary ids, nodes on
  /// symmetry planes, supports and initial penetration. Throws InputError. Serial.
  void build_mesh(MeshDetail detail, dealii::Triangulation<3> &mesh) const;

  /// Returns the number of elements of all bodies, from the outlines of the meshes.
  std::size_t count_elements() const;

  /// Prints a description of the model, for --check; from the outlines of the meshes.
  void describe(std::ostream &stream) const;
  /// Returns the description as one JSON object on one line, with these messages.
  std::string describe_as_json(const DiagnosticList &diagnostics) const;

private:
  /// Capability of the program, with its use in the scene.
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
  explicit Scene(ResolvedScene resolved);
  void note_errors_on_outlines(ErrorNotes &errors, const std::set<std::size_t> &unsound) const;
  void check_axes(const dealii::Triangulation<3> &mesh) const;
  /// Notes errors, and in `unsound` the bodies whose supports or loads have some.
  void check_boundary_ids(const dealii::Triangulation<3> &mesh, MeshDetail detail, ErrorNotes &errors,
                          std::set<std::size_t> &unsound) const;
  void check_planes(const dealii::Triangulation<3> &mesh, std::size_t b) const;
  void check_support(const dealii::Triangulation<3> &mesh, std::size_t b) const;
  /// Notes all errors that show on the meshes, except about the support of unsound bodies.
  void check_on_mesh(const dealii::Triangulation<3> &mesh, MeshDetail detail, ErrorNotes &errors,
                     std::set<std::size_t> unsound) const;
  /// Refuses a static body that supports which begin or end leave free, after the last of its tools
  /// is removed. Returns false if it has no such supports.
  bool check_support_times(std::size_t b, const dealii::Triangulation<3> &mesh, double last_removal) const;
  void check_initial_penetration(const dealii::Triangulation<3> &mesh) const;

  const parameters::Scene parameters_;
  std::vector<Body> bodies_;
  std::vector<Tool> tools_;
  std::vector<ContactPair> pairs_;
  std::vector<BodyPair> body_pairs_;
  Capabilities capabilities_;
  WholeSection whole_section_;
  parameters::ContactTangent contact_tangent_;
};

/// Whether the boundary face is part of the constraint's boundaries or has all nodes in its plane.
/// `tolerance` [length].
bool constrains_face(const Constraint &constraint, const dealii::Triangulation<3>::active_face_iterator &face,
                     double tolerance);

} // namespace billet

#endif
