// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/unbalanced_bodies.h"

#include "billet/diagnostic_kinds.h"
#include "billet/discretization/body_volumes.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

using dealii::Tensor;

UnbalancedBodies::UnbalancedBodies(const Scene &scene, const Discretization &discretization)
    : scene_(scene), round_off_(find_round_off(scene, discretization)), bodies_(scene.bodies().size()) {
  for (const NamedSupport &support : named_supports(scene))
    bodies_of_supports_.push_back(support.body);
}

std::vector<double> UnbalancedBodies::find_round_off(const Scene &scene,
                                                     const Discretization &discretization) {
  constexpr double rounding = 1e-14;
  const std::vector<double> volumes = measure_body_volumes(discretization);
  std::vector<double> result;
  for (std::size_t b = 0; b < volumes.size(); ++b) {
    const Body &body = scene.bodies()[b];
    const auto n_own = static_cast<double>(discretization.elements(b).size());
    const double n = dealii::Utilities::MPI::sum(n_own, discretization.communicator());
    LoadedSurface surface;
    surface.stiffness = body.young_modulus / std::cbrt(volumes[b] / n);
    double stiffness = body.young_modulus / std::cbrt(volumes[b]); // per area
    for (const AppliedLoad &load : body.loads)
      stiffness += load.load.properties().bound(surface).stiffness;
    result.push_back(rounding * stiffness * volumes[b]);
  }
  return result;
}

double UnbalancedBodies::least_force(const double round_off, const double nodal,
                                     const parameters::Solver &settings) {
  constexpr double of_tolerance = 0.1;
  return std::max(round_off, of_tolerance * settings.force_tolerance * nodal);
}

void UnbalancedBodies::add(const Solution &solution) {
  const Reactions &reactions = solution.reactions();
  if (reactions.of_bodies.empty())
    return;
  const auto reported = [this](const std::size_t body, const Tensor<1, 3> &force) {
    for (unsigned int i = 0; i < 3; ++i) {
      double &largest = bodies_[body].axes[i].force;
      largest = std::max(largest, std::abs(force[i]));
    }
  };
  for (std::size_t s = 0; s < bodies_of_supports_.size(); ++s)
    reported(bodies_of_supports_[s], reactions.of_supports[s].force);
  for (std::size_t p = 0; p < scene_.pairs().size(); ++p)
    reported(scene_.pairs()[p].body, reactions.of_tool_pairs[p].force);
  for (std::size_t p = 0; p < scene_.body_pairs().size(); ++p)
    for (const std::size_t body : scene_.body_pairs()[p].bodies)
      reported(body, solution.state().body_pair_loads[p].force);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const BodyBalance &balance = reactions.of_bodies[b];
    bodies_[b].size = std::max(bodies_[b].size, balance.nodal);
    for (unsigned int i = 0; i < 3; ++i) {
      Course &course = bodies_[b].axes[i];
      if (std::abs(balance.free[i]) > course.rest) {
        course.rest = std::abs(balance.free[i]);
        course.time = solution.state().time;
      }
    }
  }
}

DiagnosticList UnbalancedBodies::judge() const {
  // `along`: cosine of the angle to the axis of a circle.
  constexpr double much = 0.02, along = 0.999;
  const double tolerance = scene_.parameters().solver.force_tolerance;
  DiagnosticList diagnostics;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    double worst = much;
    unsigned int axis = 3;
    for (unsigned int i = 0; i < 3; ++i) {
      const Course &course = bodies_[b].axes[i];
      if (course.force > least_force(round_off_[b], bodies_[b].size, scene_.parameters().solver) &&
          course.rest > worst * course.force) {
        worst = course.rest / course.force;
        axis = i;
      }
    }
    if (axis == 3)
      continue;
    const Course &course = bodies_[b].axes[axis];
    std::ostringstream text, advice;
    text.precision(3);
    const WholeSection &whole = scene_.whole_section();
    const bool is_circle = whole.kind == WholeSection::Kind::full_circle,
               is_across = is_circle && !(std::abs(whole.axis[axis]) > along);
    const double factor = is_across ? 1. : whole.factor;
    text << "The accepted residuals leave up to " << factor * course.rest << " along "
         << "xyz"[axis] << " out of balance, " << 100. * worst
         << " % of the largest force of a tool, pair or support along "
         << "xyz"[axis] << ", " << factor * course.force << ", which is small beside all nodal forces, "
         << factor * bodies_[b].size << ": these forces are off by as much";
    if (is_circle)
      text << (is_across ? " (forces of the wedge)" : " (forces of the full circle)");
    else if (whole.kind == WholeSection::Kind::per_width)
      text << " (forces per unit of width)";
    advice.precision(1);
    constexpr double aim = 0.01;
    advice << "Set 'Force tolerance' to " << tolerance * aim / worst << " or less";
    diagnostics.push_back(Diagnostic(diagnostic::force_unresolved, text.str())
                              .body(scene_.bodies()[b].name)
                              .time(course.time)
                              .measure("part out of balance", worst)
                              .advice(advice.str()));
  }
  return diagnostics;
}

void UnbalancedBodies::save(StateWriter &writer) const {
  std::vector<double> numbers;
  for (const Of &body : bodies_) {
    numbers.push_back(body.size);
    for (const Course &course : body.axes)
      numbers.insert(numbers.end(), {course.force, course.rest, course.time});
  }
  writer.write("unbalanced bodies", numbers);
}

void UnbalancedBodies::load(const StateReader &reader) {
  constexpr std::size_t of_body = 10;
  if (!reader.has("unbalanced bodies"))
    return;
  const std::vector<double> numbers = reader.read("unbalanced bodies");
  if (numbers.size() != of_body * bodies_.size())
    return; // saved for other bodies
  const double *next = numbers.data();
  for (Of &body : bodies_) {
    body.size = *next++;
    for (Course &course : body.axes) {
      course = {next[0], next[1], next[2]};
      next += 3;
    }
  }
}

} // namespace billet
