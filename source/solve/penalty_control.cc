// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/penalty_control.h"

#include "billet/contact/traction.h"
#include "billet/diagnostic_kinds.h"
#include "billet/solve/solution_energies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

namespace billet {

namespace {

/// (L7): the part that penetration may take, the part to which raises lead, and what is no matter.
constexpr double allowed = 0.004, aim = 0.003, counts = 0.002;
constexpr double slow = 0.01;         ///< largest kinetic energy so far beside what deformation takes now
constexpr double notable_pair = 0.05; ///< of the energy in the springs of a path

std::vector<PenaltyControl::Pair> pairs_of(const Scene &scene) {
  std::vector<PenaltyControl::Pair> pairs;
  for (const auto &pair : scene.pairs())
    pairs.push_back({pair.name, pair.is_raised});
  for (const auto &pair : scene.body_pairs())
    pairs.push_back({pair.name, pair.is_raised});
  return pairs;
}

} // namespace

PenaltyControl::PenaltyControl(std::vector<Pair> pairs, const std::vector<LoadPath> &paths,
                               const double largest_raise)
    : largest_raise_(largest_raise), pairs_(std::move(pairs)) {
  for (const LoadPath &path : paths)
    if (!path.bears_given_loads)
      paths_.push_back({path, 1., {}});
}

PenaltyControl::PenaltyControl(const Scene &scene, const double largest_raise)
    : PenaltyControl(pairs_of(scene), find_load_paths(scene), largest_raise) {}

bool PenaltyControl::is_used() const {
  return std::any_of(paths_.begin(), paths_.end(), [this](const Controlled &path) {
    const auto &pairs = path.parts.pairs;
    return std::any_of(pairs.begin(), pairs.end(),
                       [this](const std::size_t pair) { return pairs_[pair].may_be_raised; });
  });
}

void PenaltyControl::judge(Controlled &path, const Energies &energies, const std::vector<double> &room) {
  const double part = path.softness.part(counts);
  if (!(part > allowed))
    return;
  const double raise = std::min(part / aim, largest_target);
  for (const std::size_t pair : path.parts.pairs) {
    if (!pairs_[pair].may_be_raised || !(energies.of_pairs[pair] > 0.) || !(room[pair] > 1.))
      continue;
    path.left = raise;
    constexpr double percent = 100.;
    std::ostringstream text;
    text.precision(3);
    text << "The penalty of the pair is raised to "
         << enough_penalty * most_raise / room[pair] * std::min(raise, room[pair])
         << " E/h, since penetration takes " << percent * part << " % of the deformation along its load path";
    diagnostics_.push_back(Diagnostic(diagnostic::penalty_raised, text.str())
                               .pair(pairs_[pair].name)
                               .time(energies.time)
                               .value("factor", raise)
                               .advice("Nothing has to be done. Time steps may be shorter from now on; "
                                       "'Penetration tolerance = 0' keeps the penalty"));
  }
}

PenaltyControl::Energies PenaltyControl::measure(const Solution &solution, const Scene &scene,
                                                 const double time, const MPI_Comm communicator) {
  std::vector<std::size_t> bodies(scene.bodies().size());
  std::iota(bodies.begin(), bodies.end(), std::size_t(0));
  return {time, energies_of_penetration(solution, communicator),
          energies_of_bodies(solution, bodies, communicator), solution.state().energies};
}

std::vector<double> PenaltyControl::raises(const Energies &energies, const std::vector<double> &room) {
  std::vector<double> factors(pairs_.size(), 1.);
  largest_kinetic_ = std::max(largest_kinetic_, energies.all.kinetic);
  if (!(energies.time > time_))
    return factors;
  time_ = energies.time;
  for (Controlled &path : paths_) {
    double penetration = 0., deformation = 0.;
    for (const std::size_t pair : path.parts.pairs)
      penetration += energies.of_pairs[pair];
    for (const std::size_t body : path.parts.bodies)
      deformation += energies.of_bodies[body];
    const EnergyLedger &all = energies.all;
    path.softness.add(energies.time, penetration, deformation, all.of_elements() + all.contact);
    const bool is_slow = largest_kinetic_ < slow * (all.of_elements() + all.contact);
    if (!is_slow || !(penetration > 0.))
      continue;
    if (path.left == 1.)
      judge(path, energies, room);
    if (path.left == 1.)
      continue;
    const double factor = std::min(path.left, largest_raise_);
    path.left /= factor;
    for (const std::size_t pair : path.parts.pairs)
      if (pairs_[pair].may_be_raised && energies.of_pairs[pair] > notable_pair * penetration)
        factors[pair] = std::max(1., std::min(factor, room[pair]));
    path.softness.restart();
  }
  return factors;
}

DiagnosticList PenaltyControl::take_diagnostics() {
  DiagnosticList result;
  std::swap(result, diagnostics_);
  return result;
}

void PenaltyControl::save(StateWriter &writer) const {
  std::vector<double> numbers{time_, largest_kinetic_};
  for (const Controlled &path : paths_) {
    numbers.push_back(path.left);
    path.softness.save(numbers);
  }
  writer.write("penalty control", numbers);
}

void PenaltyControl::load(const StateReader &reader) {
  constexpr std::size_t of_path = 1 + PathSoftness::n_numbers;
  if (!reader.has("penalty control"))
    return;
  const std::vector<double> numbers = reader.read("penalty control");
  if (numbers.size() != 2 + of_path * paths_.size())
    return; // of other pairs
  time_ = numbers[0];
  largest_kinetic_ = numbers[1];
  const double *next = numbers.data() + 2;
  for (Controlled &path : paths_) {
    path.left = next[0];
    path.softness.load(next + 1);
    next += of_path;
  }
}

} // namespace billet
