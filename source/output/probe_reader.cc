// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/probe_reader.h"

#include "billet/algebra/gather.h"
#include "billet/discretization/node_keys.h"
#include "billet/discretization/point_location.h"
#include "billet/errors.h"
#include "billet/mechanics/element_mass.h"
#include "billet/mechanics/hexahedron.h"
#include "billet/output/contact_fields.h"
#include "billet/output/element_fields.h"
#include "billet/output/local_state.h"
#include "billet/output/probe_geometry.h"
#include "billet/solve/element_points.h"

#include <deal.II/base/geometry_info.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <sstream>
#include <unordered_map>

namespace billet {

using dealii::Tensor;
using Kind = ProbeQuantity::Kind;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<double, 2> middle{0.5, 0.5};
/// Distance from nodes and faces that counts as near them [scene's radius].
constexpr double near = 0.1;

/// Material point in an owned element.
struct MaterialPoint {
  std::uint64_t number; ///< in the probe
  std::uint64_t key;    ///< of the element
  std::size_t element;
  dealii::Point<3> coordinates;
};

/// Node of an owned element.
struct ProbedNode {
  std::array<DofIndex, 3> dofs;
  std::uint64_t key;
  double weight; ///< share of the undeformed faces [length²]
  Tensor<1, 3> position;
};

/// Face of an owned element.
struct ProbedFace {
  BoundaryFacet facet;
  std::size_t element;
  std::array<double, 2> at; ///< where the thickness is measured
};

std::array<DofIndex, 3> dofs_of(const Element &element, const unsigned int node) {
  return {element.dofs[std::size_t{3} * node], element.dofs[std::size_t{3} * node + 1],
          element.dofs[std::size_t{3} * node + 2]};
}

/// Returns the middle of a face in the coordinates of its element, from 0 to 1.
dealii::Point<3> middle_of(const BoundaryFacet &facet) {
  const auto face = static_cast<unsigned int>(facet.key % dealii::GeometryInfo<3>::faces_per_cell);
  dealii::Point<3> coordinates(0.5, 0.5, 0.5);
  coordinates[face / 2] = face % 2;
  return coordinates;
}

FacetCorners undeformed_corners(const BoundaryFacet &facet) {
  FacetCorners corners;
  for (unsigned int a = 0; a < 4; ++a)
    corners[a] = facet.corners[a];
  return corners;
}

void append(const std::vector<double> &more, std::vector<double> &values) {
  values.insert(values.end(), more.begin(), more.end());
}

/// Appends what a quantity of nodes writes of its vector at this undeformed position.
void append(const Kind kind, const Tensor<1, 3> &vector, const Axes &axes, const Tensor<1, 3> &position,
            std::vector<double> &values) {
  if (kind == Kind::contact_pressure) {
    values.push_back(vector[0]);
    return;
  }
  if (kind == Kind::position) {
    values.insert(values.end(), {vector[0], vector[1], vector[2]});
    return;
  }
  const Tensor<1, 3> components = axes.from_global(vector, position);
  values.insert(values.end(), {components[0], components[1], components[2], vector.norm()});
}

/// Appends what a quantity of elements writes of a state. `centre`: of the undeformed element,
/// where cylindrical axes are taken, since the stress of a brick does not turn about their line
/// within it.
void append(const Kind kind, const LocalState &state, const Axes &axes, const Tensor<1, 3> &centre,
            std::vector<double> &values) {
  if (kind == Kind::strain)
    append(list_components(axes.from_global(state.strain, centre)), values);
  else if (kind == Kind::plastic_strain)
    values.push_back(state.equivalent_plastic_strain);
  else
    append(list_stress(state.cauchy_stress, axes.from_global(state.cauchy_stress, centre)), values);
}

double denominator_of(const ProbedEnergies &of, const EnergyLedger &energies) {
  switch (of.denominator) {
  case ProbedEnergies::Denominator::internal:
    return energies.of_elements();
  case ProbedEnergies::Denominator::external:
    return energies.external;
  case ProbedEnergies::Denominator::total:
    break;
  }
  return energies.total();
}

double energy_ratio(const ProbedEnergies &of, const EnergyLedger &energies) {
  using Numerator = ProbedEnergies::Numerator;
  const double below = denominator_of(of, energies);
  if (!(below > 0.))
    return 0.;
  switch (of.numerator) {
  case Numerator::kinetic:
    return energies.kinetic / below;
  case Numerator::hourglass:
    return energies.hourglass / below;
  case Numerator::contact:
    return energies.contact / below;
  case Numerator::friction:
    return energies.friction / below;
  case Numerator::plastic:
    return energies.plastic / below;
  case Numerator::drift:
    break;
  }
  return energies.drift() / below;
}

} // namespace

/// A probe with what this rank has of its sites.
struct ProbeReader::Placed {
  const parameters::Probe &input;
  std::size_t body;
  std::vector<MaterialPoint> points = {};
  std::vector<ProbedNode> nodes = {};
  std::vector<ProbedFace> faces = {};
  std::vector<BoundaryFacet> opposite = {};

  const Probe &probe() const { return input.probe; }
};

/// State that is read: what several probes need of it is computed once.
class ProbeReader::State {
public:
  /// Collective.
  State(const Scene &scene, const Solution &solution)
      : solution_(solution), discretization_(solution.discretization()),
        summaries_(discretization_.n_bodies()), points_(discretization_.n_bodies()) {
    const auto &probes = scene.parameters().probes;
    if (std::any_of(probes.begin(), probes.end(),
                    [](const parameters::Probe &probe) { return probe.probe.reads(Kind::contact_pressure); }))
      contact_ = collect_contact_fields(discretization_, solution);
    std::set<std::size_t> bodies, bodies_of_points;
    for (const parameters::Probe &probe : probes) {
      const bool reads_points = probe.probe.reads(Kind::stress) || probe.probe.reads(Kind::strain) ||
                                probe.probe.reads(Kind::plastic_strain);
      const std::size_t body = probe.probe.has_body() ? scene.parameters().body_index(probe) : 0;
      if (reads_points)
        bodies_of_points.insert(body);
      if (reads_points || std::holds_alternative<ProbedMotion>(probe.probe.where))
        bodies.insert(body);
    }
    const auto *has_points = dynamic_cast<const HasElementPoints *>(&solution);
    for (const std::size_t body : bodies)
      summaries_[body] = solution.summarize(body);
    for (const std::size_t body : bodies_of_points)
      if (has_points != nullptr)
        points_[body] = has_points->element_points(body);
    for (const Body &body : scene.bodies())
      local_states_.emplace_back(body.law, body.formulation);
  }

  const EnergyLedger &energies() const { return solution_.state().energies; }
  const Vector &velocities() const { return solution_.state().velocities; }

  /// Returns the energy in the elements of a body on this rank.
  double internal_energy(const std::size_t body) const {
    double sum = 0.;
    for (const ElementSummary &summary : summaries_[body])
      sum += summary.elastic_energy + summary.plastic_work + summary.hourglass_energy;
    return sum;
  }

  /// Returns the area in contact of a node.
  double contact_area(const std::array<DofIndex, 3> &dofs) const { return contact_[1](dofs[1]); }

  Tensor<1, 3> displacement(const std::array<DofIndex, 3> &dofs) const {
    return get(solution_.state().displacements, dofs);
  }

  ElementVectors deformed_corners(const Element &element) const {
    ElementVectors corners = nodal_positions(element.cell);
    const ElementVectors displacements = gather(solution_.state().displacements, element.dofs);
    for (unsigned int i = 0; i < n_element_dofs; ++i)
      corners[i] += displacements[i];
    return corners;
  }

  FacetCorners deformed_corners(const BoundaryFacet &facet) const {
    FacetCorners corners = undeformed_corners(facet);
    for (unsigned int a = 0; a < 4; ++a)
      corners[a] += displacement(facet.dofs[a]);
    return corners;
  }

  /// Returns the vector of a quantity of nodes; of scalars in its first component.
  Tensor<1, 3> at_node(const Kind kind, const std::array<DofIndex, 3> &dofs,
                       const Tensor<1, 3> &position) const {
    switch (kind) {
    case Kind::velocity:
      return get(solution_.state().velocities, dofs);
    case Kind::position:
      return position + displacement(dofs);
    case Kind::contact_pressure:
      return Tensor<1, 3>({contact_[0](dofs[0]), 0., 0.});
    case Kind::displacement:
    case Kind::stress:
    case Kind::strain:
    case Kind::plastic_strain:
      break;
    }
    return displacement(dofs);
  }

  /// Returns stress and strains in an element, at coordinates from 0 to 1.
  LocalState local_state(const std::size_t body, const std::size_t e,
                         const dealii::Point<3> &coordinates) const {
    const Element &element = discretization_.elements(body)[e];
    return local_states_[body].evaluate(
        {nodal_positions(element.cell), gather(solution_.state().displacements, element.dofs),
         summaries_[body][e], points_[body].empty() ? nullptr : &points_[body][e]},
        coordinates);
  }

  /// Returns the coordinates of a point of an element moved onto the exterior face on which it is.
  /// The face may be less than a hundredth of the element away. Returns none inside the body. A
  /// node keeps its place.
  static std::optional<dealii::Point<3>> on_surface(const Element &element,
                                                    const dealii::Point<3> &coordinates) {
    constexpr double near = 0.01, at_node = 1e-9;
    bool is_node = true;
    for (unsigned int i = 0; i < 3; ++i)
      is_node = is_node && std::min(std::abs(coordinates[i]), std::abs(1. - coordinates[i])) < at_node;
    if (is_node)
      return coordinates;
    for (const unsigned int f : element.cell->face_indices()) {
      dealii::Point<3> moved = coordinates;
      moved[f / 2] = f % 2;
      if (element.cell->face(f)->at_boundary() && moved.distance(coordinates) < near)
        return moved;
    }
    return std::nullopt;
  }

  /// Returns the values of all quantities at a point of an element.
  std::vector<double> at_point(const Probe &probe, const std::size_t body, const std::size_t e,
                               const dealii::Point<3> &coordinates) const {
    const Element &element = discretization_.elements(body)[e];
    const auto interpolate = [](const dealii::Point<3> &at, const auto &value) {
      Tensor<1, 3> sum;
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        sum += dealii::GeometryInfo<3>::d_linear_shape_function(at, a) * value(a);
      return sum;
    };
    const Tensor<1, 3> position =
        interpolate(coordinates, [&](const unsigned int a) { return Tensor<1, 3>(element.cell->vertex(a)); });
    const bool has_state = std::any_of(probe.quantities.begin(), probe.quantities.end(),
                                       [](const ProbeQuantity &quantity) { return !quantity.is_nodal(); });
    const LocalState local = has_state ? local_state(body, e, coordinates) : LocalState();
    std::vector<double> values;
    for (const ProbeQuantity &quantity : probe.quantities) {
      if (!quantity.is_nodal()) {
        append(quantity.kind, local, probe.axes, element.cell->center(), values);
        continue;
      }
      // The nodes of a face have contact pressures, and those below it zeros that mean nothing.
      const std::optional<dealii::Point<3>> at =
          quantity.kind == Kind::contact_pressure ? on_surface(element, coordinates) : coordinates;
      const Tensor<1, 3> vector = !at ? Tensor<1, 3>() : interpolate(*at, [&](const unsigned int a) {
        return at_node(quantity.kind, dofs_of(element, a), element.cell->vertex(a));
      });
      append(quantity.kind, vector, probe.axes, position, values);
    }
    return values;
  }

private:
  static Tensor<1, 3> get(const Vector &vector, const std::array<DofIndex, 3> &dofs) {
    return Tensor<1, 3>({vector(dofs[0]), vector(dofs[1]), vector(dofs[2])});
  }

  const Solution &solution_;
  const Discretization &discretization_;
  std::vector<std::vector<ElementSummary>> summaries_; ///< of bodies whose stresses are read
  std::vector<std::vector<ElementPoints>> points_;     ///< of the same
  std::vector<LocalStates> local_states_;              ///< by body
  std::array<Vector, 3> contact_;                      ///< only if pressures are read
};

ProbeReader::ProbeReader(const Scene &scene, const Discretization &discretization)
    : scene_(scene), discretization_(discretization) {
  for (const auto &probe : scene.parameters().probes) {
    probes_.push_back(std::make_unique<Placed>(Placed{probe, scene.parameters().body_index(probe)}));
    Placed &placed = *probes_.back();
    const auto *points = std::get_if<ProbedPoints>(&probe.probe.where);
    if (points != nullptr && points->place != ProbedPoints::Place::space)
      place_points(placed);
    if (probe.probe.has_faces())
      place_faces(placed);
    if (std::holds_alternative<ProbedThickness>(probe.probe.where))
      place_thickness(placed);
  }
}

ProbeReader::~ProbeReader() = default;

namespace {

/// Returns the coordinates of the point of a facet that is nearest to x. Exact if the facet is a
/// plane rectangle, or if the point is not on its edge.
std::array<double, 2> nearest_on_facet(const FacetCorners &corners, const Tensor<1, 3> &x) {
  std::array<double, 2> at = middle;
  if (const auto crossing = cross_facet(corners, x, normal_of_facet(corners, middle)))
    for (unsigned int i = 0; i < 2; ++i)
      at[i] = std::clamp(crossing->at[i], 0., 1.);
  return at;
}

} // namespace

void ProbeReader::place_points(Placed &placed) const {
  const auto &[points, place] = std::get<ProbedPoints>(placed.probe().where);
  const auto located =
      locate_points(discretization_, placed.body,
                    {points, place == ProbedPoints::Place::nearest_node, scene_.bodies()[placed.body].name,
                     placed.input.origin, "are points of the body, or 'Place = nearest node' or 'space'"});
  for (std::size_t p = 0; p < points.size(); ++p)
    if (const auto &point = located[p])
      placed.points.push_back({p, point->key, point->element, point->coordinates});
}

void ProbeReader::place_faces(Placed &placed) const {
  const auto &elements = discretization_.elements(placed.body);
  std::unordered_map<std::uint64_t, std::size_t> element_of_key;
  for (std::size_t e = 0; e < elements.size(); ++e)
    element_of_key[element_key(elements[e].cell)] = e;
  ProbeRows rows(0);
  std::unordered_map<std::uint64_t, ProbedNode> nodes;
  const NodeKeys keys(discretization_);
  for (const BoundaryFacet &facet :
       collect_boundary_facets(discretization_, placed.body, placed.input.boundary_ids.value)) {
    placed.faces.push_back(
        {facet, element_of_key.at(facet.key / dealii::GeometryInfo<3>::faces_per_cell), middle});
    const std::array<double, 4> areas = facet.corner_areas();
    for (unsigned int a = 0; a < 4; ++a) {
      const std::uint64_t key = keys(facet.dofs[a][0]);
      nodes[key] = {facet.dofs[a], key, 0., facet.corners[a]};
      rows.add(key, facet.key, areas[a], {});
    }
  }
  for (const auto &row : rows.gather(discretization_.communicator(), ProbeRows::Weights::added)) {
    const auto node = nodes.find(row.site);
    if (node == nodes.end())
      continue;
    node->second.weight = row.weight;
    placed.nodes.push_back(node->second);
  }
}

void ProbeReader::place_thickness(Placed &placed) const {
  placed.opposite = collect_boundary_facets(discretization_, placed.body, placed.input.opposite_ids.value);
  const auto &point = std::get<ProbedThickness>(placed.probe().where).point;
  if (!point)
    return;
  // The nearest of all faces stays, with its nearest point.
  ProbeRows rows(1);
  for (ProbedFace &face : placed.faces) {
    const FacetCorners corners = undeformed_corners(face.facet);
    face.at = nearest_on_facet(corners, *point);
    rows.add(face.facet.key, 0, 1., {(point_of_facet(corners, face.at) - *point).norm()});
  }
  const auto all = rows.gather(discretization_.communicator());
  const auto nearest = std::min_element(
      all.begin(), all.end(), [](const auto &a, const auto &b) { return a.values[0] < b.values[0]; });
  if (nearest == all.end() || nearest->values[0] > near * discretization_.radius()) {
    std::ostringstream message;
    message << placed.input.origin << ": the point (" << *point << ") is at a distance of "
            << (nearest == all.end() ? 0. : nearest->values[0])
            << " from the faces of 'Boundary ids'; allowed is at most a tenth of the scene's radius, "
            << near * discretization_.radius();
    throw InputError(message.str());
  }
  const std::uint64_t key = nearest->site;
  placed.faces.erase(std::remove_if(placed.faces.begin(), placed.faces.end(),
                                    [key](const ProbedFace &face) { return face.facet.key != key; }),
                     placed.faces.end());
}

ProbeRows ProbeReader::read_points(const Placed &placed, const State &state) const {
  ProbeRows rows(placed.probe().components().size());
  for (const MaterialPoint &point : placed.points)
    rows.add(point.number, point.key, 1.,
             state.at_point(placed.probe(), placed.body, point.element, point.coordinates));
  return rows;
}

ProbeRows ProbeReader::read_space(const Placed &placed, const State &state) const {
  const auto &points = std::get<ProbedPoints>(placed.probe().where).points;
  const auto &elements = discretization_.elements(placed.body);
  ProbeRows rows(placed.probe().components().size());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const Hexahedron hexahedron(state.deformed_corners(elements[e]));
    for (std::size_t p = 0; p < points.size(); ++p)
      if (const auto coordinates = hexahedron.find(points[p]))
        rows.add(p, element_key(elements[e].cell), 1.,
                 state.at_point(placed.probe(), placed.body, e, *coordinates));
  }
  return rows;
}

ProbeRows ProbeReader::read_nodes(const Placed &placed, const State &state) const {
  const bool has_pressure = placed.probe().reads(Kind::contact_pressure);
  ProbeRows rows(placed.probe().components().size() + (has_pressure ? 1 : 0));
  for (const ProbedNode &node : placed.nodes) {
    std::vector<double> values;
    for (const ProbeQuantity &quantity : placed.probe().quantities)
      append(quantity.kind, state.at_node(quantity.kind, node.dofs, node.position), placed.probe().axes,
             node.position, values);
    if (has_pressure)
      values.push_back(state.contact_area(node.dofs));
    rows.add(node.key, 0, node.weight, values);
  }
  return rows;
}

ProbeRows ProbeReader::read_faces(const Placed &placed, const State &state) const {
  ProbeRows rows(placed.probe().components().size());
  for (const ProbedFace &face : placed.faces) {
    const LocalState local = state.local_state(placed.body, face.element, middle_of(face.facet));
    std::vector<double> values;
    for (const ProbeQuantity &quantity : placed.probe().quantities)
      append(quantity.kind, local, placed.probe().axes,
             discretization_.elements(placed.body)[face.element].cell->center(), values);
    rows.add(face.facet.key, 0, face.facet.area_vector().norm(), values);
  }
  return rows;
}

ProbeRows ProbeReader::read_thickness(const Placed &placed, const State &state) const {
  std::vector<double> own;
  for (const BoundaryFacet &facet : placed.opposite)
    for (const Tensor<1, 3> &corner : state.deformed_corners(facet))
      own.insert(own.end(), {corner[0], corner[1], corner[2]});
  struct Opposite {
    FacetCorners corners;
    Tensor<1, 3> centre;
    double square; ///< of the radius
  };
  constexpr std::size_t n_numbers = 12;
  std::vector<Opposite> opposite;
  for (const auto &numbers : all_gather(discretization_.communicator(), own))
    for (std::size_t first = 0; first + n_numbers <= numbers.size(); first += n_numbers) {
      Opposite facet{};
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int i = 0; i < 3; ++i)
          facet.corners[a][i] = numbers[first + 3 * a + i];
      facet.centre = point_of_facet(facet.corners, middle);
      for (const Tensor<1, 3> &corner : facet.corners)
        facet.square = std::max(facet.square, (corner - facet.centre).norm_square());
      opposite.push_back(facet);
    }
  constexpr double margin = 1.001; // for round-off
  ProbeRows rows(1);
  for (const ProbedFace &face : placed.faces) {
    const FacetCorners corners = state.deformed_corners(face.facet);
    const Tensor<1, 3> x = point_of_facet(corners, face.at), inward = -normal_of_facet(corners, face.at);
    double least = nan;
    for (const Opposite &facet : opposite) {
      const Tensor<1, 3> to_centre = facet.centre - x;
      const double along = to_centre * inward;
      if (to_centre.norm_square() - along * along > margin * facet.square)
        continue;
      const auto crossing = cross_facet(facet.corners, x, inward);
      if (crossing && crossing->is_on_facet() && crossing->distance > 0. &&
          (std::isnan(least) || crossing->distance < least))
        least = crossing->distance;
    }
    rows.add(face.facet.key, 0, face.facet.area_vector().norm(), {least});
  }
  return rows;
}

ProbeRows ProbeReader::read_travel(const Placed &placed, const State &state) const {
  const auto &travel = std::get<ProbedTravel>(placed.probe().where);
  ProbeRows rows(1);
  for (const ProbedNode &node : placed.nodes)
    rows.add(node.key, 0, node.weight,
             {travel.travel(node.position, node.position + state.displacement(node.dofs))});
  return rows;
}

std::vector<double> ProbeReader::read_motion(const Placed &placed, const State &state) const {
  const double density = scene_.bodies()[placed.body].density;
  const bool is_lumped =
      scene_.parameters().scheme().lumps_mass ||
      scene_.parameters().implicit_dynamics.mass == parameters::ImplicitDynamics::Mass::lumped;
  std::vector<double> sums(6, 0.); // momentum, mass, kinetic and internal energy
  sums[5] = state.internal_energy(placed.body);
  if (state.velocities().size() > 0)
    for (const Element &element : discretization_.elements(placed.body)) {
      ReferenceElement reference{};
      compute_reference_element(nodal_positions(element.cell), reference);
      ElementMass mass = compute_element_mass(reference, density);
      if (is_lumped)
        lump(mass);
      const ElementVectors v = gather(state.velocities(), element.dofs);
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        for (unsigned int b = 0; b < n_element_nodes; ++b) {
          const double m = mass[std::size_t{n_element_nodes} * a + b];
          sums[3] += m;
          for (unsigned int i = 0; i < 3; ++i) {
            sums[i] += m * v[3 * b + i];
            sums[4] += 0.5 * m * v[3 * a + i] * v[3 * b + i];
          }
        }
    }
  dealii::Utilities::MPI::sum(sums, discretization_.communicator(), sums);
  std::vector<double> values;
  for (unsigned int i = 0; i < 3; ++i)
    values.push_back(sums[3] > 0. ? sums[i] / sums[3] : 0.);
  values.insert(values.end(), {sums[0], sums[1], sums[2], sums[4], sums[5]});
  return values;
}

std::vector<double> ProbeReader::read(const ProbedPoints &points, const Placed &placed,
                                      const State &state) const {
  const Probe &probe = placed.probe();
  // A point in space at which there is nothing has no row.
  std::vector<std::vector<double>> values(points.points.size(),
                                          std::vector<double>(probe.components().size(), nan));
  const ProbeRows rows =
      points.place == ProbedPoints::Place::space ? read_space(placed, state) : read_points(placed, state);
  for (auto &row : rows.gather(discretization_.communicator()))
    values[row.site] = std::move(row.values);
  SiteWeights weights;
  weights.all.assign(points.points.size(), 1.);
  return evaluate_columns(probe, values, weights);
}

std::vector<double> ProbeReader::evaluate(const Placed &placed, const ProbeRows &rows) const {
  const Probe &probe = placed.probe();
  std::vector<std::vector<double>> values;
  SiteWeights weights;
  for (auto &row : rows.gather(discretization_.communicator())) {
    if (row.values.size() > probe.components().size()) {
      weights.contact_areas.push_back(row.values.back());
      row.values.pop_back();
    }
    values.push_back(std::move(row.values));
    weights.all.push_back(row.weight);
  }
  return evaluate_columns(probe, values, weights);
}

std::vector<double> ProbeReader::read(const ProbedFaces &, const Placed &placed, const State &state) const {
  return evaluate(placed, placed.probe().quantities.front().is_nodal() ? read_nodes(placed, state)
                                                                       : read_faces(placed, state));
}

std::vector<double> ProbeReader::read(const ProbedThickness &, const Placed &placed,
                                      const State &state) const {
  return evaluate(placed, read_thickness(placed, state));
}

std::vector<double> ProbeReader::read(const ProbedTravel &, const Placed &placed, const State &state) const {
  return evaluate(placed, read_travel(placed, state));
}

std::vector<double> ProbeReader::read(const ProbedEnergies &energies, const Placed &,
                                      const State &state) const {
  return {energy_ratio(energies, state.energies())};
}

std::vector<double> ProbeReader::read(const ProbedMotion &, const Placed &placed, const State &state) const {
  return read_motion(placed, state);
}

std::vector<double> ProbeReader::read(const Placed &placed, const State &state) const {
  return std::visit([&](const auto &place) { return read(place, placed, state); }, placed.probe().where);
}

std::vector<double> ProbeReader::read(const Solution &solution) const {
  std::vector<double> values;
  if (empty())
    return values;
  const State state(scene_, solution);
  for (const auto &placed : probes_)
    for (const double value : read(*placed, state))
      values.push_back(value);
  return values;
}

std::vector<std::string> probe_columns(const Scene &scene) {
  std::vector<std::string> columns;
  for (const auto &probe : scene.parameters().probes)
    for (const std::string &column : probe.probe.columns())
      columns.push_back(probe.full_name(column));
  return columns;
}

} // namespace billet
