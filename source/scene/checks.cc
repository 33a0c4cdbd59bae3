// SPDX-License-Identifier: LGPL-2.1-or-later
// Checks of the scene that need a mesh.
#include "billet/errors.h"
#include "billet/geometry/curve.h"
#include "billet/scene/rigid_motions.h"
#include "billet/scene/scene.h"

#include <deal.II/base/bounding_box.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace billet {

using dealii::Tensor;
using dealii::Triangulation;

bool holds_face(const Hold &hold, const Triangulation<3>::active_face_iterator &face,
                const double tolerance) {
  if (!hold.on_plane)
    return std::find(hold.boundary_ids.begin(), hold.boundary_ids.end(), face->boundary_id()) !=
           hold.boundary_ids.end();
  const auto vertices = face->vertex_indices();
  return std::all_of(vertices.begin(), vertices.end(), [&](const unsigned int v) {
    return std::abs(face->vertex(v) * hold.normal - hold.offset) <= tolerance;
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

/// Refuses supports in cylindrical axes that hold a node on the line, where no direction is radial.
void Scene::check_axes(const Triangulation<3> &mesh) const {
  for_each_boundary_face(mesh, [&](const std::size_t body, const auto &face) {
    for (const Hold &hold : bodies_[body].holds) {
      if (!hold.axes || !hold.axes->are_cylindrical() || hold.component == 2 || !holds_face(hold, face, 0.))
        continue;
      for (const unsigned int v : face->vertex_indices())
        if (hold.axes->radius(face->vertex(v)) < 1e-8 * face->diameter()) {
          std::ostringstream message;
          message << hold.origin << ": " << hold.name << " holds the node at (" << face->vertex(v)
                  << "), which is on the line of its cylindrical axes; allowed are nodes off the line, or "
                     "'Components = z', along it";
          throw InputError(message.str());
        }
    }
  });
}

void Scene::check_boundary_ids(const Triangulation<3> &mesh, const MeshDetail detail) const {
  std::vector<std::set<unsigned int>> present(bodies_.size());
  for_each_boundary_face(
      mesh, [&](const std::size_t body, const auto &face) { present[body].insert(face->boundary_id()); });
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    // An outline may lack faces that a condition selects on the full mesh.
    if (detail == MeshDetail::outline)
      for (const auto &renamed : parameters_.bodies[i].mesh.boundary_ids.value)
        present[i].insert(renamed.first);
    for (const auto &support : parameters_.bodies[i].supports)
      check_ids(support.boundary_ids, present[i], bodies_[i]);
    for (const auto &load : parameters_.bodies[i].loads)
      check_ids(load.boundary_ids, present[i], bodies_[i]);
  }
  for (const auto &pair : parameters_.pairs) {
    const std::size_t body = parameters_.body_index(pair);
    check_ids(pair.boundary_ids, present[body], bodies_[body]);
    if (!pair.is_between_bodies())
      continue;
    const std::size_t second = parameters_.second_body_index(pair);
    check_ids(pair.second_boundary_ids, present[second], bodies_[second]);
  }
  for (const auto &probe : parameters_.probes) {
    const std::size_t body = parameters_.body_index(probe);
    check_ids(probe.boundary_ids, present[body], bodies_[body]);
    check_ids(probe.opposite_ids, present[body], bodies_[body]);
  }
}

namespace {

/// Adds the resistances of springs on a face that act from the start to the end of the scene.
template <class Face>
void add_springs(const Body &body, const Face &face, std::vector<Resistance> &resistances) {
  for (const AppliedLoad &load : body.loads) {
    const auto &ids = load.boundary_ids;
    if (!load.times.always() || std::find(ids.begin(), ids.end(), face->boundary_id()) == ids.end())
      continue;
    Tensor<1, 3> normal =
        dealii::cross_product_3d(face->vertex(3) - face->vertex(0), face->vertex(2) - face->vertex(1));
    normal /= normal.norm();
    for (const auto &direction : load.load.supports(normal))
      for (const unsigned int v : face->vertex_indices())
        resistances.push_back({face->vertex(v), direction, Resistance::Sense::both_ways});
  }
}

} // namespace

bool Scene::check_support_times(const std::size_t b, const Triangulation<3> &mesh,
                                const double last_removal) const {
  const Body &body = bodies_[b];
  std::set<double> times;
  for (const Hold &hold : body.holds)
    for (const double time : {hold.times.from, hold.times.until})
      if (time > 0. && time < parameters_.time_stepping.end_time)
        times.insert(time);
  if (times.empty())
    return false;
  times.insert(last_removal);
  for (const double time : times) {
    if (time < last_removal || !std::isfinite(time)) // tools may hold it
      continue;
    std::vector<Resistance> holding;
    std::vector<dealii::Point<3>> points;
    for_each_boundary_face(mesh, [&](const std::size_t of, const auto &face) {
      if (of != b)
        return;
      for (const unsigned int v : face->vertex_indices())
        points.push_back(face->vertex(v));
      for (const Hold &hold : body.holds)
        if (hold.times.holds_after(time) && holds_face(hold, face, 1e-8 * face->diameter()))
          for (const unsigned int v : face->vertex_indices())
            holding.push_back(
                {face->vertex(v), hold.direction(face->vertex(v)), Resistance::Sense::both_ways});
      add_springs(body, face, holding);
    });
    const auto corners = dealii::BoundingBox<3>(points).get_boundary_points();
    const auto motion =
        find_free_motion(holding, dealii::Tensor<1, 3>(0.5 * (corners.first + corners.second)),
                         (corners.second - corners.first).norm());
    if (!motion)
      continue;
    std::ostringstream message;
    message << parameters_.bodies[b].origin << ": the body has no support from time " << time
            << " on: the supports that act then ('From', 'Until') and symmetry planes do not constrain its "
               "rigid-body mode with "
            << print(*motion)
            << ", and no tool can. A static scene allows no free mode. Let another support begin at this "
               "time, or use dynamics";
    throw InputError(message.str());
  }
  return true;
}

void Scene::check_supports(const Triangulation<3> &mesh) const {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    std::vector<dealii::Point<3>> points;
    for_each_boundary_face(mesh, [&](const std::size_t body, const auto &face) {
      if (body == b)
        for (const unsigned int v : face->vertex_indices())
          points.push_back(face->vertex(v));
    });
    const dealii::BoundingBox<3> box(points);
    const dealii::Point<3> centre = box.center();
    const double size = (box.get_boundary_points().second - box.get_boundary_points().first).norm();

    std::vector<Resistance> holding, touching; // resistances of supports, of tools
    std::vector<bool> used(bodies_[b].holds.size(), false);
    for_each_boundary_face(mesh, [&](const std::size_t body, const auto &face) {
      if (body != b)
        return;
      for (std::size_t h = 0; h < used.size(); ++h)
        if (holds_face(bodies_[b].holds[h], face, 1e-8 * size)) {
          used[h] = true;
          if (bodies_[b].holds[h].times.holds_after(0.))
            for (const unsigned int v : face->vertex_indices())
              holding.push_back({face->vertex(v), bodies_[b].holds[h].direction(face->vertex(v)),
                                 Resistance::Sense::both_ways});
        }
      add_springs(bodies_[b], face, holding);
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
    for (std::size_t h = 0; h < used.size(); ++h)
      if (!used[h] && bodies_[b].holds[h].on_plane)
        throw InputError(parameters_.bodies[b].symmetry_planes.origin + " is '" +
                         bodies_[b].holds[h].name.substr(std::string("symmetry plane ").size()) +
                         "'; allowed are planes that hold boundary faces of body '" + bodies_[b].name +
                         "', but this plane holds none");
    const bool may_touch_bodies =
        std::any_of(body_pairs_.begin(), body_pairs_.end(), [b](const BodyPair &pair) {
          return pair.bodies[0] != pair.bodies[1] && (pair.bodies[0] == b || pair.bodies[1] == b);
        });
    const auto &is_stabilised = parameters_.bodies[b].is_stabilised;
    if (is_stabilised.value && !may_touch_bodies &&
        std::none_of(pairs_.begin(), pairs_.end(), [b](const auto &pair) { return pair.body == b; }))
      throw InputError(is_stabilised.origin + " is 'until contact'; allowed is 'none', since body '" +
                       bodies_[b].name +
                       "' has no contact pair with a tool or another body that could support it");
    if (may_touch_bodies)
      continue; // another body may support it: unknown without both meshes
    touching.insert(touching.end(), holding.begin(), holding.end());
    // Contact with tools at a restart is not known here.
    const bool may_touch =
        parameters_.restart.is_wanted() &&
        std::any_of(pairs_.begin(), pairs_.end(), [b](const auto &pair) { return pair.body == b; });
    const auto free_motion = find_free_motion(touching, centre, size);
    if (free_motion && !may_touch && !is_stabilised.value)
      throw lacks_support(parameters_.bodies[b].origin, print(*free_motion));

    double last_removal = 0.; // of the tools in its pairs; infinite if one is never removed
    for (const auto &pair : pairs_)
      if (pair.body == b)
        last_removal = std::max(last_removal, tools_[pair.tool].removal_time());
    if (check_support_times(b, mesh, last_removal))
      continue;
    const auto motion = find_free_motion(holding, centre, size);
    if (motion && std::isfinite(last_removal)) {
      std::ostringstream message;
      message
          << parameters_.bodies[b].origin << ": the body has no support from time " << last_removal
          << " on, when all tools of its contact pairs are removed ('Removal time'): neither supports nor "
             "symmetry planes constrain its rigid-body mode with "
          << print(*motion) << ". A static scene allows no free mode";
      throw InputError(message.str());
    }
  }
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
        const double gap = tool.surface().project(start.to_tool(face->vertex(v))).gap; // none: positive
        if (gap / h < deepest / size_there) {
          deepest = gap;
          size_there = h;
          where = face->vertex(v);
        }
      }
    });
    const auto &allowed = pair.input->allowed_penetration;
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
