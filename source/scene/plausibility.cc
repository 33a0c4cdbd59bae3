// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/plausibility.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/scene/course_checks.h"
#include "billet/scene/law_checks.h"
#include "billet/scene/section_checks.h"
#include "billet/scene/turning_supports.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <type_traits>

namespace billet {

using dealii::Tensor;
using dealii::Triangulation;

namespace {

const DiagnosticKind bodies_coincide(
    "bodies-coincide", Severity::warning,
    "Two bodies take the same place. They pass through each other, since a pair sees no node that starts "
    "inside another body.",
    "Change 'Volumes', or the position of one of them");

/// Bounding box of points, which may belong to several ranks.
class Box {
public:
  void add(const Tensor<1, 3> &x) {
    for (unsigned int i = 0; i < 3; ++i) {
      ends_[i] = std::max(ends_[i], -x[i]);
      ends_[3 + i] = std::max(ends_[3 + i], x[i]);
    }
  }
  void gather(const MPI_Comm communicator) { dealii::Utilities::MPI::max(ends_, communicator, ends_); }
  /// Returns the area of its largest face.
  double section() const {
    std::array<double, 3> extents{ends_[0] + ends_[3], ends_[1] + ends_[4], ends_[2] + ends_[5]};
    std::sort(extents.begin(), extents.end());
    return extents[1] * extents[2];
  }
  double diagonal() const {
    return std::hypot(ends_[0] + ends_[3], ends_[1] + ends_[4], ends_[2] + ends_[5]);
  }
  /// Returns the largest distance between corresponding faces.
  double difference(const Box &other) const {
    double largest = 0.;
    for (std::size_t i = 0; i < ends_.size(); ++i)
      largest = std::max(largest, std::abs(ends_[i] - other.ends_[i]));
    return largest;
  }

private:
  std::vector<double> ends_ = std::vector<double>(6, -std::numeric_limits<double>::infinity());
};

/// Dimensions, speeds and penetrations of the scene at its start.
struct Start {
  std::vector<Box> boxes;                               ///< by body
  std::vector<double> sizes, speeds, sections, volumes; ///< by body
  /// Minimum time in which a wave crosses an element, by body and up to a factor.
  std::vector<double> steps;
  double size = 0.;                 ///< of all bodies together
  std::vector<double> penetrations; ///< penetration by pair with a tool [facet sizes]
};

Start measure_start(const Scene &scene, const Triangulation<3> &mesh, const MPI_Comm communicator) {
  Box all;
  Start start;
  start.boxes.resize(scene.bodies().size());
  std::vector<Box> &boxes = start.boxes;
  start.volumes.resize(boxes.size());
  start.speeds.resize(boxes.size());
  start.penetrations.resize(scene.pairs().size());
  start.steps.resize(boxes.size(), std::numeric_limits<double>::infinity());
  for (const auto &cell : mesh.active_cell_iterators()) {
    if (!cell->is_locally_owned())
      continue;
    const std::size_t b = cell->material_id();
    const Body &body = scene.bodies()[b];
    start.volumes[b] += cell->measure();
    if (!scene.parameters().scheme().has_matrix) {
      double max_face = 0.;
      for (const unsigned int f : cell->face_indices())
        max_face = std::max(max_face, cell->face(f)->measure());
      start.steps[b] =
          std::min(start.steps[b], cell->measure() / max_face / std::sqrt(body.max_modulus / body.density));
    }
    for (const unsigned int v : cell->vertex_indices()) {
      boxes[b].add(cell->vertex(v));
      all.add(cell->vertex(v));
      if (scene.parameters().scheme().has_inertia) {
        Tensor<1, 3> velocity;
        for (unsigned int i = 0; i < 3; ++i)
          velocity[i] = body.initial_velocity[i].value(0., cell->vertex(v));
        start.speeds[b] = std::max(start.speeds[b], velocity.norm());
      }
    }
    for (std::size_t p = 0; p < scene.pairs().size(); ++p) {
      const ContactPair &pair = scene.pairs()[p];
      if (pair.body != b || !pair.overlap.is_allowed) // otherwise it is refused
        continue;
      const Placement placement = scene.tools()[pair.tool].placement(0.);
      for (const unsigned int f : cell->face_indices()) {
        const auto &face = cell->face(f);
        if (!face->at_boundary() || std::find(pair.boundary_ids.begin(), pair.boundary_ids.end(),
                                              face->boundary_id()) == pair.boundary_ids.end())
          continue;
        const double size = std::sqrt(face->measure());
        for (const unsigned int v : face->vertex_indices()) {
          const auto projection =
              scene.tools()[pair.tool].surface().project(placement.to_tool(face->vertex(v)));
          if (projection.exists)
            start.penetrations[p] = std::max(start.penetrations[p], -projection.gap / size);
        }
      }
    }
  }
  for (Box &box : boxes) {
    box.gather(communicator);
    start.sizes.push_back(box.diagonal());
    start.sections.push_back(box.section());
  }
  all.gather(communicator);
  start.size = all.diagonal();
  dealii::Utilities::MPI::sum(start.volumes, communicator, start.volumes);
  dealii::Utilities::MPI::max(start.speeds, communicator, start.speeds);
  dealii::Utilities::MPI::max(start.penetrations, communicator, start.penetrations);
  dealii::Utilities::MPI::min(start.steps, communicator, start.steps);
  return start;
}

/// Maxima of the prescribed motion of a tool over the run.
struct Course {
  double travel = 0., speed = 0., turn = 0.;
};

Course follow(const Tool &tool, const double end) {
  constexpr unsigned int n_samples = 200;
  Course course;
  const Placement start = tool.placement(0.);
  Placement before = start;
  for (unsigned int i = 1; i <= n_samples; ++i) {
    Placement now;
    try {
      now = tool.placement(end * i / n_samples);
    } catch (const SolutionFailure &) { // the motion is not defined there; the run will report it
      break;
    }
    course.travel = std::max(course.travel, (now.translation - start.translation).norm());
    course.turn = std::max(course.turn, std::abs(now.rotation_angle - start.rotation_angle));
    course.speed = std::max(course.speed, (now.translation - before.translation).norm() * n_samples / end);
    before = now;
  }
  return course;
}

std::string ratio(const std::string &what, const double number) {
  std::ostringstream text;
  text.precision(3);
  text << what << " " << number;
  return text.str();
}

void check_yield_stress(const Body &body, DiagnosticList &diagnostics) {
  constexpr double minimum = 1e-7, maximum = 0.1;
  const FlowStress *flow = body.law->flow_stress();
  const double stress = flow != nullptr ? flow->stress(0.) : 0.;
  const double part = stress / body.young_modulus;
  if (stress > 0. && !(part > minimum && part < maximum))
    diagnostics.push_back(Diagnostic(diagnostic::implausible_yield_stress,
                                     ratio("The ratio of yield stress to Young's modulus is", part))
                              .body(body.name)
                              .measure("yield stress / Young's modulus", part));
}

void check_friction(const parameters::ContactPair &pair, DiagnosticList &diagnostics) {
  constexpr double maximum = 1.5;
  const double coefficient = pair.friction != nullptr ? pair.friction->coefficient() : 0.;
  if (coefficient > maximum)
    diagnostics.push_back(
        Diagnostic(diagnostic::implausible_friction, ratio("The friction coefficient is", coefficient))
            .pair(pair.name)
            .measure("friction coefficient", coefficient));
}

/// Checks the number of steps by an estimate of the stable step.
void check_number_of_steps(const Scene &scene, const Start &start, DiagnosticList &diagnostics) {
  const double step = std::max(*std::min_element(start.steps.begin(), start.steps.end()),
                               scene.parameters().explicit_dynamics.scaled_step);
  const double n_steps = scene.parameters().time_stepping.end_time / step;
  if (n_steps > too_many_steps)
    diagnostics.push_back(
        Diagnostic(diagnostic::many_steps, ratio("The estimated number of explicit steps is", n_steps))
            .value("steps", n_steps));
}

void check_motion(const Scene &scene, const Tool &tool, const double size, DiagnosticList &diagnostics) {
  constexpr double far = 10., hardly = 1e-7, turns = 4., pi = 3.14159265358979323846;
  const Course course = follow(tool, scene.parameters().time_stepping.end_time);
  const double part = course.travel / size;
  if (part > far || (part > 0. && part < hardly))
    diagnostics.push_back(
        Diagnostic(diagnostic::implausible_travel,
                   ratio("The ratio of the tool's travel to the size of all bodies is", part))
            .tool(tool.name())
            .measure("travel / size", part));
  if (course.turn > 2. * pi * turns)
    diagnostics.push_back(
        Diagnostic(diagnostic::many_turns, ratio("The tool turns by", course.turn) + " rad, " +
                                               ratio("or", course.turn / (2. * pi)) + " turns")
            .tool(tool.name())
            .value("turns", course.turn / (2. * pi)));
}

/// Checks prescribed forces; reaction forces are known only at the end of a run.
void check_force(const Scene &scene, const std::size_t t, const Start &start, DiagnosticList &diagnostics) {
  constexpr unsigned int n_samples = 200;
  const Tool &tool = scene.tools()[t];
  if (tool.control() != Tool::Control::force)
    return;
  double force = 0., borne = 0.;
  for (unsigned int i = 0; i <= n_samples; ++i)
    try {
      force = std::max(force, tool.load(scene.parameters().time_stepping.end_time * i / n_samples));
    } catch (const SolutionFailure &) { // the run will report it
      break;
    }
  for (const ContactPair &pair : scene.pairs())
    if (pair.tool == t)
      borne = std::max(borne, borne_force(scene.bodies()[pair.body], start.sections[pair.body]));
  if (borne > 0. && force > many_times_borne * borne)
    diagnostics.push_back(Diagnostic(diagnostic::implausible_force,
                                     ratio("The prescribed force of the tool is", force) + ", which is " +
                                         ratio("", force / borne).substr(1) +
                                         " times what the largest section of the body bears as it yields")
                              .tool(tool.name())
                              .measure("force / (yield stress x section)", force / borne));
}

/// Node of a pair in front of a tool that it faces.
struct FacingNode {
  unsigned int vertex;
  double gap, reach; ///< reach: diameter of its face
};

/// Returns the nodes of a pair on faces that look at the tool, at the start. Those on the sides of
/// a body, or on its far end, look elsewhere.
std::vector<FacingNode> find_facing_nodes(const Scene &scene, const ContactPair &pair,
                                          const Triangulation<3> &mesh) {
  constexpr double facing = 0.1; // cosine between the face and the tool, below 90 degrees
  const Tool &tool = scene.tools()[pair.tool];
  const Placement placement = tool.placement(0.);
  std::vector<FacingNode> nodes;
  for (const auto &cell : mesh.active_cell_iterators())
    for (const unsigned int f : cell->face_indices()) {
      const auto &face = cell->face(f);
      const auto &ids = pair.boundary_ids;
      if (!cell->is_locally_owned() || cell->material_id() != pair.body || !face->at_boundary() ||
          std::find(ids.begin(), ids.end(), face->boundary_id()) == ids.end())
        continue;
      Tensor<1, 3> normal =
          dealii::cross_product_3d(face->vertex(3) - face->vertex(0), face->vertex(2) - face->vertex(1));
      normal *= (normal * (face->center() - cell->center()) > 0. ? 1. : -1.) / normal.norm();
      for (const unsigned int v : face->vertex_indices()) {
        const auto projection = tool.surface().project(placement.to_tool(face->vertex(v)));
        if (projection.exists && normal * (placement.rotation * projection.normal) < -facing)
          nodes.push_back({face->vertex_index(v), projection.gap, face->diameter()});
      }
    }
  return nodes;
}

/// Checks whether supports hold nodes that a tool with a given force presses on first, along that
/// force. A support that acts on a neighbouring face holds the nodes of their common edge.
void check_constrained_nodes(const Scene &scene, const Triangulation<3> &mesh, const MPI_Comm communicator,
                             DiagnosticList &diagnostics) {
  constexpr double along = 0.1; // cosine between the support and the force
  for (const ContactPair &pair : scene.pairs()) {
    const Tool &tool = scene.tools()[pair.tool];
    if (tool.control() != Tool::Control::force)
      continue;
    const auto &constraints = scene.bodies()[pair.body].constraints;
    const std::vector<FacingNode> facing = find_facing_nodes(scene, pair, mesh);
    double nearest = std::numeric_limits<double>::max();
    for (const FacingNode &node : facing)
      nearest = std::min(nearest, node.gap);
    nearest = dealii::Utilities::MPI::min(nearest, communicator);
    std::set<unsigned int> pressed;
    for (const FacingNode &node : facing)
      if (node.gap <= nearest + node.reach)
        pressed.insert(node.vertex);
    std::vector<std::set<unsigned int>> held(constraints.size()); // vertices
    for (const auto &cell : mesh.active_cell_iterators())
      for (const unsigned int f : cell->face_indices()) {
        const auto &face = cell->face(f);
        if (!cell->is_locally_owned() || cell->material_id() != pair.body || !face->at_boundary())
          continue;
        for (std::size_t h = 0; h < constraints.size(); ++h)
          if (constraints[h].times.from < tool.removal_time() &&
              constrains_face(constraints[h], face, Constraint::rounding * face->diameter()))
            for (const unsigned int v : face->vertex_indices())
              if (std::abs(constraints[h].direction(face->vertex(v)) * tool.force_direction()) > along)
                held[h].insert(face->vertex_index(v));
      }
    for (std::size_t h = 0; h < constraints.size(); ++h) {
      std::vector<double> n{
          static_cast<double>(pressed.size()),
          static_cast<double>(std::count_if(held[h].begin(), held[h].end(),
                                            [&](const unsigned int v) { return pressed.count(v) > 0; }))};
      // Nodes of several ranks count more than once.
      dealii::Utilities::MPI::sum(n, communicator, n);
      if (n[1] == 0.)
        continue;
      std::ostringstream text;
      text.precision(3);
      text
          << "The " << constraints[h].name << " holds " << std::ceil(100. * n[1] / n[0])
          << " % of the nodes that the tool presses on first, along its 'Force direction'. There it, and not "
             "the body, bears the force of the tool";
      diagnostics.push_back(Diagnostic(diagnostic::support_takes_force, text.str())
                                .pair(pair.name)
                                .tool(tool.name())
                                .measure("part of the nodes", n[1] / n[0]));
    }
  }
}

void check_speeds(const Scene &scene, const Start &start, DiagnosticList &diagnostics) {
  // A bar that rebounds from a wall loses 16 % of its momentum in steps of 0.6 wave crossing times.
  // In steps of 0.3 it loses 7 %.
  constexpr double fast = 0.3, coarse = 0.35;
  const parameters::TimeStepping &steps = scene.parameters().time_stepping;
  double fastest_wave = 0.;
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    const Body &body = scene.bodies()[b];
    const double wave = std::sqrt(body.max_modulus / body.density);
    fastest_wave = std::max(fastest_wave, wave);
    if (start.speeds[b] > fast * wave)
      diagnostics.push_back(
          Diagnostic(diagnostic::implausible_speed,
                     ratio("The ratio of initial speed to elastic wave speed is", start.speeds[b] / wave))
              .body(body.name)
              .measure("speed / wave speed", start.speeds[b] / wave));
    const double crossing = start.sizes[b] / wave;
    if (steps.end_time < crossing)
      diagnostics.push_back(
          Diagnostic(diagnostic::run_shorter_than_wave,
                     ratio("The ratio of 'End time' to the time of an elastic wave through the body is",
                           steps.end_time / crossing))
              .body(body.name)
              .value("end time / crossing time", steps.end_time / crossing));
    if (scene.parameters().scheme().has_matrix && steps.control == parameters::TimeStepping::Control::fixed &&
        start.speeds[b] > 0. && scene.capabilities().contact && steps.initial_step > coarse * crossing)
      diagnostics.push_back(
          Diagnostic(diagnostic::step_longer_than_period,
                     ratio("The ratio of the step to the time of an elastic wave through the body is",
                           steps.initial_step / crossing))
              .body(body.name)
              .value("step / crossing time", steps.initial_step / crossing));
  }
  for (const Tool &tool : scene.tools()) {
    const double speed = follow(tool, steps.end_time).speed;
    if (speed > fast * fastest_wave)
      diagnostics.push_back(Diagnostic(diagnostic::implausible_speed,
                                       ratio("The ratio of the tool's speed to the elastic wave speed is",
                                             speed / fastest_wave))
                                .tool(tool.name())
                                .measure("speed / wave speed", speed / fastest_wave));
  }
}

bool have_common(const std::vector<unsigned int> &a, const std::vector<unsigned int> &b) {
  return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
}

/// Warns of bodies that take the same place, such as a copy whose volume was not changed.
void check_places(const Scene &scene, const Start &start, DiagnosticList &diagnostics) {
  constexpr double same = 1e-9;
  const auto are_same = [&](const std::size_t a, const std::size_t b) {
    return start.boxes[a].difference(start.boxes[b]) <= same * start.sizes[a] &&
           std::abs(start.volumes[a] - start.volumes[b]) <= same * start.volumes[a];
  };
  for (std::size_t a = 0; a < scene.bodies().size(); ++a)
    for (std::size_t b = a + 1; b < scene.bodies().size(); ++b)
      if (are_same(a, b))
        diagnostics.push_back(Diagnostic(bodies_coincide, "The body has the extent and volume of body '" +
                                                              scene.bodies()[a].name + "', at the same place")
                                  .body(scene.bodies()[b].name));
}

/// Warns of probes of the contact pressure where no pair has any: nodes of its first body alone
/// have one.
void check_pressure_probes(const Scene &of_run, DiagnosticList &diagnostics) {
  const parameters::Scene &scene = of_run.parameters();
  for (const parameters::Probe &probe : scene.probes) {
    if (!probe.probe.reads(ProbeQuantity::Kind::contact_pressure))
      continue;
    const std::size_t body = scene.body_index(probe);
    const bool has_faces = probe.probe.has_faces();
    std::string of_second; // pair in which the probe's faces are the second ones
    bool has_pressure = false;
    const auto has_faces_of = [&](const std::size_t pair_body, const std::vector<unsigned int> &ids) {
      return pair_body == body && (!has_faces || have_common(ids, probe.boundary_ids.value));
    };
    for (const ContactPair &pair : of_run.pairs())
      has_pressure = has_pressure || has_faces_of(pair.body, pair.boundary_ids);
    for (const BodyPair &pair : of_run.body_pairs()) {
      const bool has_second = has_faces_of(pair.bodies[1], pair.boundary_ids[1]);
      has_pressure = has_pressure || has_faces_of(pair.bodies[0], pair.boundary_ids[0]) ||
                     (has_second && pair.two_passes);
      if (has_second)
        of_second = pair.name;
    }
    if (has_pressure)
      continue;
    Diagnostic message(diagnostic::probe_without_contact,
                       "The probe '" + probe.name + "' reads a contact pressure of 0 " +
                           (of_second.empty()
                                ? "where no pair has its 'Boundary ids'"
                                : "on the second body of a pair, where no pressure is computed"));
    message.body(scene.bodies[body].name).pair(of_second).origin(probe.origin);
    if (!of_second.empty())
      message.advice("Probe the faces of the pair's 'Body', on which the same pressure acts, swap 'Body' and "
                     "'Second body', or set 'Passes = two'");
    diagnostics.push_back(message);
  }
}

} // namespace

double borne_force(const Body &body, const double section) {
  constexpr double strain = 1.;
  const FlowStress *flow = body.law->flow_stress();
  return section * (flow != nullptr ? flow->stress(strain) : body.young_modulus * strain);
}

DiagnosticList check_plausibility(const Scene &scene, const Triangulation<3> &mesh,
                                  const MPI_Comm communicator) {
  const Start start = measure_start(scene, mesh, communicator);
  DiagnosticList diagnostics;
  for (const Body &body : scene.bodies())
    check_yield_stress(body, diagnostics);
  append(diagnostics, check_user_laws(scene));
  append(diagnostics, check_heating(scene));
  append(diagnostics, check_mirrored_laws(scene));
  append(diagnostics, check_course(scene));
  append(diagnostics, check_turning_supports(scene, mesh, communicator));
  check_places(scene, start, diagnostics);
  append(diagnostics, check_tools_of_sections(scene, mesh, communicator));
  append(diagnostics, check_loads_of_sections(scene, mesh, communicator));
  if (scene.parameters().scheme().has_inertia)
    check_speeds(scene, start, diagnostics);
  if (!scene.parameters().scheme().has_matrix)
    check_number_of_steps(scene, start, diagnostics);
  for (const auto &pair : scene.parameters().pairs)
    check_friction(pair, diagnostics);
  for (std::size_t t = 0; t < scene.tools().size(); ++t) {
    check_motion(scene, scene.tools()[t], start.size, diagnostics);
    check_force(scene, t, start, diagnostics);
  }
  check_constrained_nodes(scene, mesh, communicator, diagnostics);
  check_pressure_probes(scene, diagnostics);
  constexpr double deep = 2.;
  for (std::size_t p = 0; p < scene.pairs().size(); ++p)
    if (start.penetrations[p] > deep)
      diagnostics.push_back(
          Diagnostic(diagnostic::starts_behind_tool,
                     ratio("The initial penetration of nodes into the tool, in facet sizes, is",
                           start.penetrations[p]))
              .pair(scene.pairs()[p].name)
              .tool(scene.tools()[scene.pairs()[p].tool].name())
              .measure("depth [facet sizes]", start.penetrations[p]));
  return diagnostics;
}

ThinPart measure_thin_part(const Triangulation<3> &mesh, const std::vector<Constraint> &constraints) {
  constexpr double thin = 0.1;
  Box box;
  for (const auto &vertex : mesh.get_vertices())
    box.add(vertex);
  ThinPart result;
  double whole_area = 0., thickness_sum = 0.;
  // A face that is constrained to a plane cannot bend, nor can the part below it.
  const auto is_held = [&](const Triangulation<3>::active_face_iterator &face) {
    const Tensor<1, 3> area =
        dealii::cross_product_3d(face->vertex(3) - face->vertex(0), face->vertex(2) - face->vertex(1));
    constexpr double along = 0.99;
    return std::any_of(constraints.begin(), constraints.end(), [&](const Constraint &constraint) {
      return std::abs(constraint.direction(face->center()) * area) > along * area.norm() &&
             constrains_face(constraint, face, Constraint::rounding * box.diagonal());
    });
  };
  for (const auto &start : mesh.active_cell_iterators())
    for (const unsigned int first : start->face_indices()) {
      if (!start->face(first)->at_boundary())
        continue;
      const auto &face = start->face(first);
      const double area = face->measure();
      double thickness = 0.;
      unsigned int layers = 0;
      auto cell = start;
      bool is_free = !is_held(face);
      for (unsigned int f = first;;) {
        const unsigned int opposite = dealii::GeometryInfo<3>::opposite_face[f];
        thickness += cell->face(f)->center().distance(cell->face(opposite)->center());
        ++layers;
        if (cell->at_boundary(opposite) || layers > mesh.n_active_cells()) {
          is_free = is_free && !is_held(cell->face(opposite));
          break;
        }
        f = cell->neighbor_of_neighbor(opposite);
        cell = cell->neighbor(opposite);
      }
      if (is_free)
        whole_area += area;
      if (!is_free || thickness > thin * box.diagonal())
        continue;
      const double along =
          std::max(0.5 * (face->vertex(1) + face->vertex(3) - face->vertex(0) - face->vertex(2)).norm(),
                   0.5 * (face->vertex(2) + face->vertex(3) - face->vertex(0) - face->vertex(1)).norm());
      result.area += area;
      result.mean_layers += area * layers;
      result.mean_aspect += area * along * layers / thickness;
      thickness_sum += area * thickness;
    }
  if (result.area > 0.) {
    result.mean_layers /= result.area;
    result.mean_aspect /= result.area;
    result.slenderness = box.diagonal() * result.area / thickness_sum;
    result.area /= whole_area;
  }
  return result;
}

DiagnosticList check_bricks(const Scene &scene) {
  constexpr std::size_t too_many = 100000;
  constexpr double maximum = 0.5, enough_layers = 4., long_brick = 1.5;
  DiagnosticList diagnostics;
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    const Body &body = scene.bodies()[b];
    if (!body.formulation.element.may_lock_in_bending())
      continue;
    const parameters::Body &input = scene.parameters().bodies[b];
    Triangulation<3> outline, mesh;
    build_body_mesh(input, MeshDetail::outline, outline);
    if (count_full_elements(input.mesh, outline) > too_many)
      continue;
    build_body_mesh(input, MeshDetail::full, mesh);
    const ThinPart part = measure_thin_part(mesh, body.constraints);
    if (part.area < maximum || (part.mean_layers >= enough_layers && part.mean_aspect <= long_brick))
      continue;
    std::ostringstream text;
    text.precision(3);
    text << "The body is " << part.slenderness << " times as long as thick, and has " << part.mean_layers
         << (part.mean_layers == 1. ? " brick" : " bricks") << " through its thickness, which are "
         << part.mean_aspect << " times as long as high";
    diagnostics.push_back(Diagnostic(diagnostic::bricks_may_lock, text.str())
                              .body(body.name)
                              .value("layers", part.mean_layers)
                              .measure("aspect ratio", part.mean_aspect));
  }
  return diagnostics;
}

} // namespace billet
