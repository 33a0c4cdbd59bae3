// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/forces/external_loads.h"

#include "billet/discretization/point_location.h"
#include "billet/errors.h"
#include "billet/fail_together.h"
#include "billet/forces/selected_nodes.h"
#include "billet/forces/surface_coupling.h"
#include "billet/geometry/facet_point.h"
#include "billet/loads/node_site.h"
#include "billet/mechanics/element_mass.h"
#include "billet/scene/section_geometry.h"
#include "billet/usage.h"

#include <deal.II/base/geometry_info.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace billet {

using dealii::Point;
using dealii::Tensor;

namespace {

std::array<unsigned int, 4> local_corners(const BoundaryFacet &facet, const LocalNodes &nodes) {
  std::array<unsigned int, 4> corners{};
  for (unsigned int a = 0; a < 4; ++a)
    corners[a] = nodes.find(facet.dofs[a][0]);
  return corners;
}

Point<3> centre_of(const BoundaryFacet &facet) {
  Point<3> centre;
  for (const auto &corner : facet.corners)
    centre += 0.25 * corner;
  return centre;
}

/// Returns the time of a load's values at time t: after 'Until' they keep those of that time, and
/// fade.
double time_of_values(const AppliedLoad &load, const double t) { return std::min(t, load.times.until); }

bool are_uniform(const std::vector<Expression> &expressions) {
  return std::all_of(expressions.begin(), expressions.end(),
                     [](const Expression &value) { return value.is_uniform(); });
}

/// Returns the position of a point of a face; position(a) is that of corner a.
template <class Position> Point<3> place_of(const FacetPoint &point, const Position &position) {
  Tensor<1, 3> place;
  for (unsigned int a = 0; a < 4; ++a)
    place += point.N[a] * position(a);
  return Point<3>(place);
}

/// Returns the values of the expressions at the facet_points() of faces, one set after the other
/// for each face. Returns only those of one face for uniform expressions.
LoadValues evaluate_at_points(const AppliedLoad &load, const double time,
                              const std::vector<LoadedFace> &faces, const double *positions) {
  const double t = time_of_values(load, time);
  const auto &expressions = load.expressions;
  const std::size_t n = expressions.size(), n_points = facet_points().size();
  const bool is_uniform = are_uniform(expressions);
  const std::size_t n_sets = is_uniform ? 1 : faces.size();
  LoadValues values(n_points * n, n_sets, is_uniform);
  for (std::size_t f = 0; f < n_sets; ++f)
    for (std::size_t q = 0; q < n_points; ++q)
      for (std::size_t i = 0; i < n; ++i)
        values.at(f)[q * n + i] =
            is_uniform ? expressions[i].value(t)
                       : expressions[i].value(t, place_of(facet_points()[q], [&](const unsigned int a) {
                                                return get_vector(positions, faces[f].nodes[a]);
                                              }));
  return values;
}

/// Returns the values of the expressions at sites; only one set for uniform expressions.
template <class Site>
LoadValues evaluate(const AppliedLoad &load, const double time, const std::vector<Site> &sites) {
  const double t = time_of_values(load, time);
  const auto &expressions = load.expressions;
  const bool is_uniform = are_uniform(expressions);
  const std::size_t n_sets = is_uniform ? 1 : sites.size();
  LoadValues values(expressions.size(), n_sets, is_uniform);
  for (std::size_t k = 0; k < n_sets; ++k)
    for (std::size_t i = 0; i < expressions.size(); ++i)
      values.at(k)[i] = is_uniform ? expressions[i].value(t) : expressions[i].value(t, sites[k].centre);
  return values;
}

std::vector<double> values_of(const AppliedLoad &load, const double t) {
  std::vector<double> values;
  for (const Expression &expression : load.expressions)
    values.push_back(expression.value(time_of_values(load, t)));
  return values;
}

/// Calls visit(node, its share of the site) for the nodes of a site.
template <class Visit> void visit_nodes(const LoadedFace &face, const Visit &visit) {
  for (unsigned int a = 0; a < 4; ++a)
    visit(face.nodes[a], face.areas[a]);
}
template <class Visit> void visit_nodes(const LoadedNode &at, const Visit &visit) { visit(at.node, at.area); }
template <class Site, class Visit> void visit_nodes(const Site &at, const Visit &visit) {
  visit(at.node, at.weight);
}

template <class Placed> std::size_t memory_of(const std::vector<Placed> &loads) {
  std::size_t bytes = 0;
  for (const Placed &placed : loads)
    bytes += sizeof(placed) + placed.sites.size() * sizeof(placed.sites.front());
  return bytes;
}

/// Nodes that a load selects, of which this rank sums the forces.
struct OwnSelection {
  std::vector<unsigned int> nodes;
  double part; ///< of each in the load: one over the number on all ranks
  Tensor<1, 3> centre;
};

/// Collective.
OwnSelection find_selection(const AppliedLoad &load, const LocalNodes &nodes, const std::size_t body) {
  OwnSelection selection;
  std::vector<double> sums(4, 0.); // number, Σ x about the middle of the scene
  const Tensor<1, 3> &middle = nodes.discretization().centre();
  for (const SelectedNode &selected : collect_selected_nodes(load, nodes.discretization(), body)) {
    const unsigned int node = nodes.find(selected.dofs[0]);
    if (!nodes.is_owned(node))
      continue;
    selection.nodes.push_back(node);
    sums[0] += 1.;
    for (unsigned int i = 0; i < 3; ++i)
      sums[1 + i] += selected.position[i] - middle[i];
  }
  dealii::Utilities::MPI::sum(sums, nodes.discretization().communicator(), sums);
  selection.part = 1. / sums[0];
  selection.centre = middle + selection.part * Tensor<1, 3>({sums[1], sums[2], sums[3]});
  return selection;
}

/// Returns the surface that selected nodes stand for; their parts stand for areas.
std::unique_ptr<LoadedSurface> whole_of(const OwnSelection &selection) {
  auto whole = std::make_unique<LoadedSurface>();
  whole->area = 1.;
  whole->centre = selection.centre;
  return whole;
}

/// Refuses a moment on nodes on one line, or on one node. Their forces have no moment about the
/// line, and how they turn about it is unknown.
void check_spread(const AppliedLoad &load) {
  constexpr double least = 1e-3; // distance from the line, in parts of the length along it
  const auto points = load.nodes->points();
  Tensor<1, 3> centre, far;
  for (const auto &point : points)
    centre += point / static_cast<double>(points.size());
  for (const auto &point : points)
    if ((point - centre).norm() > far.norm())
      far = point - centre;
  double width = 0.;
  for (const auto &point : points)
    width = std::max(width, dealii::cross_product_3d(far, point - centre).norm());
  if (width > least * far.norm_square())
    return;
  const bool is_line = far.norm() > 0.;
  throw InputError(load.origin + ": the " + load.type + " acts on " +
                   (is_line ? "nodes on one line, whose forces have no moment about it"
                            : "one node, whose force has no moment about it") +
                   "; allowed are three nodes or more that are not on one line, or 'Boundary ids' of faces" +
                   (is_line ? ". For a moment across the line, two opposite loads 'Type = force' on its ends "
                              "make a couple"
                            : ""));
}

/// Adds a load's forces, which `add` adds to a vector, with its factor at time t.
template <class Add>
void add_with_factor(const AppliedLoad &load, const double t, NodalVectors &forces, const Add &add) {
  const double factor = load.times.factor(t);
  if (factor == 1.)
    add(forces.data());
  if (factor == 1. || factor == 0.)
    return;
  NodalVectors whole(forces.size(), 0.);
  add(whole.data());
  for (std::size_t i = 0; i < forces.size(); ++i)
    forces[i] += factor * whole[i];
}

} // namespace

ExternalLoads::ExternalLoads(const Scene &scene, const LocalNodes &nodes, std::vector<double> masses)
    : scene_(scene), nodes_(nodes), masses_(std::move(masses)) {
  for (std::size_t b = 0; b < scene.bodies().size(); ++b)
    for (const AppliedLoad &load : scene.bodies()[b].loads)
      std::visit([&](const auto &action) { place(load, *action, b); }, load.load.action);
  memory_.set(memory_of(on_bodies_) + memory_of(on_faces_) + memory_of(on_nodes_) + memory_of(on_surfaces_) +
              memory_of(on_points_));
  follow(nodes.make_vectors());
  // Detects expressions without a value before any output is written.
  fail_together(nodes.discretization().communicator(), [&] {
    check_before_start([&] {
      const NodalVectors at_rest = nodes.make_vectors();
      NodalVectors forces = at_rest;
      add_forces(0., at_rest, at_rest, forces);
    });
  });
}

ExternalLoads::~ExternalLoads() = default;

void ExternalLoads::place(const AppliedLoad &load, const BodyLoad &action, const std::size_t body) {
  std::vector<double> volumes(action.is_per_volume() ? masses_.size() : 0, 0.);
  std::vector<unsigned int> nodes;
  for (std::size_t e = 0; e < nodes_.elements(body).size(); ++e) {
    const auto &element = nodes_.elements(body)[e];
    nodes.insert(nodes.end(), element.begin(), element.end());
    if (!action.is_per_volume())
      continue;
    ReferenceElement reference{};
    compute_reference_element(nodal_positions(nodes_.discretization().elements(body)[e].cell), reference);
    const auto shares = compute_nodal_volumes(reference);
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      volumes[element[a]] += shares[a];
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  std::vector<WeightedNode> sites;
  for (const unsigned int node : nodes)
    sites.push_back({node, action.is_per_volume() ? volumes[node] : masses_[node]});
  on_bodies_.push_back({&load, &action, std::move(sites), nullptr});
}

std::unique_ptr<LoadedSurface>
ExternalLoads::measure_surface(const std::vector<BoundaryFacet> &facets) const {
  std::vector<double> sums(4, 0.); // area, ∫x dA
  // About the middle of the scene, so that a face far from the origin keeps its digits.
  const Tensor<1, 3> &middle = nodes_.discretization().centre();
  for (const BoundaryFacet &facet : facets) {
    const std::array<double, 4> areas = facet.corner_areas();
    for (unsigned int a = 0; a < 4; ++a) {
      sums[0] += areas[a];
      for (unsigned int i = 0; i < 3; ++i)
        sums[1 + i] += areas[a] * (facet.corners[a][i] - middle[i]);
    }
  }
  dealii::Utilities::MPI::sum(sums, nodes_.discretization().communicator(), sums);
  auto surface = std::make_unique<LoadedSurface>();
  surface->area = sums[0];
  surface->centre = middle + Tensor<1, 3>({sums[1], sums[2], sums[3]}) / sums[0];
  return surface;
}

void ExternalLoads::place(const AppliedLoad &load, const FaceLoad &action, const std::size_t body) {
  const auto facets = collect_boundary_facets(nodes_.discretization(), body, load.boundary_ids);
  auto surface = measure_surface(facets);
  std::vector<LoadedFace> faces;
  for (const auto &facet : facets)
    faces.push_back({local_corners(facet, nodes_), centre_of(facet), surface.get(), facet.corner_areas()});
  on_faces_.push_back({&load, &action, std::move(faces), std::move(surface)});
}

void ExternalLoads::place(const AppliedLoad &load, const NodalLoad &action, const std::size_t body) {
  if (load.nodes) {
    const OwnSelection selection = find_selection(load, nodes_, body);
    auto whole = whole_of(selection);
    std::vector<LoadedNode> sites;
    for (const unsigned int node : selection.nodes)
      sites.push_back(
          {node, selection.part, {}, Point<3>(get_vector(nodes_.positions().data(), node)), whole.get()});
    on_nodes_.push_back({&load, &action, std::move(sites), std::move(whole)});
    return;
  }
  const auto facets = collect_boundary_facets(nodes_.discretization(), body, load.boundary_ids);
  auto surface = measure_surface(facets);
  std::vector<LoadedNode> nodes;
  // Forces that depend on the place alone are integrated; those that resist motions are lumped at
  // the nodes.
  const bool is_integrated = action.tangent() == LoadTangent::none;
  for (const auto &facet : facets) {
    const auto corners = local_corners(facet, nodes_);
    const Tensor<1, 3> normal = facet.area_vector() / facet.area_vector().norm();
    const auto add = [&](const std::array<double, 4> &areas, const Point<3> &place) {
      for (unsigned int a = 0; a < 4; ++a)
        nodes.push_back({corners[a], areas[a], normal, place, surface.get()});
    };
    if (!is_integrated) {
      add(facet.corner_areas(), centre_of(facet));
      continue;
    }
    const auto corner = [&facet](const unsigned int a) { return Tensor<1, 3>(facet.corners[a]); };
    for (const FacetPoint &point : facet_points()) {
      const double whole = point.area_vector(corner).norm();
      std::array<double, 4> areas = point.N;
      for (double &area : areas)
        area *= whole;
      add(areas, place_of(point, corner));
    }
  }
  on_nodes_.push_back({&load, &action, std::move(nodes), std::move(surface)});
}

void ExternalLoads::place(const AppliedLoad &load, const SurfaceLoad &action, const std::size_t body) {
  if (load.nodes) {
    check_spread(load);
    const OwnSelection selection = find_selection(load, nodes_, body);
    auto whole = whole_of(selection);
    std::vector<LoadedFace> sites;
    for (const unsigned int node : selection.nodes)
      sites.push_back(make_node_site(node, Point<3>(get_vector(nodes_.positions().data(), node)), whole.get(),
                                     selection.part));
    on_surfaces_.push_back({&load, &action, std::move(sites), std::move(whole)});
    return;
  }
  const MPI_Comm communicator = nodes_.discretization().communicator();
  const auto facets = collect_boundary_facets(nodes_.discretization(), body, load.boundary_ids);
  auto surface = measure_surface(facets);
  const double n_faces = dealii::Utilities::MPI::sum(static_cast<double>(facets.size()), communicator);
  const double size = std::sqrt(surface->area / n_faces);
  surface->stiffness = scene_.bodies()[body].young_modulus / size;
  std::vector<LoadedFace> faces;
  for (const auto &facet : facets)
    faces.push_back({local_corners(facet, nodes_), centre_of(facet), surface.get(), facet.corner_areas()});
  on_surfaces_.push_back({&load, &action, std::move(faces), std::move(surface)});
}

ExternalLoads::TurnedNode ExternalLoads::turned_node(const unsigned int node, const double weight) const {
  if (scene_.whole_section().kind != WholeSection::Kind::full_circle)
    return {node, weight, dealii::unit_symmetric_tensor<3>()};
  const SectionGeometry section(scene_.parameters().bodies.front().mesh);
  return {node, weight, section.turn_to(get_vector(nodes_.positions().data(), node))};
}

void ExternalLoads::place_on_nodes(const AppliedLoad &load, const PointLoad &action, const std::size_t body) {
  const OwnSelection selection = find_selection(load, nodes_, body);
  std::vector<TurnedNode> sites;
  for (const unsigned int node : selection.nodes)
    sites.push_back(turned_node(node, selection.part));
  on_points_.push_back({&load, &action, std::move(sites), nullptr});
}

void ExternalLoads::place(const AppliedLoad &load, const PointLoad &action, const std::size_t body) {
  const std::optional<Point<3>> position = action.position();
  if (!position)
    return place_on_nodes(load, action, body);
  const auto located = locate_points(nodes_.discretization(), body,
                                     {{*position},
                                      action.takes_nearest_node(),
                                      scene_.bodies()[body].name,
                                      load.origin,
                                      "is a point of the body, or 'Place = nearest node'"});
  std::vector<TurnedNode> sites;
  const bool is_section =
      scene_.parameters().bodies[body].mesh.section.value != parameters::Mesh::Section::solid;
  if (const auto &point = located.front())
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const auto shape = [&](const unsigned int b) {
        return dealii::GeometryInfo<3>::d_linear_shape_function(point->coordinates, b);
      };
      // A point of a section is on both of its sides, which are the third axis of its bricks.
      const double weight = is_section ? 0.5 * (shape(a) + shape(a ^ 4U)) : shape(a);
      if (weight != 0.)
        sites.push_back(turned_node(nodes_.elements(body)[point->element][a], weight));
    }
  on_points_.push_back({&load, &action, std::move(sites), nullptr});
}

void ExternalLoads::follow(const NodalVectors &displacements) {
  const NodalMotion at{nodes_.positions().data(), displacements.data(), nullptr};
  for (const auto &placed : on_surfaces_)
    measure_motion(placed.sites, at, *placed.surface, [this](std::vector<double> &numbers) {
      dealii::Utilities::MPI::sum(numbers, nodes_.discretization().communicator(), numbers);
    });
}

void ExternalLoads::add(const Placed<BodyLoad, WeightedNode> &placed, const double t, const NodalMotion &,
                        NodalVectors &forces) const {
  add_with_factor(*placed.load, t, forces, [&](double *sum) {
    const Tensor<1, 3> a = placed.action->acceleration(values_of(*placed.load, t).data());
    for (const auto &[node, weight] : placed.sites)
      add_vector(sum, node, weight * a);
  });
}

void ExternalLoads::add(const Placed<FaceLoad, LoadedFace> &placed, const double t, const NodalMotion &at,
                        NodalVectors &forces) const {
  add_with_factor(*placed.load, t, forces, [&](double *sum) {
    placed.action->add_forces(placed.sites, evaluate_at_points(*placed.load, t, placed.sites, at.positions),
                              at, sum);
  });
}

void ExternalLoads::add(const Placed<NodalLoad, LoadedNode> &placed, const double t, const NodalMotion &at,
                        NodalVectors &forces) const {
  add_with_factor(*placed.load, t, forces, [&](double *sum) {
    placed.action->add_forces(placed.sites, evaluate(*placed.load, t, placed.sites), at, sum);
  });
}

void ExternalLoads::add(const Placed<SurfaceLoad, LoadedFace> &placed, const double t, const NodalMotion &,
                        NodalVectors &forces) const {
  add_with_factor(*placed.load, t, forces, [&](double *sum) {
    const LoadValues values = evaluate(*placed.load, t, placed.sites);
    for (std::size_t f = 0; f < placed.sites.size(); ++f) {
      const LoadedFace &face = placed.sites[f];
      for (unsigned int a = 0; a < 4; ++a)
        add_vector(sum, face.nodes[a],
                   placed.action->force(placed.surface->shares[f][a], values.at(f), *placed.surface));
    }
  });
}

void ExternalLoads::add(const Placed<PointLoad, TurnedNode> &placed, const double t, const NodalMotion &,
                        NodalVectors &forces) const {
  add_with_factor(*placed.load, t, forces, [&](double *sum) {
    const Tensor<1, 3> force = placed.action->force(values_of(*placed.load, t).data());
    for (const auto &[node, weight, turn] : placed.sites)
      add_vector(sum, node, weight * (turn * force));
  });
}

void ExternalLoads::add_forces(const double t, const NodalVectors &displacements,
                               const NodalVectors &velocities, NodalVectors &forces) const {
  std::size_t n_loads = on_bodies_.size() + on_faces_.size() + on_surfaces_.size() + on_points_.size();
  for (const auto &placed : on_nodes_)
    n_loads += placed.sites.size();
  Usage::count_if(n_loads > 0, Capability::loads, n_loads);
  const NodalMotion at = motion(displacements, velocities);
  visit([&](const auto &placed) { add(placed, t, at, forces); });
}

void ExternalLoads::add_forces_of(const AppliedLoad &load, const double t, const NodalVectors &displacements,
                                  const NodalVectors &velocities, NodalVectors &forces) const {
  const NodalMotion at = motion(displacements, velocities);
  visit([&](const auto &placed) {
    if (placed.load != &load)
      return;
    Usage::count_if(!placed.sites.empty(), Capability::loads, 1);
    add(placed, t, at, forces);
  });
}

std::vector<unsigned int> ExternalLoads::nodes_of(const AppliedLoad &load) const {
  std::vector<unsigned int> nodes;
  visit([&](const auto &placed) {
    if (placed.load != &load)
      return;
    for (const auto &site : placed.sites)
      visit_nodes(site, [&nodes](const unsigned int node, double) { nodes.push_back(node); });
  });
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

void ExternalLoads::add_tangent(const double t, const NodalVectors &displacements,
                                const NodalVectors &velocities, const double damping_factor,
                                const TangentSystem &system) const {
  const NodalMotion at = motion(displacements, velocities);
  dealii::FullMatrix<double> of_face(12, 12), of_node(3, 3);
  std::vector<DofIndex> face_dofs(12), node_dofs(3);
  for (const auto &[load, action, faces, surface] : on_faces_) {
    const double factor = load->times.factor(t);
    if (action->tangent() == LoadTangent::none || factor == 0.)
      continue;
    const TangentSystem target{system.constraints, system.matrix, system.lift, factor * system.weight};
    const LoadValues values = evaluate_at_points(*load, t, faces, at.positions);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int i = 0; i < 3; ++i)
          face_dofs[3 * a + i] = nodes_.dofs(faces[f].nodes[a])[i];
      of_face = 0.;
      action->add_tangent(faces[f], values.at(f), at, damping_factor, of_face);
      target.add(of_face, face_dofs);
    }
  }
  for (const auto &[load, action, nodes, surface] : on_nodes_) {
    const double factor = load->times.factor(t);
    if (action->tangent() == LoadTangent::none || factor == 0.)
      continue;
    const TangentSystem target{system.constraints, system.matrix, system.lift, factor * system.weight};
    const LoadValues values = evaluate(*load, t, nodes);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      std::copy_n(nodes_.dofs(nodes[k].node).begin(), 3, node_dofs.begin());
      of_node = 0.;
      action->add_tangent(nodes[k], values.at(k), at, damping_factor, of_node);
      target.add(of_node, node_dofs);
    }
  }
  add_surface_tangents(t, at, system);
}

void ExternalLoads::add_surface_tangents(const double t, const NodalMotion &at,
                                         const TangentSystem &system) const {
  dealii::FullMatrix<double> of_face(12, 12), of_node(3, 3);
  std::vector<DofIndex> face_dofs(12);
  for (const auto &[load, action, faces, surface] : on_surfaces_) {
    const double factor = load->times.factor(t);
    if (factor == 0.)
      continue;
    const TangentSystem target{system.constraints, system.matrix, system.lift, factor * system.weight};
    SurfaceCoupling coupling(nodes_.discretization());
    const LoadValues values = evaluate(*load, t, faces);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const LoadedFace &face = faces[f];
      const Tensor<2, 3> local = action->local_tangent(values.at(f), *surface);
      if (is_node_site(face)) {
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            of_node(i, j) = face.areas[0] * local[i][j];
        const std::array<DofIndex, 3> &dofs = nodes_.dofs(face.nodes[0]);
        coupling.add(dofs, action->coupling(surface->shares[f][0], values.at(f), *surface));
        target.add(of_node, {dofs.begin(), dofs.end()});
        continue;
      }
      const auto corner = [&](const unsigned int a) { return get_vector(at.positions, face.nodes[a]); };
      of_face = 0.;
      for (const auto &point : facet_points()) {
        const double area = point.area_vector(corner).norm();
        for (unsigned int i = 0; i < 12; ++i)
          for (unsigned int j = 0; j < 12; ++j)
            of_face(i, j) += area * point.N[i / 3] * point.N[j / 3] * local[i % 3][j % 3];
      }
      for (unsigned int a = 0; a < 4; ++a) {
        const std::array<DofIndex, 3> &dofs = nodes_.dofs(face.nodes[a]);
        std::copy_n(dofs.begin(), 3, face_dofs.begin() + 3 * a);
        coupling.add(dofs, action->coupling(surface->shares[f][a], values.at(f), *surface));
      }
      target.add(of_face, face_dofs);
    }
    coupling.add_to(target);
  }
}

void ExternalLoads::add_bounds(NodalVectors &bounds) const {
  visit([&](const auto &placed) {
    if (!placed.load->load.limits_steps())
      return;
    const auto [stiffness, damping] = placed.action->bound(*placed.surface);
    const Tensor<1, 3> per_area({stiffness, damping, 0.});
    for (const auto &site : placed.sites)
      visit_nodes(site, [&, &per_area = per_area](const unsigned int node, const double area) {
        add_vector(bounds.data(), node, area * per_area);
      });
  });
}

} // namespace billet
