// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/scene_report_text.h"

#include "billet/contact/sheet_penalty.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <sstream>

namespace billet {

using dealii::Tensor;
using Json = nlohmann::ordered_json;

namespace {

/// Returns the number in six digits; 0 if only round-off of numbers of this size is left.
std::string number(const double value, const double size = 0.) {
  constexpr double rounding = 1e-12;
  std::ostringstream text;
  text << (std::abs(value) <= rounding * size ? 0. : value);
  return text.str();
}

std::string vector(const Tensor<1, 3> &x, const double size) {
  return "(" + number(x[0], size) + ", " + number(x[1], size) + ", " + number(x[2], size) + ")";
}

std::string count(const std::size_t n, const std::string &what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

/// Returns the start of a line: its label, up to the column of the texts.
std::string label(const std::string &what) {
  constexpr std::size_t column = 15;
  return what + std::string(column - what.size(), ' ');
}

/// Returns the largest coordinate of a body.
double size_of(const BodyReport &body) { return std::max(body.low.norm(), body.high.norm()); }

double size_of(const SceneReport &report) {
  double size = 0.;
  for (const BodyReport &body : report.bodies)
    size = std::max(size, size_of(body));
  return size;
}

void print(const BoundaryReport &boundary, const BodyReport &body, std::ostream &stream) {
  stream << label("Boundary") << body.name << " " << boundary.id;
  std::string names;
  for (const std::string &name : boundary.names)
    names += (names.empty() ? "" : ", ") + name;
  constexpr double flat = 1. - 1e-9;
  stream << (names.empty() ? "" : " (" + names + ")") << ": " << count(boundary.n_faces, "face") << ", area "
         << number(boundary.area) << ", centre " << vector(boundary.centre, size_of(body));
  if (boundary.flatness > 0.)
    stream << (boundary.flatness < flat ? ", mean normal " : ", normal ") << vector(boundary.normal, 1.)
           << "\n";
  else
    stream << ", closed: no normal\n";
}

void print(const BodyReport &body, std::ostream &stream) {
  const double size = size_of(body);
  stream << label("Geometry") << body.name << ": ";
  for (unsigned int i = 0; i < 3; ++i)
    stream << (i > 0 ? ", " : "") << "xyz"[i] << " " << number(body.low[i], size) << " to "
           << number(body.high[i], size);
  stream << "; volume " << number(body.volume)
         << (body.mass > 0. ? ", mass " + number(body.mass) : ", no mass without 'Density'") << "\n";
  if (body.circle_factor > 1.)
    stream << label("") << "the full circle has " << number(body.circle_factor) << " times that: volume "
           << number(body.circle_factor * body.volume)
           << (body.mass > 0. ? ", mass " + number(body.circle_factor * body.mass) : "")
           << "; forces in the scene are those of the wedge\n";
  constexpr double much = 5e-3; // of the volume
  if (const double lacks = body.smooth_volume ? 1. - body.volume / *body.smooth_volume : 0.;
      std::abs(lacks) > much)
    stream << label("") << "its facets make it " << std::round(1e3 * std::abs(lacks)) / 10. << " % too "
           << (lacks > 0. ? "small" : "large") << ": the smooth shape has volume "
           << number(*body.smooth_volume) << "\n";
  stream << label("") << count(body.n_elements, "element") << ", " << count(body.n_nodes, "node") << ", "
         << count(body.n_parts, "part") << "; edges " << number(body.min_edge) << " to "
         << number(body.max_edge) << ", mean " << number(body.mean_edge) << "; least scaled Jacobian "
         << number(body.min_quality, 1.) << ", at " << vector(body.worst_element, size) << "\n";
  for (const BoundaryReport &boundary : body.boundaries)
    print(boundary, body, stream);
}

void print(const PairReport &pair, const double size, std::ostream &stream) {
  stream << label("Gap") << pair.name << ": ";
  if (pair.is_self_contact) {
    stream << "not measured in self-contact\n";
    return;
  }
  const GapReport &gap = pair.gap;
  if (gap.n_facing > 0)
    stream << "least " << number(gap.least, size) << " at " << vector(gap.nearest, size) << ", mean "
           << number(gap.mean, size) << " over " << gap.n_facing << " of " << count(gap.n_nodes, "node");
  else
    stream << "none of " << count(gap.n_nodes, "node") << " is in front of the other surface";
  stream << "\n" << label("");
  const char *motions = "by the prescribed motions";
  if (pair.meeting && pair.meeting->time > 0.)
    stream << (pair.meeting->n_nodes == 1 ? "1 node meets" : count(pair.meeting->n_nodes, "node") + " meet")
           << " at time " << number(pair.meeting->time) << " " << motions << ", first "
           << vector(pair.meeting->first, size);
  else if (pair.meeting)
    stream << (pair.meeting->n_nodes == 1 ? "1 node touches"
                                          : count(pair.meeting->n_nodes, "node") + " touch")
           << " at the start, first " << vector(pair.meeting->first, size);
  else
    stream << "never meets " << motions << ", which leave a body at rest that others push";
  stream << (pair.depends_on_forces ? "; loads, driven tools or deformation may change that\n" : "\n");
  if (pair.is_sheet)
    stream << label("Penalty") << pair.name << ": may fall to " << sheet_penalty
           << " E/h, since the body is a thin sheet\n";
}

void print(const RunReport &run, const double size, std::ostream &stream) {
  constexpr double megabyte = 1e6;
  stream << label("Run") << run.n_dofs << " dofs, about " << std::ceil(run.memory / megabyte)
         << " MB of memory";
  if (run.n_steps > 0.)
    stream << (run.is_minimum ? ", at least " : ", about ") << number(run.n_steps)
           << (run.n_steps == 1. ? " step" : " steps")
           << (run.max_steps > 0. ? ", up to " + number(run.max_steps) + " if contact lasts" : "")
           << (run.stable_step ? ", more if elements shrink\n" : "\n");
  else
    stream << ", number of steps unknown: the forces at the start fail\n";
  if (!run.stable_step)
    return;
  const StableStepReport &stable = *run.stable_step;
  stream << label("Stable step") << number(stable.of_elements) << " of the elements, set by that of '"
         << stable.body << "' at " << vector(stable.element, size) << " with its least edge "
         << number(stable.min_edge) << "\n"
         << label("") << "first steps " << number(stable.step);
  if (stable.shortest < stable.step)
    stream << ", by contact " << number(stable.shortest) << " from time " << number(stable.shortest_from);
  if (stable.is_short_by_contact)
    stream << "\n"
           << label("")
           << "'Profile = fast', 'Contact resolution = 1' or a lower 'Normal penalty' make steps longer";
  stream << "\n";
}

Json to_json(const Tensor<1, 3> &x) { return Json::array({x[0], x[1], x[2]}); }

Json to_json(const BodyReport &body) {
  Json boundaries = Json::array();
  for (const BoundaryReport &boundary : body.boundaries)
    boundaries.push_back({{"id", boundary.id},
                          {"names", boundary.names},
                          {"faces", boundary.n_faces},
                          {"area", boundary.area},
                          {"centre", to_json(boundary.centre)},
                          {"normal", to_json(boundary.normal)},
                          {"flatness", boundary.flatness}});
  return {{"name", body.name},
          {"elements", body.n_elements},
          {"nodes", body.n_nodes},
          {"parts", body.n_parts},
          {"low", to_json(body.low)},
          {"high", to_json(body.high)},
          {"volume", body.volume},
          {"mass", body.mass},
          {"smooth volume", body.smooth_volume ? Json(*body.smooth_volume) : Json()},
          {"full circle factor", body.circle_factor},
          {"least edge", body.min_edge},
          {"mean edge", body.mean_edge},
          {"largest edge", body.max_edge},
          {"least scaled Jacobian", body.min_quality},
          {"worst element", to_json(body.worst_element)},
          {"boundaries", boundaries}};
}

Json to_json(const PairReport &pair) {
  Json object = {{"name", pair.name}};
  if (pair.is_self_contact) {
    object["gap"] = nullptr;
    return object;
  }
  if (pair.is_sheet)
    object["sheet penalty"] = sheet_penalty;
  object["gap"] = {{"nodes", pair.gap.n_nodes}, {"facing", pair.gap.n_facing}};
  if (pair.gap.n_facing > 0) {
    object["gap"]["least"] = pair.gap.least;
    object["gap"]["mean"] = pair.gap.mean;
    object["gap"]["nearest"] = to_json(pair.gap.nearest);
  }
  if (pair.meeting)
    object["meeting"] = {{"time", pair.meeting->time},
                         {"nodes", pair.meeting->n_nodes},
                         {"first", to_json(pair.meeting->first)}};
  else
    object["meeting"] = "never";
  object["depends on forces"] = pair.depends_on_forces;
  return object;
}

Json to_json(const RunReport &run) {
  Json object = {{"dofs", run.n_dofs}, {"memory", run.memory}};
  if (run.n_steps > 0.) {
    object["steps"] = run.n_steps;
    object["steps are a minimum"] = run.is_minimum;
    if (run.max_steps > 0.)
      object["steps if contact lasts"] = run.max_steps;
  }
  if (run.stable_step)
    object["stable step"] = {{"of elements", run.stable_step->of_elements},
                             {"body", run.stable_step->body},
                             {"element", to_json(run.stable_step->element)},
                             {"least edge", run.stable_step->min_edge},
                             {"first steps", run.stable_step->step},
                             {"shortest steps", run.stable_step->shortest},
                             {"shortest steps from", run.stable_step->shortest_from}};
  return object;
}

} // namespace

void print(const SceneReport &report, std::ostream &stream) {
  const double size = size_of(report);
  for (const BodyReport &body : report.bodies)
    print(body, stream);
  for (const PairReport &pair : report.pairs)
    print(pair, size, stream);
  if (report.run)
    print(*report.run, size, stream);
}

std::string describe_as_json(const SceneReport &report) {
  Json object;
  object["bodies"] = Json::array();
  for (const BodyReport &body : report.bodies)
    object["bodies"].push_back(to_json(body));
  object["pairs"] = Json::array();
  for (const PairReport &pair : report.pairs)
    object["pairs"].push_back(to_json(pair));
  if (report.run)
    object["run"] = to_json(*report.run);
  return object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace billet
