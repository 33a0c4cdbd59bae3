// SPDX-License-Identifier: LGPL-2.1-or-later
// Checks of the scene that need a mesh.
#include "billet/error_notes.h"
#include "billet/geometry/curve.h"
#include "billet/scene/plane_fit.h"
#include "billet/scene/rigid_motions.h"
#include "billet/scene/scene.h"

#include <deal.II/base/bounding_box.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace billet {

using dealii::Tensor;
using dealii::Triangulation;

bool constrains_face(const Constraint &constraint, const Triangulation<3>::active_face_iterator &face,
                     const double tolerance) {
  if (!constraint.on_plane) // none for a support of selected nodes
    return std::find(constraint.boundary_ids.begin(), constraint.boundary_ids.end(), face->boundary_id()) !=
           constraint.boundary_ids.end();
  const auto vertices = face->vertex_indices();
  return std::all_of(vertices.begin(), vertices.end(), [&](const unsigned int v) {
    return std::abs(face->vertex(v) * constraint.normal - constraint.offset) <= tolerance;
  });
}

namespace {

template <class Function> void for_each_boundary_face(const Triangulation<3> &mesh, const Function &f) {
  for (const auto &cell : mesh.active_cell_iterators())
    for (const unsigned int i : cell->face_indices())
      if (cell->face(i)->at_boundary())
        f(static_cast<std::size_t>(cell->material_id()), cell->face(i));
}

void check_ids(const BoundaryIds &asked, const std::set<unsigned int> &present, const Body &body) {
  if (asked.are_all) // ids of conditions may be without faces
    return;
  for (const unsigned int id : asked.value)
    if (present.count(id) == 0) {
      for (const auto &[name, ids] : body.boundary_names.ids_of_name)
        if (std::find(ids.begin(), ids.end(), id) != ids.end())
          throw InputError(
              asked.origin + " names '" + name + "', which no face of body '" + body.name +
              "' has; allowed are names of faces: the condition of this name in 'Boundary ids' of "
              "its mesh holds for none");
      std::string allowed;
      for (const unsigned int p : present)
        allowed += (allowed.empty() ? "" : ", ") + std::to_string(p);
      std::string names;
      for (const auto &named : body.boundary_names.ids_of_name)
        names += (names.empty() ? "; names: " : ", ") + named.first;
      throw InputError(asked.origin + " names boundary id " + std::to_string(id) +
                       "; allowed are those of body '" + body.name + "': " + allowed + names);
    }
}

InputError lacks_support(const std::string &body, const std::string &motion) {
  return InputError(
      body +
      ": the body has no support: at the start neither supports, nor symmetry planes, nor tools "
      "in contact constrain its rigid-body mode with " +
      motion +
      ". A static scene allows no free mode. Add a support or a symmetry plane; if only contact "
      "holds it, set 'Contact stabilisation = until contact'");
}

} // namespace

/// Refuses supports in cylindrical axes all of whose nodes are on the line, where no direction is
/// radial.
void Scene::check_axes(const Triangulation<3> &mesh) const {
  std::set<const Constraint *> on_line, off_line;
  const auto visit = [&](const Constraint &constraint, const dealii::Point<3> &position, const double size) {
    (constraint.has_direction(position, Constraint::rounding * size) ? off_line : on_line)
        .insert(&constraint);
  };
  for_each_boundary_face(mesh, [&](const std::size_t body, const auto &face) {
    for (const Constraint &constraint : bodies_[body].constraints)
      if (constraint.axes && constrains_face(constraint, face, 0.))
        for (const unsigned int v : face->vertex_indices())
          visit(constraint, face->vertex(v), face->diameter());
  });
  const auto corners = dealii::GridTools::compute_bounding_box(mesh).get_boundary_points();
  const double size = corners.first.distance(corners.second);
  for (const Body &body : bodies_)
    for (const Constraint &constraint : body.constraints) {
      if (constraint.nodes)
        for (const auto &position : constraint.nodes->points())
          visit(constraint, position, size);
      if (on_line.count(&constraint) > 0 && off_line.count(&constraint) == 0)
        throw InputError(constraint.origin + ": all nodes that " + constraint.name +
                         " holds are on the line of its "
                         "cylindrical axes, where no direction is radial; allowed are nodes off the line, or "
                         "'Components = z', along it");
    }
}

void Scene::check_boundary_ids(const Triangulation<3> &mesh, const MeshDetail detail, ErrorNotes &errors,
                               std::set<std::size_t> &unsound) const {
  std::vector<std::set<unsigned int>> present(bodies_.size());
  for_each_boundary_face(
      mesh, [&](const std::size_t body, const auto &face) { present[body].insert(face->boundary_id()); });
  const auto check = [&](const BoundaryIds &asked, const std::size_t body) {
    return errors.note([&] { check_ids(asked, present[body], bodies_[body]); });
  };
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    // An outline may lack faces that a condition selects on the full mesh.
    if (detail == MeshDetail::outline)
      for (const auto &renamed : parameters_.bodies[i].mesh.boundary_ids.value)
        present[i].insert(renamed.first);
    for (const auto &support : parameters_.bodies[i].supports)
      if (!check(support.boundary_ids, i))
        unsound.insert(i);
    for (const auto &load : parameters_.bodies[i].loads)
      if (!check(load.boundary_ids, i))
        unsound.insert(i);
  }
  for (const auto &pair : parameters_.pairs) {
    const std::size_t body = parameters_.body_index(pair);
    if (!check(pair.boundary_ids, body))
      unsound.insert(body);
    if (!pair.is_between_bodies())
      continue;
    const std::size_t second = parameters_.second_body_index(pair);
    if (!check(pair.second_boundary_ids, second))
      unsound.insert(second);
  }
  for (const auto &probe : parameters_.probes) {
    const std::size_t body = parameters_.body_index(probe);
    check(probe.boundary_ids, body);
    check(probe.opposite_ids, body);
  }
}

namespace {

/// Adds the resistances of supports and springs of a body that act in a step that starts at this
/// time.
void add_supports(const Body &body, const std::size_t index, const Triangulation<3> &mesh, const double time,
                  const double tolerance, std::vector<Resistance> &resistances) {
  const auto add = [&](const Constraint &constraint, const dealii::Point<3> &position) {
    if (constraint.has_direction(position, tolerance))
      resistances.push_back({position, constraint.direction(position), Resistance::Sense::both_ways});
  };
  for_each_boundary_face(mesh, [&](const std::size_t of, const auto &face) {
    if (of != index)
      return;
    for (const Constraint &constraint : body.constraints)
      if (constraint.times.acts_after(time) && constrains_face(constraint, face, tolerance))
        for (const unsigned int v : face->vertex_indices())
          add(constraint, face->vertex(v));
    for (const AppliedLoad &load : body.loads) {
      const auto &ids = load.boundary_ids;
      if (!load.times.acts_after(time) || std::find(ids.begin(), ids.end(), face->boundary_id()) == ids.end())
        continue;
      Tensor<1, 3> normal =
          dealii::cross_product_3d(face->vertex(3) - face->vertex(0), face->vertex(2) - face->vertex(1));
      normal /= normal.norm();
      for (const auto &direction : load.load.supports(normal))
        for (const unsigned int v : face->vertex_indices())
          resistances.push_back({face->vertex(v), direction, Resistance::Sense::both_ways});
    }
  });
  for (const Constraint &constraint : body.constraints)
    if (constraint.nodes && constraint.times.acts_after(time))
      for (const auto &position : constraint.nodes->points())
        add(constraint, position);
  for (const AppliedLoad &load : body.loads)
    if (load.nodes && load.times.acts_after(time))
      for (const auto &direction : load.load.supports(Tensor<1, 3>()))
        for (const auto &position : load.nodes->points())
          resistances.push_back({position, direction, Resistance::Sense::both_ways});
}

/// Centre of a body, and the diagonal of the box around it.
struct Extent {
  dealii::Point<3> centre;
  double size;
};

Extent find_extent(const Triangulation<3> &mesh, const std::size_t body) {
  std::vector<dealii::Point<3>> points;
  for_each_boundary_face(mesh, [&](const std::size_t of, const auto &face) {
    if (of == body)
      for (const unsigned int v : face->vertex_indices())
        points.push_back(face->vertex(v));
  });
  const dealii::BoundingBox<3> box(points);
  return {box.center(), (box.get_boundary_points().second - box.get_boundary_points().first).norm()};
}

} // namespace

bool Scene::check_support_times(const std::size_t b, const Triangulation<3> &mesh,
                                const double last_removal) const {
  const Body &body = bodies_[b];
  std::set<double> times;
  const auto add_times = [&](const auto &of) {
    for (const double time : {of.from, of.until})
      if (time > 0. && time < parameters_.time_stepping.end_time)
        times.insert(time);
  };
  for (const Constraint &constraint : body.constraints)
    add_times(constraint.times);
  for (const AppliedLoad &load : body.loads)
    if (load.load.is_spring())
      add_times(load.times);
  if (times.empty())
    return false;
  times.insert(last_removal);
  const auto [centre, size] = find_extent(mesh, b);
  for (const double time : times) {
    if (time < last_removal || !std::isfinite(time)) // tools may hold it
      continue;
    std::vector<Resistance> holding;
    add_supports(body, b, mesh, time, Constraint::rounding * size, holding);
    const auto motion = find_free_motion(holding, centre, size);
    if (!motion)
      continue;
    std::ostringstream message;
    message << parameters_.bodies[b].origin << ": the body has no support from time " << time
            << " on: the supports and springs that act then ('From', 'Until') and symmetry planes do not "
               "constrain its rigid-body mode with "
            << print(*motion)
            << ", and no tool can. A static scene allows no free mode. Let another support or spring begin "
               "at this time, or use dynamics";
    throw InputError(message.str());
  }
  return true;
}

void Scene::check_planes(const Triangulation<3> &mesh, const std::size_t b) const {
  const double size = find_extent(mesh, b).size;
  std::set<const Constraint *> used;
  for_each_boundary_face(mesh, [&](const std::size_t body, const auto &face) {
    if (body == b)
      for (const Constraint &constraint : bodies_[b].constraints)
        if (constraint.on_plane && constrains_face(constraint, face, Constraint::rounding * size))
          used.insert(&constraint);
  });
  for (const Constraint &constraint : bodies_[b].constraints)
    if (constraint.on_plane && used.count(&constraint) == 0)
      throw InputError(parameters_.bodies[b].symmetry_planes.origin + " is '" +
                       constraint.name.substr(std::string("symmetry plane ").size()) +
                       "'; allowed are planes that hold boundary faces of body '" + bodies_[b].name +
                       "', but this plane holds none: " +
                       describe_nearest_face({constraint.normal, constraint.offset, constraint.name}, mesh,
                                             static_cast<unsigned int>(b)));
}

void Scene::check_support(const Triangulation<3> &mesh, const std::size_t b) const {
  const auto [centre, size] = find_extent(mesh, b);
  std::vector<Resistance> holding, touching; // resistances of supports, of tools
  add_supports(bodies_[b], b, mesh, 0., Constraint::rounding * size, holding);
  for_each_boundary_face(mesh, [&](const std::size_t body, const auto &face) {
    if (body != b)
      return;
    for (const auto &pair : pairs_)
      if (pair.body == b && std::find(pair.boundary_ids.begin(), pair.boundary_ids.end(),
                                      face->boundary_id()) != pair.boundary_ids.end()) {
        const Tool &tool = tools_[pair.tool];
        const Placement start = tool.placement(0.);
        const double facet_size = std::sqrt(face->measure());
        for (const unsigned int v : face->vertex_indices()) {
          const auto projection = tool.surface().project(start.to_tool(face->vertex(v)));
          if (projection.exists &&
              (projection.gap <= touching_gap * facet_size || pair.overlap.closes(projection.gap)))
            add_contact(face->vertex(v), start.rotation * projection.normal,
                        tool.control() == Tool::Control::force, pair.has_friction(), touching);
        }
      }
  });
  const bool may_touch_bodies =
      std::any_of(body_pairs_.begin(), body_pairs_.end(), [b](const BodyPair &pair) {
        return pair.bodies[0] != pair.bodies[1] && (pair.bodies[0] == b || pair.bodies[1] == b);
      });
  const auto &is_stabilised = parameters_.bodies[b].is_stabilised;
  const bool has_tools =
      std::any_of(pairs_.begin(), pairs_.end(), [b](const auto &pair) { return pair.body == b; });
  if (is_stabilised.value && !may_touch_bodies && !has_tools)
    throw InputError(is_stabilised.origin + " is 'until contact'; allowed is 'none', since body '" +
                     bodies_[b].name +
                     "' has no contact pair with a tool or another body that could support it");
  if (may_touch_bodies)
    return; // another body may support it: unknown without both meshes
  touching.insert(touching.end(), holding.begin(), holding.end());
  // Contact with tools at a restart is not known here.
  const bool may_touch = parameters_.restart.is_wanted() && has_tools;
  const auto free_motion = find_free_motion(touching, centre, size);
  if (free_motion && !may_touch && !is_stabilised.value)
    throw lacks_support(parameters_.bodies[b].origin, print(*free_motion));

  double last_removal = 0.; // of the tools in its pairs; infinite if one is never removed
  for (const auto &pair : pairs_)
    if (pair.body == b)
      last_removal = std::max(last_removal, tools_[pair.tool].removal_time());
  if (check_support_times(b, mesh, last_removal))
    return;
  const auto motion = find_free_motion(holding, centre, size);
  if (motion && std::isfinite(last_removal)) {
    std::ostringstream message;
    message << parameters_.bodies[b].origin << ": the body has no support from time " << last_removal
            << " on, when all tools of its contact pairs are removed ('Removal time'): neither supports nor "
               "symmetry planes constrain its rigid-body mode with "
            << print(*motion) << ". A static scene allows no free mode";
    throw InputError(message.str());
  }
}

void Scene::check_on_mesh(const Triangulation<3> &mesh, const MeshDetail detail, ErrorNotes &errors,
                          std::set<std::size_t> unsound) const {
  check_boundary_ids(mesh, detail, errors, unsound);
  errors.note([&] { check_axes(mesh); });
  for (std::size_t b = 0; b < bodies_.size() && !parameters_.scheme().has_inertia; ++b)
    if (errors.note([&] { check_planes(mesh, b); }) && unsound.count(b) == 0)
      errors.note([&] { check_support(mesh, b); });
  errors.note([&] { check_initial_penetration(mesh); });
}

void Scene::check_initial_penetration(const Triangulation<3> &mesh) const {
  if (parameters_.restart.is_wanted()) // it begins with deformed bodies
    return;
  for (const auto &pair : pairs_) {
    if (pair.overlap.is_allowed)
      continue;
    const Tool &tool = tools_[pair.tool];
    const Placement start = tool.placement(0.);
    double deepest = 0., size_there = 1.;
    Tensor<1, 3> where;
    for_each_boundary_face(mesh, [&](const std::size_t body, const auto &face) {
      if (body != pair.body || std::find(pair.boundary_ids.begin(), pair.boundary_ids.end(),
                                         face->boundary_id()) == pair.boundary_ids.end())
        return;
      const double h = std::sqrt(face->measure());
      for (const unsigned int v : face->vertex_indices()) {
        // It is positive if there is none.
        const double gap = tool.surface().project(start.to_tool(face->vertex(v))).gap;
        if (gap / h < deepest / size_there) {
          deepest = gap;
          size_there = h;
          where = face->vertex(v);
        }
      }
    });
    const auto &allowed = pair.input->initial.allowed_penetration;
    if (-deepest > allowed.value * size_there) {
      std::ostringstream message;
      message << pair.input->origin << ": body '" << bodies_[pair.body].name
              << "' starts with a penetration of " << -deepest << " (" << -deepest / size_there
              << " facet sizes) in tool '" << tool.name() << "', deepest at " << print(where)
              << "; allowed are " << allowed.value
              << " facet sizes ('Allowed initial penetration'). Check whether the tool's normal points "
                 "towards the body"
              << (pair.input->is_generated ? ", or exclude '" + bodies_[pair.body].name + " : " +
                                                 tool.name() + "' in 'General contact'"
                                           : "");
      throw InputError(message.str());
    }
  }
}

} // namespace billet
