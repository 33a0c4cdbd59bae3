// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/mesh_refinements.h"

#include "billet/errors.h"
#include "billet/times.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace billet {

using dealii::Tensor;

namespace {

/// Span of time in which forces of something that is switched off fade.
struct Fade {
  std::string what;
  double begin, end;

  bool contains(const double t) const { return !times::is_after(begin, t) && times::is_before(t, end); }
};

std::vector<Fade> find_fades(const parameters::Scene &scene, const parameters::Body &body) {
  const double automatic = scene.automatic_fade_time();
  std::vector<Fade> fades;
  for (const auto &support : body.supports)
    fades.push_back({"support '" + support.name + "'", support.until,
                     support.until + support.fade_time.value_or(automatic)});
  for (const auto &pair : scene.pairs)
    if (pair.body.value == body.name)
      for (const auto &tool : scene.tools)
        if (tool.name == pair.tool.value)
          fades.push_back({"tool '" + tool.name + "'", tool.motion.removal_time.value,
                           tool.motion.removal_time.value + tool.motion.release_time});
  return fades;
}

void check_body(const parameters::Scene &scene, const parameters::Body &body) {
  const auto &[times, origin] = body.refinement_times;
  if (times.empty())
    return;
  const double end = scene.time_stepping.end_time;
  if (!times::is_before(times.back(), end)) {
    std::ostringstream message;
    message << origin << " has the time " << times.back() << "; allowed are times before the end of the run, "
            << end;
    throw InputError(message.str());
  }
  if (times.size() > max_refinements)
    throw InputError(origin + " has " + std::to_string(times.size()) + " times; allowed are at most " +
                     std::to_string(max_refinements) + ", for each divides every element into eight");
  if (body.element.value.points_through > 2)
    throw InputError(origin + " refines a body with 'Points through thickness = " +
                     std::to_string(body.element.value.points_through) +
                     "', whose layers cannot be carried over; allowed are 2 points, or a finer mesh from the "
                     "start by 'Refinements' in Mesh");
  const auto check_nodes = [&](const std::string &what, const NodeSelection &nodes) {
    const bool is_section = body.mesh.section.value != parameters::Mesh::Section::solid;
    if (!nodes.is_empty() && is_section)
      throw InputError(origin + " refines a section whose " + what +
                       " acts on nodes, and the nodes between both sides would be new; allowed are boundary "
                       "ids");
    if (!nodes.lines.empty() || !nodes.sets.empty())
      throw InputError(origin + " refines a body whose " + what +
                       " acts on nodes of a line or of a set, and the nodes between them would be new; "
                       "allowed are boundary ids, or nodes 'at x, y, z'");
  };
  for (const auto &support : body.supports)
    check_nodes("support '" + support.name + "'", support.nodes);
  for (const auto &load : body.loads)
    check_nodes("load '" + load.name + "'", load.nodes);
  for (const auto &pair : scene.pairs)
    if ((pair.body.value == body.name || pair.second_body.value == body.name) &&
        (pair.initial.may_overlap || pair.initial.closed_gap > 0.))
      throw InputError(origin + " refines body '" + body.name + "', whose contact pair '" + pair.name +
                       "' allows initial penetrations or closes initial gaps, which cannot be carried over; "
                       "allowed are pairs without them");
  for (const Fade &fade : find_fades(scene, body))
    for (const double time : times)
      if (fade.contains(time)) {
        std::ostringstream message;
        message << origin << " has the time " << time << ", while the forces of " << fade.what
                << " fade, which cannot be carried over; allowed are times outside of " << fade.begin
                << " to " << fade.end;
        throw InputError(message.str());
      }
}

/// Returns whether the Jacobian is positive at all corners.
bool has_sound_corners(const dealii::Triangulation<3>::cell_iterator &cell) {
  for (unsigned int a = 0; a < 8; ++a) {
    std::array<Tensor<1, 3>, 3> edges;
    for (unsigned int i = 0; i < 3; ++i)
      edges[i] = ((a >> i & 1U) != 0 ? -1. : 1.) * (cell->vertex(a ^ 1U << i) - cell->vertex(a));
    if (!(edges[0] * cross_product_3d(edges[1], edges[2]) > 0.))
      return false;
  }
  return true;
}

} // namespace

MeshLevels find_mesh_levels(const parameters::Scene &scene, const double t) {
  MeshLevels levels;
  for (const auto &body : scene.bodies)
    levels.push_back(static_cast<unsigned int>(
        std::count_if(body.refinement_times.value.begin(), body.refinement_times.value.end(),
                      [t](const double time) { return !times::is_after(time, t); })));
  return levels;
}

std::vector<double> refinement_times(const parameters::Scene &scene) {
  std::vector<double> times;
  for (const auto &body : scene.bodies)
    times.insert(times.end(), body.refinement_times.value.begin(), body.refinement_times.value.end());
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

void check_refinements(const parameters::Scene &scene, ErrorNotes &errors) {
  for (const auto &body : scene.bodies)
    errors.note([&] { check_body(scene, body); });
}

void refine_bodies(const parameters::Scene &scene, const MeshLevels &levels, dealii::Triangulation<3> &mesh) {
  for (const auto &cell : mesh.active_cell_iterators()) {
    const parameters::Body &body = scene.bodies[cell->material_id()];
    if (body.refinement_times.value.empty() || has_sound_corners(cell))
      continue;
    std::ostringstream message;
    message << body.refinement_times.origin << " divides the elements of body '" << body.name
            << "', but one has no positive Jacobian at a corner, near (" << cell->center()
            << "), so that its parts could be inverted; allowed are elements without such corners";
    throw InputError(message.str());
  }
  const unsigned int highest = levels.empty() ? 0 : *std::max_element(levels.begin(), levels.end());
  for (unsigned int level = 0; level < highest; ++level) {
    for (const auto &cell : mesh.active_cell_iterators())
      if (levels[cell->material_id()] > level)
        cell->set_refine_flag();
    mesh.execute_coarsening_and_refinement();
  }
}

} // namespace billet
