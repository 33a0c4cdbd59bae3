// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/predictor.h"

#include "billet/solve/implicit/implicit_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace billet {

bool Predictor::extrapolates() const {
  return parts_.parameters().solver.predictor == parameters::Solver::Predictor::extrapolation;
}

bool Predictor::guess(const double t, const double previous_step) {
  return follow_probe(t) || (previous_step > 0. &&
                             (stay_at_rest(t) || (extrapolates() && continue_increment(t, previous_step))));
}

bool Predictor::stay_at_rest(const double t) {
  const double t_n = problem_.state().time;
  const auto &bodies = parts_.scene().bodies();
  if (std::any_of(bodies.begin(), bodies.end(), [](const Body &body) { return !body.loads.empty(); }))
    return false; // loads may change with time
  if (has_lost_pace_ || parts_.switched_supports().changes(t_n, t) ||
      parts_.released().left(t) != parts_.released().left(t_n) || parts_.removal().changes(t_n, t))
    return false;
  const auto &tools = parts_.scene().tools();
  for (std::size_t i = 0; i < tools.size(); ++i) {
    if (parts_.removal().is_removed(i) || parts_.tools().is_stopped(i))
      continue;
    const Tool &tool = tools[i];
    const Placement before = tool.placement(t_n), after = tool.placement(t);
    if (after.translation != before.translation || after.rotation_angle != before.rotation_angle ||
        (tool.control() != Tool::Control::motion && tool.load(t) != tool.load(t_n)))
      return false;
  }
  bool supports_move = false;
  parts_.supports().change(t_n, t, supports_move);
  if (supports_move)
    return false;
  problem_.step().trial.displacements = problem_.step().start.displacements;
  parts_.tools().restart();
  return true;
}

bool Predictor::tool_jumps(const Tool &tool, const double t, const double previous_step) const {
  const double t_n = problem_.state().time, ratio = (t - t_n) / previous_step;
  const Placement before = tool.placement(t_n - previous_step), now = tool.placement(t_n),
                  after = tool.placement(t);
  // Six points of the tool about the scene.
  double jump = 0., motion = 0.;
  for (unsigned int i = 0; i < 6; ++i) {
    dealii::Tensor<1, 3> here = parts_.discretization().centre();
    here[i / 2] += (i % 2 == 0 ? 1. : -1.) * parts_.discretization().radius();
    const auto point = now.to_tool(here);
    const auto step = after.to_space(point) - here;
    jump += (step - ratio * (here - before.to_space(point))).norm();
    motion += step.norm();
  }
  return jump > Limits::max_jump * motion;
}

bool Predictor::fit_to_supports(const double t) {
  StepState &step = problem_.step();
  Vector jump = step.trial.displacements, motion = step.trial.displacements;
  parts_.supports().at_time(t).distribute(step.trial.displacements);
  jump -= step.trial.displacements;
  motion -= step.start.displacements;
  return jump.l2_norm() <= Limits::max_jump * motion.l2_norm();
}

bool Predictor::continue_increment(const double t, const double previous_step) {
  if (has_lost_pace_)
    return false;
  const double ratio = (t - problem_.state().time) / previous_step;
  const auto &scene_tools = parts_.scene().tools();
  for (std::size_t i = 0; i < scene_tools.size(); ++i)
    if (!parts_.tools().is_stopped(i) && tool_jumps(scene_tools[i], t, previous_step))
      return false;
  StepState &step = problem_.step();
  step.trial.displacements = step.start.displacements;
  step.trial.displacements.add(ratio, step.last_increment);
  DrivenTools &tools = parts_.tools();
  std::vector<double> offsets = tools.offsets();
  for (const std::size_t tool : tools.unknown())
    offsets[tool] = tools.start_offsets()[tool] + ratio * tools.last_increments()[tool];
  tools.set_offsets(offsets);
  return fit_to_supports(t);
}

bool Predictor::follow_probe(const double t) {
  const double t_n = problem_.state().time;
  if (!probe_ || t > probe_->time || t_n >= probe_->time)
    return false;
  const double ratio = (t - t_n) / (probe_->time - t_n);
  StepState &step = problem_.step();
  step.trial.displacements = probe_->displacements;
  step.trial.displacements -= step.start.displacements;
  step.trial.displacements *= ratio;
  step.trial.displacements += step.start.displacements;
  DrivenTools &tools = parts_.tools();
  std::vector<double> offsets = tools.offsets();
  for (const std::size_t tool : tools.unknown())
    offsets[tool] =
        tools.start_offsets()[tool] + ratio * (probe_->offsets[tool] - tools.start_offsets()[tool]);
  tools.set_offsets(offsets);
  return fit_to_supports(t);
}

bool Predictor::follow_tangent(const double t, NewtonIteration &iteration) {
  // K Δu = −∂R/∂t Δt at the last state. The change of the prescribed displacements is lifted to the
  // right-hand side, so that it spreads through the bodies. On the boundary nodes alone it would
  // crush the elements beside them.
  StepState &step = problem_.step();
  DrivenTools &tools = parts_.tools();
  bool supports_move = false;
  const Constraints change = parts_.supports().change(problem_.state().time, t, supports_move);
  problem_.start_at_rest();
  tools.restart();
  Vector correction = parts_.discretization().make_owned_vector(), rhs = correction;
  const std::vector<std::size_t> unknown = tools.unknown();
  tools.leave_in_place();
  const bool is_admissible = problem_.compute_residual(step.start.displacements, rhs);
  tools.free_again(unknown);
  if (!is_admissible)
    return false;
  rhs *= -1.;
  Vector loads = correction;
  if (parts_.scheme().add_load_change(t, step.start.displacements, loads)) {
    parts_.supports().condense(loads);
    rhs += loads;
  }
  std::vector<double> load_rhs, offset_changes(unknown.size());
  for (const std::size_t tool : unknown)
    load_rhs.push_back(-tools.imbalance(tool, t) / tools.unit_of(tool));
  Vector pushes = parts_.discretization().make_additive_vector(), lift = pushes;
  for (const auto &contact : parts_.contacts().of_tools())
    contact.drive().add_push(tools.place(contact.tool(), t, tools.start_offsets()[contact.tool()]), pushes);
  pushes.compress(dealii::VectorOperation::add);
  Vector push = correction;
  push = pushes;
  push *= parts_.scheme().contact().at_end();
  parts_.supports().condense(push);
  rhs += push;
  // Whether points on the yield surface will load or unload is not known yet. The elastic guess is
  // the safe one, and takes the fewer iterations: the soft plastic one overshoots wherever they
  // unload.
  if (!problem_.assemble_tangent({change, parts_.tangent().matrix(), &lift}, Limits::yield_slack))
    return false;
  lift.compress(dealii::VectorOperation::add);
  push = lift;
  rhs += push;
  const parameters::Solver &solver = parts_.parameters().solver;
  const double relative_tolerance = solver.forcing == parameters::Solver::Forcing::fixed
                                        ? solver.linear_tolerance
                                        : std::max(solver.linear_tolerance, Limits::linear_tolerance);
  if (!problem_.solve_bordered(rhs, load_rhs, 1., relative_tolerance, correction, offset_changes))
    return false;
  iteration = {1., std::abs(rhs * correction), 1.};
  change.distribute(correction);
  step.trial.displacements = step.start.displacements;
  step.trial.displacements += correction;
  parts_.supports().at_time(t).distribute(step.trial.displacements);
  std::vector<double> offsets = tools.offsets();
  for (std::size_t k = 0; k < unknown.size(); ++k)
    offsets[unknown[k]] += offset_changes[k] / tools.unit_of(unknown[k]);
  tools.set_offsets(offsets);
  return std::isfinite(step.trial.displacements.l2_norm());
}

void Predictor::keep_probe(const double t) {
  probe_ = std::make_unique<ProbedState>(
      ProbedState{t, problem_.step().trial.displacements, parts_.tools().offsets()});
}

void Predictor::save(StateWriter &writer, const OwnedNodes &nodes) const {
  if (!probe_ || probe_->time <= problem_.state().time)
    return;
  writer.in("probe", [&] {
    writer.write("time", {probe_->time});
    writer.write("offsets", probe_->offsets);
    save_nodal(writer, "displacements", nodes, probe_->displacements);
  });
}

void Predictor::load(StateReader &reader, const OwnedNodes &nodes, const bool is_exact) {
  has_lost_pace_ = reader.read("scales", 2).at(1) != 0.;
  if (!is_exact || !reader.has("probe"))
    return;
  reader.in("probe", [&] {
    probe_ =
        std::make_unique<ProbedState>(ProbedState{reader.number("time"), problem_.step().start.displacements,
                                                  reader.read("offsets", parts_.tools().offsets().size())});
    load_nodal(reader, "displacements", nodes, probe_->displacements);
  });
}

bool MotionPredictor::guess(const double t, double /*previous_step*/) {
  if (!extrapolates())
    return false;
  StepState &step = problem_.step();
  DrivenTools &tools = parts_.tools();
  Vector guess = step.start.displacements;
  std::vector<double> offsets = tools.start_offsets();
  parts_.scheme().start_step(problem_.state().time, t, step.start.displacements, offsets);
  motion_.extrapolate(guess, offsets);
  parts_.supports().at_time(t).distribute(guess);
  tools.set_offsets(offsets);
  problem_.start_step(t);

  const Vector at_end = tools.pack(guess, offsets);
  Vector residual(at_end);
  if (!problem_.compute_residual(at_end, residual))
    return false;
  const double at_guess = residual.l2_norm();
  if (!problem_.compute_residual(problem_.unknowns(), residual))
    return false;
  const double at_start = residual.l2_norm();
  step.trial.displacements = guess;
  tools.set_offsets(offsets);
  return at_guess <= at_start;
}

} // namespace billet
