// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/heavy_tools.h"

#include <algorithm>
#include <cmath>

namespace billet {

HeavyTools::HeavyTools(const Scene &scene) : scene_(scene) {
  for (std::size_t i = 0; i < scene.tools().size(); ++i) {
    const auto &motion = scene.parameters().tools[i].motion;
    tools_.emplace_back();
    if (!scene.tools()[i].is_driven())
      continue;
    tools_.back().inertia = motion.inertia;
    tools_.back().rate = motion.initial_rate;
  }
}

void HeavyTools::start(const std::size_t tool, const double exerted, const double load) {
  HeavyTool &heavy = tools_[tool];
  heavy.exerted = exerted;
  heavy.load = load;
  heavy.acceleration = (load - exerted) / heavy.inertia;
}

void HeavyTools::start_step(const std::vector<double> &offsets) {
  for (std::size_t i = 0; i < tools_.size(); ++i)
    tools_[i].offset = offsets[i];
}

void HeavyTools::extrapolate(const double step, std::vector<double> &offsets) const {
  for (std::size_t i = 0; i < tools_.size(); ++i)
    offsets[i] += step * (tools_[i].rate + 0.5 * step * tools_[i].acceleration);
}

double HeavyTools::round_off_force(const double last_bit, const double step, const double radius) const {
  double force = 0.;
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const double length = scene_.tools()[i].control() == Tool::Control::moment ? 1. / radius : 1.;
    force += last_bit * tools_[i].inertia * length *
             std::max(std::abs(tools_[i].offset), step * std::abs(tools_[i].rate));
  }
  return force;
}

double HeavyTools::accelerate(const HeavyTool &tool, const double offset, const Step &step) {
  const TimeIntegrator::Rate weights = step.integrator.acceleration(step.length);
  return weights.increment * (offset - tool.offset) + weights.velocity * tool.rate +
         weights.acceleration * start_acceleration(tool, step);
}

double HeavyTools::residual(const std::size_t tool, const double offset, const Step &step) const {
  const HeavyTool &heavy = tools_[tool];
  if (heavy.inertia == 0.)
    return 0.;
  return step.integrator.forces_before() * ((step.damps_contact ? 0. : heavy.exerted) - heavy.load) +
         heavy.inertia * (step.integrator.inertia_now() * accelerate(heavy, offset, step) +
                          step.integrator.inertia_before() * start_acceleration(heavy, step));
}

double HeavyTools::slope(const std::size_t tool, const Step &step) const {
  return tools_[tool].inertia * step.integrator.mass_factor(step.length);
}

void HeavyTools::commit(const std::size_t tool, const double offset, const double exerted, const double load,
                        const Step &step, EnergyLedger &energies) {
  HeavyTool &heavy = tools_[tool];
  const double way = offset - heavy.offset, rate_n = heavy.rate;
  const TimeIntegrator::Rate weights = step.integrator.velocity(step.length);
  const double acceleration = accelerate(heavy, offset, step);
  heavy.rate = weights.increment * way + weights.velocity * rate_n +
               weights.acceleration * start_acceleration(heavy, step);
  // The works of tools contain the exerted force, which the kinetic energy accounts for; the load is
  // external.
  const double mean_exerted = step.damps_contact ? exerted : 0.5 * (heavy.exerted + exerted);
  const double work = (0.5 * (heavy.load + load) - mean_exerted) * way;
  energies.external += work;
  energies.numerical -= 0.5 * heavy.inertia * (heavy.rate * heavy.rate - rate_n * rate_n) - work;
  heavy.acceleration =
      acceleration -
      (step.damps_contact ? (1. - 1. / step.integrator.gamma()) * exerted / heavy.inertia : 0.);
  heavy.offset = offset;
  heavy.exerted = exerted;
  heavy.load = load;
}

double HeavyTools::remove(const std::size_t tool) {
  HeavyTool &heavy = tools_[tool];
  const double energy = 0.5 * heavy.inertia * heavy.rate * heavy.rate;
  heavy = HeavyTool();
  return energy;
}

void HeavyTools::add_to(SolutionState &state) const {
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const HeavyTool &heavy = tools_[i];
    state.energies.kinetic += 0.5 * heavy.inertia * heavy.rate * heavy.rate;
    const Tool &tool = scene_.tools()[i];
    if (heavy.inertia == 0.)
      continue;
    if (tool.control() == Tool::Control::moment) {
      state.angular_momentum += heavy.inertia * heavy.rate * tool.rotation_axis();
      continue;
    }
    const dealii::Tensor<1, 3> p = heavy.inertia * heavy.rate * tool.force_direction();
    state.momentum += p;
    state.angular_momentum += dealii::cross_product_3d(state.placements[i].moved_centre(), p);
  }
}

void HeavyTools::save(const std::size_t tool, StateWriter &writer) const {
  const HeavyTool &heavy = tools_[tool];
  if (heavy.inertia == 0.)
    return;
  writer.write("rate", {heavy.rate});
  writer.write("acceleration", {heavy.acceleration, heavy.exerted, heavy.load});
}

void HeavyTools::load(const std::size_t tool, const StateReader &reader, const bool is_exact) {
  HeavyTool &heavy = tools_[tool];
  if (heavy.inertia == 0.)
    return;
  if (reader.read("flags", 2).at(1) != 0.) { // removed
    heavy = HeavyTool();
    return;
  }
  if (reader.has("rate"))
    heavy.rate = reader.number("rate");
  if (is_exact) {
    const std::vector<double> acceleration = reader.read("acceleration", 3);
    heavy.acceleration = acceleration[0];
    heavy.exerted = acceleration[1];
    heavy.load = acceleration[2];
  }
}

} // namespace billet
