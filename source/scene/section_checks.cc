// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/section_checks.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/scene/section_geometry.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

namespace billet {

using dealii::Tensor;
using dealii::Triangulation;

namespace {

const DiagnosticKind tool_breaks_section(
    "tool-breaks-section", Severity::warning,
    "The gap to a tool differs, or the tool ends, along the width of a plane-strain section or around the "
    "axis of an axisymmetric one. Or a tool with friction moves along the width, across the "
    "axis, or turns about it. The section sees one place of it and takes it for all.",
    "Give the tool a surface and a motion that keep to the section, or model the solid");

const DiagnosticKind load_breaks_section(
    "load-breaks-section", Severity::warning,
    "A part of a load leaves the section. The sides of a plane-strain section bear what acts along its "
    "width. Those of an axisymmetric one bear what acts around the axis. What acts across the axis becomes "
    "radial, without a resultant on the full circle.",
    "Model the solid for such loads. For radial loads on an axisymmetric section use 'pressure', 'dead "
    "traction' with cylindrical 'Axes', or 'force' on a 'Point' or 'Nodes'");

const DiagnosticKind ring_force(
    "ring-force", Severity::note,
    "A force across the axis acts on a point or on nodes of an axisymmetric section. It acts radially all "
    "around the circle, on which it has no resultant.",
    "Nothing, if a radial force is meant; else model the solid");

constexpr double notable = 1e-3; // part of a length, or of a load

bool is_solid(const parameters::Body &body) {
  return body.mesh.section.value == parameters::Mesh::Section::solid;
}

/// Way in which a tool breaks a section.
enum class Break { gap, end, travel };

struct WorstBreak {
  double part = 0., time = 0.; ///< part of the length
  Break kind = Break::gap;

  void add(const WorstBreak &other) {
    if (other.part > part)
      *this = other;
  }
};

/// Returns words about what breaks a section.
std::string describe(const WorstBreak &worst, const SectionGeometry &section) {
  const bool is_turned = section.is_turned();
  std::ostringstream text;
  text.precision(2);
  switch (worst.kind) {
  case Break::gap:
    text << "The gap to the tool differs " << (is_turned ? "around the axis" : "along the width");
    break;
  case Break::travel:
    text << "The tool moves " << (is_turned ? "across the axis or turns about it" : "along the width");
    break;
  case Break::end:
    text << "The tool faces the section at some "
         << (is_turned ? "angles around the axis" : "places of the width")
         << ", and has an end before others";
    return text.str();
  }
  text << ", by " << worst.part << " of the " << (is_turned ? "radius" : "width");
  return text.str();
}

/// Tool at one of its places, seen from a section.
class SeenTool {
public:
  SeenTool(const Tool &tool, const Placement &placement, const SectionGeometry &section)
      : tool_(tool), placement_(placement), section_(section) {}

  /// Adds how the tool differs between the places that stand for a point of the section.
  void compare(const Tensor<1, 3> &x, const bool has_friction, const double time, WorstBreak &worst) const {
    const double length = section_.length(x);
    if (!(length > 0.))
      return;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    bool is_any_beyond = false; // the tool's end
    for (const Tensor<1, 3> &place : section_.places(x)) {
      const auto seen = tool_.surface().project(placement_.to_tool(place));
      if (seen.exists) {
        low = std::min(low, seen.gap);
        high = std::max(high, seen.gap);
      } else
        is_any_beyond = is_any_beyond || seen.beyond > notable * length;
    }
    if (!(low <= high)) // the tool faces none of them
      return;
    worst.add({(high - low) / length, time, Break::gap});
    if (is_any_beyond)
      worst.add({1., time, Break::end});
    if (has_friction)
      worst.add({sideways(x), time, Break::travel});
  }

private:
  /// Returns what the section does not allow of a tool's motion with friction, over the length at
  /// `x`.
  double sideways(const Tensor<1, 3> &x) const {
    const Tensor<1, 3> &travel = placement_.translation;
    return section_.is_turned()
               ? section_.across(travel).norm() / section_.length(x) +
                     std::abs(placement_.rotation_angle * tool_.rotation_axis() * section_.direction())
               : std::abs(travel * section_.direction()) / section_.length(x);
  }

  const Tool &tool_;
  const Placement &placement_;
  const SectionGeometry &section_;
};

/// Calls visit(face) for this rank's boundary faces of a body with these ids.
template <class Visit>
void for_each_section_face(const Triangulation<3> &mesh, const std::size_t body,
                           const std::vector<dealii::types::boundary_id> &ids, const Visit &visit) {
  for (const auto &cell : mesh.active_cell_iterators())
    if (cell->is_locally_owned() && cell->material_id() == body)
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() && std::find(ids.begin(), ids.end(), face->boundary_id()) != ids.end())
          visit(face);
}

/// Returns the undeformed vertices of a pair's faces on this rank, each once, and the centres of
/// the faces.
std::vector<dealii::Point<3>> collect_points(const ContactPair &pair, const Triangulation<3> &mesh) {
  std::vector<bool> is_taken(mesh.n_vertices(), false);
  std::vector<dealii::Point<3>> points;
  for_each_section_face(mesh, pair.body, pair.boundary_ids, [&](const auto &face) {
    points.push_back(face->center());
    for (const unsigned int v : face->vertex_indices())
      if (!is_taken[face->vertex_index(v)]) {
        is_taken[face->vertex_index(v)] = true;
        points.push_back(face->vertex(v));
      }
  });
  return points;
}

/// Replaces a value by that of the rank where the first is largest. Collective.
WorstBreak find_worst(const WorstBreak &own, const MPI_Comm communicator) {
  const auto max = [&](const double value) { return dealii::Utilities::MPI::max(value, communicator); };
  WorstBreak worst;
  worst.part = max(own.part);
  const bool is_here = own.part == worst.part;
  worst.time = max(is_here ? own.time : 0.);
  worst.kind = static_cast<Break>(static_cast<int>(max(is_here ? static_cast<double>(own.kind) : 0.)));
  return worst;
}

} // namespace

DiagnosticList check_tools_of_sections(const Scene &scene, const Triangulation<3> &mesh,
                                       const MPI_Comm communicator) {
  DiagnosticList diagnostics;
  const double end = scene.parameters().time_stepping.end_time;
  for (const ContactPair &pair : scene.pairs()) {
    const parameters::Body &body = scene.parameters().bodies[pair.body];
    if (is_solid(body))
      continue;
    const SectionGeometry section(body.mesh);
    const Tool &tool = scene.tools()[pair.tool];
    const auto points = collect_points(pair, mesh);
    WorstBreak own;
    std::vector<double> times = {0.};
    if (tool.control() != Tool::Control::force)
      times.insert(times.end(), {0.5 * end, end});
    for (const double time : times) {
      Placement placement;
      try {
        placement = tool.placement(time);
      } catch (const SolutionFailure &) { // the run will report it
        break;
      }
      const SeenTool seen(tool, placement, section);
      for (const auto &point : points)
        seen.compare(point, pair.has_friction(), time, own);
    }
    const WorstBreak worst = find_worst(own, communicator);
    if (worst.part > notable)
      diagnostics.push_back(Diagnostic(tool_breaks_section, describe(worst, section))
                                .pair(pair.name)
                                .tool(tool.name())
                                .time(worst.time)
                                .measure("part", worst.part));
  }
  return diagnostics;
}

namespace {

/// Sizes of a load on a section: of all of it, of what leaves the section, and of what is radial.
struct LoadParts {
  double whole = 0., out = 0., radial = 0.;

  void add(const double of_whole, const double of_out, const double of_radial = 0.) {
    whole = std::max(whole, of_whole);
    out = std::max(out, of_out);
    radial = std::max(radial, of_radial);
  }
};

/// Measures what of a load leaves the section, at one time.
class LoadOnSection {
public:
  LoadOnSection(const AppliedLoad &load, const std::size_t body, const Triangulation<3> &mesh,
                const SectionGeometry &section)
      : load_(load), body_(body), mesh_(mesh), section_(section) {}

  LoadParts measure(const double time) const {
    LoadParts parts;
    std::visit([&](const auto &action) { add(*action, time, parts); }, load_.load.action);
    return parts;
  }

private:
  void add(const BodyLoad &action, const double time, LoadParts &parts) const {
    const Tensor<1, 3> force = action.acceleration(values(time, {}).data());
    parts.add(force.norm(),
              section_.is_turned() ? section_.across(force).norm() : std::abs(force * section_.direction()));
  }
  /// The force turns with the sides of a wedge.
  void add(const PointLoad &action, const double time, LoadParts &parts) const {
    const Tensor<1, 3> force = action.force(values(time, {}).data());
    if (section_.is_turned())
      parts.add(force.norm(), std::abs(force * section_.circumference()), section_.across(force).norm());
    else
      parts.add(force.norm(), std::abs(force * section_.direction()));
  }
  /// Pressures turn with the faces.
  void add(const FaceLoad & /*action*/, const double /*time*/, LoadParts & /*parts*/) const {}
  void add(const NodalLoad &action, const double time, LoadParts &parts) const {
    for_each_section_face(mesh_, body_, load_.boundary_ids, [&](const auto &face) {
      const dealii::Point<3> centre = face->center();
      const std::vector<double> at_face = values(time, centre);
      const Tensor<1, 3> force = force_at(action, centre, at_face);
      if (!section_.is_turned()) {
        parts.add(force.norm(), std::abs(force * section_.direction()));
        return;
      }
      // A quarter of the circle further, what belongs to the section is turned as much.
      const double quarter = 0.5 * M_PI;
      const Tensor<1, 3> there =
          force_at(action, dealii::Point<3>(section_.turned(centre, quarter)), at_face);
      parts.add(force.norm(), std::max(std::abs(force * section_.circumference(centre)),
                                       M_SQRT1_2 * (there - section_.turn(quarter) * force).norm()));
    });
  }
  /// A moment about the circumference belongs to a wedge: that at any of its angles.
  void add(const SurfaceLoad &action, const double time, LoadParts &parts) const {
    const Tensor<1, 3> moment = moment_of(action, values(time, {}));
    const Tensor<1, 3> across = section_.across(moment);
    if (!section_.is_turned()) {
      parts.add(moment.norm(), across.norm());
      return;
    }
    const Tensor<1, 3> along = section_.circumference();
    const Tensor<1, 3> radial = dealii::cross_product_3d(along, section_.direction());
    const double sign = across * along < 0. ? -1. : 1.;
    const double angle = std::atan2(-sign * (across * radial), sign * (across * along));
    const double beyond = std::max({0., -angle, angle - section_.angle()});
    parts.add(moment.norm(), std::max(std::abs(moment * section_.direction()),
                                      across.norm() * std::sin(std::min(beyond, 0.5 * M_PI))));
  }

  std::vector<double> values(const double time, const dealii::Point<3> &x) const {
    std::vector<double> result;
    for (const Expression &expression : load_.expressions)
      result.push_back(expression.is_uniform() ? expression.value(time) : expression.value(time, x));
    return result;
  }
  /// Returns the force on a face of unit area with its centre at `x`, at rest.
  static Tensor<1, 3> force_at(const NodalLoad &action, const dealii::Point<3> &x,
                               const std::vector<double> &values) {
    LoadedSurface surface;
    surface.area = 1.;
    surface.centre = x;
    LoadValues of_site(values.size(), 1, true);
    std::copy(values.begin(), values.end(), of_site.at(0));
    const std::array<double, nodal_stride> zero{};
    std::array<double, nodal_stride> force{};
    action.add_forces({{0, 1., Tensor<1, 3>({1., 0., 0.}), x, &surface}}, of_site,
                      {zero.data(), zero.data(), zero.data()}, force.data());
    return get_vector(force.data(), 0);
  }
  /// Returns the moment of a load on a surface at rest. With J = I its force on the share p is
  /// m × p, and Σ e × (m × e) = 2 m over the unit vectors e.
  static Tensor<1, 3> moment_of(const SurfaceLoad &action, const std::vector<double> &values) {
    LoadedSurface surface;
    surface.area = 1.;
    surface.stiffness = 1.;
    surface.motion.second_moment = surface.motion.rotation = surface.motion.turning =
        dealii::unit_symmetric_tensor<3>();
    Tensor<1, 3> moment;
    for (unsigned int i = 0; i < 3; ++i) {
      Tensor<1, 3> e;
      e[i] = 1.;
      moment += 0.5 * dealii::cross_product_3d(e, action.force({1., e, e}, values.data(), surface));
    }
    return moment;
  }

  const AppliedLoad &load_;
  std::size_t body_;
  const Triangulation<3> &mesh_;
  const SectionGeometry &section_;
};

/// Returns times at which a load acts, from its beginning to its end or that of the run.
std::vector<double> times_of(const LoadTimes &times, const double end) {
  constexpr unsigned int n = 8;
  const double until = std::min(times.until, end);
  std::vector<double> result;
  for (unsigned int i = 0; i <= n && times.from <= until; ++i)
    result.push_back(times.from + i * (until - times.from) / n);
  return result;
}

} // namespace

DiagnosticList check_loads_of_sections(const Scene &scene, const Triangulation<3> &mesh,
                                       const MPI_Comm communicator) {
  DiagnosticList diagnostics;
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    const parameters::Body &body = scene.parameters().bodies[b];
    if (is_solid(body))
      continue;
    const SectionGeometry section(body.mesh);
    for (const AppliedLoad &load : scene.bodies()[b].loads) {
      LoadParts own;
      for (const double time : times_of(load.times, scene.parameters().time_stepping.end_time))
        try {
          const LoadParts parts = LoadOnSection(load, b, mesh, section).measure(time);
          own.add(parts.whole, parts.out, parts.radial);
        } catch (const SolutionFailure &) { // the run will report it
          break;
        }
      std::vector<double> max = {own.whole, own.out, own.radial};
      dealii::Utilities::MPI::max(max, communicator, max);
      const auto add = [&](const DiagnosticKind &kind, const double part, const std::string &direction) {
        std::ostringstream text;
        text.precision(3);
        text << "Load '" << load.name << "' has a part " << direction << ": " << 100. * part << " % of it";
        diagnostics.push_back(Diagnostic(kind, text.str()).body(body.name).measure("part", part));
      };
      if (max[1] > notable * max[0])
        add(load_breaks_section, max[1] / max[0],
            section.is_turned() ? "across the axis or around it" : "that leaves the section");
      else if (max[2] > notable * max[0])
        add(ring_force, max[2] / max[0], "across the axis");
    }
  }
  return diagnostics;
}

} // namespace billet
