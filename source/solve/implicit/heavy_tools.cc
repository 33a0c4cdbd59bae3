// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/heavy_tools.h"

#include <algorithm>
#include <cmath>

namespace billet {

HeavyTools::HeavyTools(const Scene &scene, const TimeIntegrator &integrator, const ContactDamping &contact)
    : scene_(scene), integrator_(integrator), contact_(contact) {
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

void HeavyTools::start_step(const double length, const std::vector<double> &offsets) {
  length_ = length;
  for (std::size_t i = 0; i < tools_.size(); ++i)
    tools_[i].offset = offsets[i];
}

void HeavyTools::extrapolate(std::vector<double> &offsets) const {
  for (std::size_t i = 0; i < tools_.size(); ++i)
    offsets[i] += length_ * (tools_[i].rate + 0.5 * length_ * tools_[i].acceleration);
}

double HeavyTools::round_off_force(const double last_bit, const double radius) const {
  double force = 0.;
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const double length = scene_.tools()[i].control() == Tool::Control::moment ? 1. / radius : 1.;
    force += last_bit * tools_[i].inertia * length *
             std::max(std::abs(tools_[i].offset), length_ * std::abs(tools_[i].rate));
  }
  return force;
}

double HeavyTools::accelerate(const HeavyTool &tool, const double offset) const {
  const TimeIntegrator::Rate weights = integrator_.acceleration(length_);
  return weights.increment * (offset - tool.offset) + weights.velocity * tool.rate +
         weights.acceleration * start_acceleration(tool);
}

double HeavyTools::residual(const std::size_t tool, const double offset) const {
  const HeavyTool &heavy = tools_[tool];
  if (heavy.inertia == 0.)
    return 0.;
  return integrator_.forces_before() * ((contact_.is_on() ? 0. : heavy.exerted) - heavy.load) +
         heavy.inertia * (integrator_.inertia_now() * accelerate(heavy, offset) +
                          integrator_.inertia_before() * start_acceleration(heavy));
}

double HeavyTools::slope(const std::size_t tool) const {
  return tools_[tool].inertia * integrator_.mass_factor(length_);
}

void HeavyTools::commit(const std::size_t tool, const double offset, const double exerted, const double load,
                        EnergyLedger &energies) {
  HeavyTool &heavy = tools_[tool];
  const double way = offset - heavy.offset, rate_n = heavy.rate;
  const TimeIntegrator::Rate weights = integrator_.velocity(length_);
  const double acceleration = accelerate(heavy, offset);
  heavy.rate =
      weights.increment * way + weights.velocity * rate_n + weights.acceleration * start_acceleration(heavy);
  // The works of tools contain the exerted force, which the kinetic energy accounts for; the load
  // is external.
  const double mean_exerted = contact_.is_on() ? exerted : 0.5 * (heavy.exerted + exerted);
  const double work = (0.5 * (heavy.load + load) - mean_exerted) * way;
  energies.external += work;
  energies.numerical -= 0.5 * heavy.inertia * (heavy.rate * heavy.rate - rate_n * rate_n) - work;
  heavy.acceleration =
      acceleration - (contact_.is_on() ? (1. - 1. / integrator_.gamma()) * exerted / heavy.inertia : 0.);
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
