// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PROBES_PROBE_H
#define BILLET_PROBES_PROBE_H

#include "billet/geometry/axes.h"
#include "billet/registered_type.h"

#include <deal.II/base/point.h>

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace billet {

/// Quantity of the deformed bodies that a probe reads.
struct ProbeQuantity {
  enum class Kind { displacement, velocity, position, stress, strain, plastic_strain, contact_pressure };

  Kind kind;
  std::string name;
  std::vector<std::string> components; ///< their names in columns

  /// Whether it is known at nodes; otherwise it is known in each element.
  bool is_nodal() const {
    return kind == Kind::displacement || kind == Kind::velocity || kind == Kind::position ||
           kind == Kind::contact_pressure;
  }
};

const std::vector<ProbeQuantity> &probe_quantities();

/// Selection or statistic that a probe writes of the values at its sites.
enum class ProbeStatistic { each, least, largest, mean, sum };

/// Points of a body, which move with it or stay in space.
struct ProbedPoints {
  enum class Place { material, nearest_node, space };

  std::vector<dealii::Point<3>> points; ///< undeformed, or in space
  Place place;
};

/// Faces of the probe's boundary ids, with their nodes.
struct ProbedFaces {};

/// Distance from faces to the opposite ones, along their inward normals. It is taken at the middle
/// of each face, or at the point of the faces that was nearest to `point` before the deformation.
struct ProbedThickness {
  std::optional<dealii::Point<3>> point;
};

/// Travel of nodes in the plane of a sheet: along a direction, or towards a centre.
struct ProbedTravel {
  dealii::Tensor<1, 3> normal;                   ///< unit vector
  std::optional<dealii::Tensor<1, 3>> direction; ///< unit vector in the plane
  dealii::Tensor<1, 3> centre;                   ///< if there is no direction

  /// Returns the travel of a node from X to x.
  double travel(const dealii::Tensor<1, 3> &from, const dealii::Tensor<1, 3> &to) const {
    if (direction)
      return *direction * (to - from);
    return in_plane(from - centre).norm() - in_plane(to - centre).norm();
  }

private:
  dealii::Tensor<1, 3> in_plane(const dealii::Tensor<1, 3> &vector) const {
    return vector - (normal * vector) * normal;
  }
};

/// Ratio of two energies of the whole scene.
struct ProbedEnergies {
  enum class Numerator { kinetic, hourglass, contact, friction, plastic, drift };
  enum class Denominator { internal, external, total };

  Numerator numerator;
  Denominator denominator;
};

/// Motion and energies of a whole body.
struct ProbedMotion {};

/// Quantities that are read, and their places. The values are columns of the history.
struct Probe {
  std::variant<ProbedPoints, ProbedFaces, ProbedThickness, ProbedTravel, ProbedEnergies, ProbedMotion> where;
  std::vector<ProbeQuantity> quantities = {};  ///< only of points and faces
  std::vector<ProbeStatistic> statistics = {}; ///< of what has sites
  Axes axes = {};           ///< of the components of displacement, velocity, stress and strain
  bool names_sites = false; ///< whether `each` numbers its columns

  bool reads(ProbeQuantity::Kind kind) const;
  /// Whether it reads the faces of 'Boundary ids'.
  bool has_faces() const;
  bool has_body() const { return !std::holds_alternative<ProbedEnergies>(where); }
  /// Returns the names of the values at one site.
  std::vector<std::string> components() const;
  /// Returns the names of its columns.
  std::vector<std::string> columns() const;
};

/// Weights of the sites in means.
struct SiteWeights {
  std::vector<double> all; ///< of each site
  /// Area of each site, for contact pressures [length²]; empty: `all`.
  std::vector<double> contact_areas;
};

/// Returns the columns' values from those at the sites, one for each component. The mean of a
/// contact pressure is the force over the area in contact; 0 without contact. Values that are not
/// numbers, where there is nothing to read, count in no statistic. If there are no others, it is
/// not a number itself.
std::vector<double> evaluate_columns(const Probe &probe, const std::vector<std::vector<double>> &values,
                                     const SiteWeights &weights);

/// Probes that scene files can name. A new one is a file in source/probes/ with a function that
/// returns its type, and its name in the table of probe_types.cc.
using ProbeType = RegisteredType<Probe>;
TypeTable<Probe> &probe_types();

/// Parameters that types share. The scene reads those of the body and of faces.
TypeParameter probed_body();
TypeParameter probed_faces();
TypeParameter probed_point();
TypeParameter probed_place();
TypeParameter probed_quantities();
TypeParameter probed_statistics();
/// Adds the parameters of Axes.
std::vector<TypeParameter> with_probed_axes(std::vector<TypeParameter> parameters);

/// Return the values of these parameters.
ProbedPoints::Place read_place(const TypeInput &input);
std::vector<ProbeQuantity> read_quantities(const TypeInput &input);
/// `may_list_sites`: whether 'each' is allowed.
std::vector<ProbeStatistic> read_statistics(const TypeInput &input, bool may_list_sites);

} // namespace billet

#endif
