// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/switched_supports.h"

#include "billet/discretization/constraint_lines.h"
#include "billet/discretization/support_parts.h"
#include "billet/solve/fading_names.h"

#include <algorithm>
#include <map>
#include <utility>

namespace billet {

Vector SwitchedSupports::switch_supports(const double t, const Vector &reactions,
                                         const Vector &displacements) {
  std::vector<Fading> fading;
  for (Fading &before : fading_)
    if (before.times.end() > t)
      fading.push_back(std::move(before));
  fading_.swap(fading);
  Vector remaining = discretization_.make_owned_vector();
  for (Fading &released : release_forces(t, reactions)) {
    remaining += released.forces.at_nodes();
    fading_.push_back(std::move(released));
  }
  for (const double fade_time : supports_.acting().fade_times(holding_after(t)))
    supports_.release(t, fade_time);
  supports_.take(t, displacements);
  return remaining;
}

std::vector<SwitchedSupports::Fading> SwitchedSupports::release_forces(const double t,
                                                                       Vector reactions) const {
  std::vector<Fading> released;
  const std::map<std::size_t, double> ended = fading_supports(scene_, supports_.acting(), holding_after(t));
  if (ended.empty())
    return released;
  // Forces at hanging nodes count at the nodes on which these depend, as in reactions.
  const dealii::IndexSet &owned = discretization_.owned_dofs();
  const Constraints links = build_constraints(
      owned, discretization_.relevant_dofs(),
      {{collect_links(discretization_.dof_handler(), discretization_.relevant_dofs()), {}}});
  condense(links, couple_ranks(links, owned, discretization_.communicator()), reactions);
  const auto residual = owned_values(std::as_const(reactions));
  std::map<std::size_t, Vector> forces;
  for (const auto &[support, fade_time] : ended)
    forces[support] = discretization_.make_owned_vector();
  for (const SupportedNode &node :
       collect_supported_nodes(scene_, discretization_, supports_.acting(), support_indices(scene_))) {
    if (!owned.is_element(node.dofs[0]))
      continue;
    const std::size_t place = owned.index_within_set(node.dofs[0]);
    const dealii::Tensor<1, 3> at_node({residual[place], residual[place + 1], residual[place + 2]});
    for (const SupportPart &part : node.parts) {
      const auto found = forces.find(part.support);
      if (found == forces.end())
        continue;
      const dealii::Tensor<1, 3> force = part.force(at_node);
      for (unsigned int i = 0; i < 3; ++i)
        found->second(node.dofs[i]) += force[i];
    }
  }
  for (const auto &[support, fade_time] : ended) {
    forces[support].compress(dealii::VectorOperation::add);
    released.push_back({{t, fade_time}, support, DeadForces(discretization_, forces[support])});
  }
  return released;
}

bool SwitchedSupports::changes(const double t_n, const double t) const {
  return std::any_of(fading_.begin(), fading_.end(),
                     [&](const Fading &fading) { return fading.times.left(t) != fading.times.left(t_n); });
}

void SwitchedSupports::add_forces(const double t, Vector &residual) const {
  for (const Fading &fading : fading_)
    residual.add(-fading.times.left(t), fading.forces.at_nodes());
}

double SwitchedSupports::work(const double t_n, const double t, const Vector &increment) const {
  double work = 0.;
  for (const Fading &fading : fading_)
    work += 0.5 * (fading.times.left(t) + fading.times.left(t_n)) * (fading.forces.at_nodes() * increment);
  return work;
}

void SwitchedSupports::save(StateWriter &writer, const OwnedNodes &nodes) const {
  std::set<double> starts;
  for (const auto &start : supports_.starts())
    starts.insert(start.first);
  save_support_starts(writer, starts, [&](const std::string &name, const double time) {
    save_nodal(writer, name, nodes, supports_.starts().at(time));
  });
  std::vector<FadeTimes> times;
  std::vector<std::optional<std::size_t>> supports;
  for (const Fading &fading : fading_) {
    times.push_back(fading.times);
    supports.push_back(fading.support);
  }
  save_fading_supports(writer, scene_, supports);
  save_support_fades(writer, times, [&](const std::string &name, const std::size_t i) {
    save_nodal(writer, name, nodes, fading_[i].forces.at_nodes());
  });
}

void SwitchedSupports::load(const StateReader &reader, const OwnedNodes &nodes, const double t,
                            const Vector &displacements) {
  std::map<double, Vector> starts;
  const auto load = [&](const std::string &name, const double time) {
    Vector start = discretization_.make_owned_vector();
    load_nodal(reader, name, nodes, start);
    starts[time] = discretization_.make_ghosted_vector();
    starts[time] = start;
  };
  for (const double time : load_support_starts(reader, late_beginnings(scene_, holding_after(t)), load))
    starts.insert_or_assign(time, Vector(displacements)); // a copy keeps the ghosts
  if (supports_.acting().may_change())
    supports_.resume(t, std::move(starts));
  fading_.clear();
  load_support_fades(reader, [&](const std::string &name, const FadeTimes &times) {
    Vector forces = discretization_.make_owned_vector();
    load_nodal(reader, name, nodes, forces);
    fading_.push_back({times, std::nullopt, DeadForces(discretization_, forces)});
  });
  const std::vector<std::optional<std::size_t>> supports =
      load_fading_supports(reader, scene_, fading_.size());
  for (std::size_t i = 0; i < fading_.size(); ++i)
    fading_[i].support = supports[i];
}

} // namespace billet
