// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/course_checks.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/times.h"

#include <cmath>
#include <sstream>

namespace billet {

namespace {

const DiagnosticKind unfinished_course(
    "unfinished-course", Severity::warning,
    "Something begins after the end of the run, or is not complete there. Examples are forces that fade, an "
    "initial penetration that ramps up, and a load with a late 'From'.",
    "Set a later 'End time', or shorter times");

/// Collects what is not complete at the end time.
class ToolCourse {
public:
  /// Part of the scene, such as a pair and its name.
  struct Part {
    std::string kind, name;
  };

  explicit ToolCourse(const double end) : end_(end) {}

  bool is_after_end(const double time) const { return times::is_after(time, end_); }
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

} // namespace

DiagnosticList check_course(const Scene &scene) {
  ToolCourse course(scene.parameters().time_stepping.end_time);
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
    const ToolCourse::Part where{"body", body.name};
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

} // namespace billet
