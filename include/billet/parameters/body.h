// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_BODY_H
#define BILLET_PARAMETERS_BODY_H

#include "billet/geometry/axes.h"
#include "billet/loads/load.h"
#include "billet/material/elasticity.h"
#include "billet/material/forming_limit.h"
#include "billet/mechanics/element_type.h"
#include "billet/parameters/node_selection.h"
#include "billet/parameters/reader.h"

#include <array>
#include <limits>
#include <memory>
#include <optional>

namespace billet::parameters {

/// Subsection Mesh: source of a body's hexahedra.
struct Mesh {
  enum class Source { primitive, extruded, file };
  enum class Section { solid, plane_strain, axisymmetric };

  Source source;
  Located<Section> section{Section::solid, ""};
  double wedge_angle = 0.;        ///< of an axisymmetric section [rad]
  Located<std::string> primitive; ///< function of dealii::GridGenerator
  std::string arguments;
  unsigned int refinements;
  Located<double> section_area; ///< 0: as generated
  double height;
  unsigned int n_layers;
  Located<std::string> file_name;              ///< relative to the scene file
  Located<std::vector<std::string>> volumes;   ///< of the file, by their names; empty: all of it
  Located<std::vector<std::string>> positions; ///< three expressions of x, y, z, or none
  double scale;
  dealii::Tensor<1, 3> rotation_axis;
  double rotation_angle;
  dealii::Tensor<1, 3> translation;
  /// New id, and muParser condition on x, y, z of the face's centre; the last condition that holds
  /// applies.
  Located<std::vector<std::pair<unsigned int, std::string>>> boundary_ids;
  std::vector<std::string>
      boundary_names; ///< one for each of these; then the scene chooses the id. Empty: none
  Located<std::optional<double>>
      merged_distance; ///< of nodes in a file; 0: doubled nodes stay; none: refused

  /// Returns a vector of the mesh before its rotation in the scene.
  dealii::Tensor<1, 3> rotated(const dealii::Tensor<1, 3> &vector) const;

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);

private:
  void parse_section(const Reader &reader);
};

/// Subsection Material.
struct Material {
  Located<double> density;          ///< 0: not given
  Located<std::string> temperature; ///< expression of t; empty if the law does not depend on it
  std::shared_ptr<const Elasticity> elasticity;
  std::shared_ptr<const PointLaw> law;
  std::shared_ptr<const FormingLimit> forming_limit; ///< null: none

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

/// One named subsection of Supports.
struct Support {
  std::string name;
  BoundaryIds boundary_ids; ///< or, if they are empty, `nodes`
  NodeSelection nodes;
  std::array<bool, 3> components{};
  /// Expressions of x, y, z (reference position), t and the amplitudes.
  Located<std::array<std::string, 3>> displacement;
  Axes axes;
  double from = 0., until = std::numeric_limits<double>::infinity();
  std::optional<double> fade_time; ///< none: automatic

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

/// One named subsection of Loads: a load on a body in addition to contact.
struct Load {
  std::string name;
  std::string type;
  billet::Load load;
  std::vector<std::string> origins; ///< places of its expressions in the scene file, for messages
  BoundaryIds boundary_ids;         ///< only for loads on faces
  NodeSelection nodes;              ///< only for forces on nodes
  double from = 0., until = std::numeric_limits<double>::infinity();
  std::optional<double> fade_time; ///< none: automatic
  std::string origin;

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

/// Symmetry plane n · X = offset: boundary nodes on it stay on it.
struct SymmetryPlane {
  dealii::Tensor<1, 3> normal;
  double offset;
  std::string text;
  bool is_of_section = false; ///< a side of the layer or of the wedge
};

/// One named subsection of Bodies.
struct Body {
  std::string name;
  std::string origin;
  Mesh mesh;
  Material material;
  Located<ElementChoice> element;
  std::vector<Support> supports;
  std::vector<Load> loads;
  Located<std::array<std::string, 3>> initial_velocity; ///< expressions of x, y, z
  Located<std::vector<SymmetryPlane>> symmetry_planes;
  /// Viscous forces stabilise it until contact supports it.
  Located<bool> is_stabilised;
  /// > 0, ascending; each element is divided there [time].
  Located<std::vector<double>> refinement_times;

  static void declare(dealii::ParameterHandler &prm, const std::vector<std::string> &support_names,
                      const std::vector<std::string> &load_names);
  void parse(Reader &reader);
};

} // namespace billet::parameters

#endif
