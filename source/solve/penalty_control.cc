// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/penalty_control.h"

#include "billet/diagnostic_kinds.h"
#include "billet/solve/solution_energies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

namespace billet {

namespace {

/// Limits of penalties that rise.
struct PenaltyControlLimits {
  /// Part of penetration in the deformation of a path above which penalties rise, (L8). Then follow
  /// the part that raises aim at, and the part of all energy below which penetration is irrelevant.
  static constexpr double allowed = 0.004, aim = 0.003, counts = 0.002;
  /// The same for sticking, (L9). The lost part of friction, the part that raises aim at, and the
  /// part of the normal force below which lost friction is irrelevant follow. Friction lost before
  /// a raise stays lost.
  static constexpr double allowed_in_friction = 0.002, aim_in_friction = 0.0015, counts_in_friction = 2e-4;
  /// Maximum factor of a raise. Softness is measured anew after it.
  static constexpr double max_at_once = 4.;
  /// Largest kinetic energy so far over the energy of deformation now, below which motion is slow.
  static constexpr double slow = 0.01;
  /// Part of a path's energy of penetration above which a pair's penalty rises with it.
  static constexpr double notable_pair = 0.05;
};
constexpr double percent = 100.;

template <class ContactPair> bool raises_tangential(const ContactPair &pair) {
  return pair.is_raised && pair.has_friction() && !pair.input->penalty.is_tangential_given;
}

std::vector<PenaltyControl::Pair> pairs_of(const Scene &scene) {
  std::vector<PenaltyControl::Pair> pairs;
  for (const auto &pair : scene.pairs())
    pairs.push_back({pair.name, pair.is_raised, raises_tangential(pair)});
  for (const auto &pair : scene.body_pairs())
    pairs.push_back({pair.name, pair.is_raised, raises_tangential(pair)});
  return pairs;
}

} // namespace

PenaltyControl::PenaltyControl(std::vector<Pair> pairs, const std::vector<LoadPath> &paths,
                               const double max_raise)
    : max_raise_(max_raise), pairs_(std::move(pairs)) {
  for (const LoadPath &path : paths)
    if (!path.bears_given_loads)
      paths_.push_back({path, 1., {}});
}

PenaltyControl::PenaltyControl(const Scene &scene, const Discretization &discretization,
                               const double max_raise)
    : PenaltyControl(pairs_of(scene), find_load_paths(scene), max_raise) {
  if (is_used())
    stick_springs_.emplace(scene, discretization);
}

bool PenaltyControl::is_used() const {
  const auto is_controlled = [this](const Controlled &path) {
    const auto &pairs = path.parts.pairs;
    return std::any_of(pairs.begin(), pairs.end(),
                       [this](const std::size_t pair) { return pairs_[pair].may_be_raised; });
  };
  return std::any_of(paths_.begin(), paths_.end(), is_controlled) ||
         std::any_of(pairs_.begin(), pairs_.end(),
                     [](const Pair &pair) { return pair.may_be_raised_tangentially; });
}

void PenaltyControl::judge(Controlled &path, const Energies &energies, const std::vector<Factors> &room) {
  const double part = path.softness.part(PenaltyControlLimits::counts);
  if (!(part > PenaltyControlLimits::allowed))
    return;
  const double raise = std::min(part / PenaltyControlLimits::aim, PenaltyControlLimits::max_at_once);
  for (const std::size_t pair : path.parts.pairs) {
    if (!pairs_[pair].may_be_raised || !(energies.of_pairs[pair] > 0.) || !(room[pair].normal > 1.))
      continue;
    path.left = raise;
    std::ostringstream reason;
    reason.precision(3);
    reason << "penetration takes " << percent * part << " % of the deformation along its load path";
    describe("penalty", pair, energies.time, raise, room[pair].normal, reason.str());
  }
}

void PenaltyControl::describe(const std::string &penalty, const std::size_t pair, const double time,
                              const double factor, const double room, const std::string &reason) {
  std::ostringstream text;
  text.precision(3);
  text << "The " << penalty << " of the pair rises to "
       << enough_penalty * max_in_all / room * std::min(factor, room) << " E/h, since " << reason;
  const bool is_enough = factor < room;
  diagnostics_.push_back(
      Diagnostic(diagnostic::penalty_raised, text.str())
          .pair(pairs_[pair].name)
          .time(time)
          .value("factor", factor)
          .advice(std::string(
                      is_enough
                          ? "No action is necessary."
                          : "It rises no further: check the messages about the pair at the end of the run.") +
                  " Time steps may be shorter from now on; 'Penetration tolerance = 0' keeps the penalty"));
}

double PenaltyControl::tangential_raise(const std::size_t pair, const Energies &energies, const double room) {
  const StickSoftness &softness = energies.sticking[pair];
  const double part = softness.part();
  if (!pairs_[pair].may_be_raised_tangentially || !(part > PenaltyControlLimits::allowed_in_friction) ||
      !(softness.lost > PenaltyControlLimits::counts_in_friction * softness.pressure) || !(room > 1.))
    return 1.;
  const double raise =
      std::min({part / PenaltyControlLimits::aim_in_friction, PenaltyControlLimits::max_at_once, room});
  std::ostringstream reason;
  reason.precision(3);
  reason << "friction forces while sticking are too small by up to " << percent * part << " %";
  describe("tangential penalty", pair, energies.time, raise, room, reason.str());
  return raise;
}

PenaltyControl::Energies PenaltyControl::measure(const Solution &solution, const std::size_t n_bodies,
                                                 const double time, const MPI_Comm communicator) const {
  std::vector<std::size_t> bodies(n_bodies);
  std::iota(bodies.begin(), bodies.end(), std::size_t(0));
  const auto reports = solution.report_contacts();
  return {time, energies_of_penetration(reports, communicator),
          energies_of_bodies(solution, bodies, communicator), solution.state().energies,
          stick_springs_->measure(reports)};
}

std::vector<PenaltyControl::Factors> PenaltyControl::raises(const Energies &energies,
                                                            const std::vector<Factors> &room) {
  std::vector<Factors> factors(pairs_.size());
  max_kinetic_ = std::max(max_kinetic_, energies.all.kinetic);
  if (!(energies.time > time_))
    return factors;
  time_ = energies.time;
  const EnergyLedger &all = energies.all;
  const double deformed = all.of_elements() + all.contact;
  const bool is_slow = max_kinetic_ < PenaltyControlLimits::slow * deformed;
  for (std::size_t pair = 0; is_slow && pair < pairs_.size(); ++pair)
    factors[pair].tangential = tangential_raise(pair, energies, room[pair].tangential);
  for (Controlled &path : paths_) {
    double penetration = 0., deformation = 0.;
    for (const std::size_t pair : path.parts.pairs)
      penetration += energies.of_pairs[pair];
    for (const std::size_t body : path.parts.bodies)
      deformation += energies.of_bodies[body];
    path.softness.add(energies.time, penetration, deformation, deformed);
    if (!is_slow || !(penetration > 0.))
      continue;
    if (path.left == 1.)
      judge(path, energies, room);
    if (path.left == 1.)
      continue;
    const double factor = std::min(path.left, max_raise_);
    path.left /= factor;
    for (const std::size_t pair : path.parts.pairs)
      if (pairs_[pair].may_be_raised &&
          energies.of_pairs[pair] > PenaltyControlLimits::notable_pair * penetration)
        factors[pair].normal = std::max(1., std::min(factor, room[pair].normal));
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
  std::vector<double> numbers{time_, max_kinetic_};
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
  max_kinetic_ = numbers[1];
  const double *next = numbers.data() + 2;
  for (Controlled &path : paths_) {
    path.left = next[0];
    path.softness.load(next + 1);
    next += of_path;
  }
}

} // namespace billet
