// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_TOOL_H
#define BILLET_PARAMETERS_TOOL_H

#include "billet/friction/friction_law.h"
#include "billet/geometry/facet_method.h"
#include "billet/geometry/rigid_surface.h"
#include "billet/parameters/named_values.h"
#include "billet/parameters/reader.h"

#include <array>
#include <memory>
#include <optional>
#include <utility>

namespace billet::parameters {

/// Registered types that a scene has without naming one.
constexpr const char *default_shape = "plane", *default_friction_law = "Coulomb";

/// Subsection Motion of a tool: it rotates about an axis through its centre, then translates.
struct Motion {
  Located<std::array<std::string, 3>> translation; ///< expressions of t and the amplitudes
  Located<std::string> rotation_angle;             ///< expression of t and the amplitudes [radians]
  dealii::Tensor<1, 3> rotation_axis;
  dealii::Tensor<1, 3> centre;
  /// Control of the tool in addition to this motion. `motion`: none. `force`: moves along
  /// `direction` until the contact force equals `load`. `moment`: rotates until the contact moment
  /// equals `load`. `stop`: stops once the contact force reaches `load`.
  enum class Control { motion, force, moment, stop };
  Control control = Control::motion;
  Located<std::string> load;      ///< expression of t and the amplitudes [force or force length]
  dealii::Tensor<1, 3> direction; ///< unit; for force and stop
  /// Mass, or moment of inertia about the axis, of a tool with force or moment.
  double inertia = 0.;
  double initial_rate = 0.;     ///< speed along the direction, or about the axis
  Located<double> removal_time; ///< infinite: never
  double release_time;          ///< over which the forces of a removed tool fade

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);

private:
  void parse_control(Reader &reader);
};

/// One named subsection of Tools.
struct Tool {
  std::string name;
  std::string origin;
  std::shared_ptr<const RigidSurface> surface;
  std::string shapes; ///< of the surface's parts, for reports
  Motion motion;

  /// Declares the parameters. `shapes`: name and shape of each part of the surface.
  static void declare(dealii::ParameterHandler &prm,
                      const std::vector<std::pair<std::string, std::string>> &shapes);
  void parse(Reader &reader);
};

/// Facet methods of scene files; none: automatic.
const NamedValues<std::optional<FacetMethod>> &facet_methods();

/// One named subsection of Contact pairs.
struct ContactPair {
  enum class PenaltyUnit { factor, absolute };
  enum class PenaltyOf { automatic, stiffer, series };
  enum class Passes { automatic, one, two };
  enum class Edges { automatic, held, free };

  struct Penalty {
    PenaltyUnit unit;
    PenaltyOf of; ///< the bodies' stiffnesses that `unit` refers to
    double normal, tangential;
    bool is_given = false;            ///< set in the scene, and therefore kept
    bool is_tangential_given = false; ///< same for the tangential penalty
  };
  /// Facets of pairs of bodies.
  struct Facets {
    Located<std::optional<FacetMethod>> method; ///< none: automatic
    Passes passes;
    Edges edges;
    double smoothing;
    double search_margin; ///< [facet sizes]
  };
  /// Treatment of initial penetrations and gaps.
  struct Initial {
    Located<double> allowed_penetration; ///< [facet sizes]
    bool may_overlap;
    double ramp_time;  ///< over which the allowed overlap fades; 0: never
    double closed_gap; ///< maximum gap that counts as closed; 0: none
  };

  std::string name;
  std::string origin;
  bool is_generated = false; ///< by 'Contact = all'
  Located<std::string> body;
  BoundaryIds boundary_ids;
  Located<std::string> tool;        ///< empty for a pair of two bodies
  Located<std::string> second_body; ///< empty for a pair of a body and a tool
  BoundaryIds second_boundary_ids;
  FrictionPointer friction; ///< null: none
  Penalty penalty;
  std::optional<double> penetration_tolerance; ///< 0: pure penalty; none: limits softness, (L7)
  Facets facets;
  Initial initial;
  /// Exact surface that the facets of both bodies approximate, if it is known.
  struct Correction {
    enum class Kind { none, cylinder, sphere };
    Kind kind = Kind::none;
    dealii::Tensor<1, 3> point; ///< on the axis, or the centre
    dealii::Tensor<1, 3> axis;  ///< unit
  };
  Correction correction;

  bool is_between_bodies() const { return tool.value.empty(); }

  static void declare(dealii::ParameterHandler &prm);
  /// Declares the parameters beside those of faces and their true surface.
  static void declare_values(dealii::ParameterHandler &prm);
  /// Declares those of them that are for pairs of bodies only.
  static void declare_values_of_bodies(dealii::ParameterHandler &prm);
  void parse(Reader &reader);

private:
  void parse_bodies(Reader &reader);
  void parse_penetration_tolerance(Reader &reader);
  void parse_initial_state(Reader &reader);
};

} // namespace billet::parameters

#endif
