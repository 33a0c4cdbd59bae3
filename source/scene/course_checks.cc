// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/course_checks.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"

#include <deal.II/base/mpi.h>
#include <deal.II/physics/transformations.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

using dealii::Tensor;
using dealii::Triangulation;

namespace {

const DiagnosticKind unfinished_course(
    "unfinished-course", Severity::warning,
    "Something begins after the end of the run, or is not complete there. Examples are forces that fade, an "
    "initial penetration that ramps up, and a load with a late 'From'.",
    "Set a later 'End time', or shorter times");

const DiagnosticKind tool_breaks_section(
    "tool-breaks-section", Severity::warning,
    "The gap to a tool differs along the width of a plane-strain section, or around the axis of an "
    "axisymmetric one. Or a tool with friction moves along the width, across the axis, or turns about it. "
    "The section sees one place of it and takes it for all.",
    "Give the tool a surface and a motion that keep to the section, or model the solid");

constexpr double rounding = 1e-9;

/// Collects what is not complete at the end time.
class Course {
public:
  /// Part of the scene, such as a pair and its name.
  struct Part {
    std::string kind, name;
  };

  explicit Course(const double end) : end_(end) {}

  bool is_after_end(const double time) const { return time > end_ * (1. + rounding); }
  /// Something that begins at a time.
  void begin(const Part &where, const std::string &what, const double from) {
    if (is_after_end(from))
      add(where, what + " begins at time " + print(from) + ", after 'End time', and never acts", from);
  }
  /// Forces that fade after a time.
  void fade(const Part &where, const std::string &what, const double until, const double fade_time) {
    if (std::isfinite(until) && !is_after_end(until) && is_after_end(until + fade_time))
      add(where,
          "The forces of " + what + " fade until time " + print(until + fade_time) +
              ", after 'End time': at the end " + print(100. * (1. - (end_ - until) / fade_time)) +
              " % of them still act",
          until + fade_time);
  }
  void ramp(const Part &where, const double ramp_time) {
    if (is_after_end(ramp_time))
      add(where,
          "The initial penetration of the pair ramps up until time " + print(ramp_time) +
              ", after 'End time': at the end " + print(100. * end_ / ramp_time) + " % of it count",
          ramp_time);
  }

  DiagnosticList diagnostics;

private:
  static std::string print(const double number) {
    std::ostringstream text;
    text.precision(3);
    text << number;
    return text.str();
  }
  void add(const Part &where, const std::string &text, const double time) {
    diagnostics.push_back(Diagnostic(unfinished_course, text)
                              .part(where.kind, where.name)
                              .topic(text)
                              .measure("time", time)
                              .value("end time", end_));
  }

  double end_;
};

/// Returns what turns a point of a section into another of the same solid: half a turn about its axis, or its
/// width.
class Twin {
public:
  explicit Twin(const parameters::Mesh &mesh)
      : is_turned_(mesh.section.value == parameters::Mesh::Section::axisymmetric),
        direction_(mesh.rotated(Tensor<1, 3>({0., 0., 1.}))), origin_(mesh.translation),
        width_(mesh.scale * mesh.height) {}

  Tensor<1, 3> of(const Tensor<1, 3> &x) const {
    if (!is_turned_)
      return x + width_ * direction_;
    const Tensor<1, 3> arm = x - origin_, along = (arm * direction_) * direction_;
    return origin_ + 2. * along - arm;
  }
  /// Returns the length that a difference of gaps is compared with: the radius, or the width.
  double length(const Tensor<1, 3> &x) const {
    const Tensor<1, 3> arm = x - origin_;
    return is_turned_ ? (arm - (arm * direction_) * direction_).norm() : width_;
  }
  /// Returns what the section does not allow of a tool's motion with friction, over the length of `x`: travel
  /// along the width or across the axis, and turns about the axis. `turn`: a rotation vector [radians].
  double sideways(const Tensor<1, 3> &travel, const Tensor<1, 3> &turn, const Tensor<1, 3> &x) const {
    const double along = travel * direction_;
    return is_turned_ ? (travel - along * direction_).norm() / length(x) + std::abs(turn * direction_)
                      : std::abs(along) / length(x);
  }
  /// Returns words about a difference of gaps, or about a travel sideways.
  std::string describe(const bool is_travel) const {
    return is_travel ? std::string("The tool moves ") +
                           (is_turned_ ? "across the axis or turns about it" : "along the width")
                     : std::string("The gap to the tool differs ") +
                           (is_turned_ ? "half around the axis" : "across the width");
  }

private:
  bool is_turned_;
  Tensor<1, 3> direction_, origin_;
  double width_;
};

} // namespace

DiagnosticList check_course(const Scene &scene) {
  Course course(scene.parameters().time_stepping.end_time);
  for (const Tool &tool : scene.tools())
    course.fade({"tool", tool.name()}, "the tool after its removal", tool.removal_time(),
                tool.release_time());
  const auto add_ramp = [&](const PairSettings &pair, const InitialOverlap &overlap) {
    course.ramp({"pair", pair.name}, overlap.ramp_time);
  };
  for (const ContactPair &pair : scene.pairs())
    add_ramp(pair, pair.overlap);
  for (const BodyPair &pair : scene.body_pairs())
    add_ramp(pair, pair.overlap);
  for (const parameters::Body &body : scene.parameters().bodies) {
    const Course::Part where{"body", body.name};
    const auto add = [&](const auto &of, const std::string &what) {
      course.begin(where, "The " + what, of.from);
      course.fade(where, "the " + what, of.until, of.fade_time.value_or(0.));
    };
    for (const parameters::Support &support : body.supports)
      add(support, "support '" + support.name + "'");
    for (const parameters::Load &load : body.loads)
      add(load, "load '" + load.name + "'");
  }
  return course.diagnostics;
}

DiagnosticList check_sections(const Scene &scene, const Triangulation<3> &mesh, const MPI_Comm communicator) {
  constexpr double notable = 1e-3;
  DiagnosticList diagnostics;
  struct Worst {
    double part = 0., time = 0.; ///< part of the length
    bool is_travel = false;
  };
  std::vector<Worst> worst(scene.pairs().size());
  for (std::size_t p = 0; p < scene.pairs().size(); ++p) {
    const ContactPair &pair = scene.pairs()[p];
    const parameters::Mesh &section = scene.parameters().bodies[pair.body].mesh;
    if (section.section.value == parameters::Mesh::Section::solid)
      continue;
    const Twin twin(section);
    const Tool &tool = scene.tools()[pair.tool];
    const double end = scene.parameters().time_stepping.end_time;
    const auto add = [&](const double part, const double time, const bool is_travel) {
      if (part > worst[p].part)
        worst[p] = {part, time, is_travel};
    };
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
      for (const auto &cell : mesh.active_cell_iterators())
        for (const unsigned int f : cell->face_indices()) {
          const auto &ids = pair.boundary_ids;
          const auto face = cell->face(f);
          if (!cell->is_locally_owned() || cell->material_id() != pair.body || !face->at_boundary() ||
              std::find(ids.begin(), ids.end(), face->boundary_id()) == ids.end())
            continue;
          for (const unsigned int v : face->vertex_indices()) {
            const Tensor<1, 3> x = face->vertex(v), y = twin.of(x);
            const auto here = tool.surface().project(placement.to_tool(x)),
                       there = tool.surface().project(placement.to_tool(y));
            const double length = twin.length(x);
            if (!(length > 0.))
              continue;
            if (here.exists && there.exists)
              add(std::abs(here.gap - there.gap) / length, time, false);
            if (here.exists && pair.has_friction())
              add(twin.sideways(placement.translation, placement.rotation_angle * tool.rotation_axis(), x),
                  time, true);
          }
        }
    }
  }
  for (std::size_t p = 0; p < scene.pairs().size(); ++p) {
    const ContactPair &pair = scene.pairs()[p];
    const double part = dealii::Utilities::MPI::max(worst[p].part, communicator);
    const bool is_worst = worst[p].part == part;
    const double time = dealii::Utilities::MPI::max(is_worst ? worst[p].time : 0., communicator);
    const bool is_travel =
        dealii::Utilities::MPI::max(is_worst && worst[p].is_travel ? 1U : 0U, communicator) > 0;
    if (!(part > notable))
      continue;
    const parameters::Mesh &section = scene.parameters().bodies[pair.body].mesh;
    std::ostringstream text;
    text.precision(2);
    text << Twin(section).describe(is_travel) << ", by " << part << " of the "
         << (section.section.value == parameters::Mesh::Section::axisymmetric ? "radius" : "width");
    diagnostics.push_back(Diagnostic(tool_breaks_section, text.str())
                              .pair(pair.name)
                              .tool(scene.tools()[pair.tool].name())
                              .time(time)
                              .measure("part", part));
  }
  return diagnostics;
}

} // namespace billet
