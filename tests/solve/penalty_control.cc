// SPDX-License-Identifier: LGPL-2.1-or-later
// Penalties that rise until contact is hard enough.
#include "billet/solve/penalty_control.h"
#include "../testing.h"

#include <cmath>

namespace penalty_control_test {

using namespace billet;
using billet::testing::check;

namespace {

constexpr double max_raise = PenaltyControl::in_explicit_scenes;

/// A bar and the contact at its end, springs in series, that a constant force presses, and a pair that does
/// not touch.
struct Press {
  double body = 1., contact = 10., force = 1., room = 100., kinetic = 1e-3;

  PenaltyControl::Energies at(const double time) const {
    PenaltyControl::Energies energies;
    energies.time = time;
    energies.of_pairs = {0.5 * force * force / contact, 0.};
    energies.of_bodies = {0.5 * force * force / body};
    energies.all.elastic = energies.of_bodies[0];
    energies.all.contact = energies.of_pairs[0];
    energies.all.kinetic = kinetic * energies.of_bodies[0];
    energies.sticking.resize(2);
    return energies;
  }
  double softness() const { return 1. / (1. + contact / body); }

  /// Until `end`; the largest factor at a time.
  double run(PenaltyControl &control, const double from, const double end) {
    double maximum = 1.;
    for (double time = from; time < end; time += 0.25) {
      const auto factors = control.raises(at(time), {{room, room}, {room, room}});
      contact *= factors[0].normal;
      room /= factors[0].normal;
      maximum = std::max({maximum, factors[0].normal, factors[1].normal});
    }
    return maximum;
  }
};

PenaltyControl control(const bool may_be_raised) {
  LoadPath path;
  path.bodies = {0};
  path.pairs = {0, 1};
  return PenaltyControl({{"end", may_be_raised, may_be_raised}, {"other", true, true}}, {path}, max_raise);
}

void check_raises() {
  auto penalties = control(true);
  Press press;
  auto fast = control(true);
  Press impact;
  impact.kinetic = 0.1;
  check("nothing in fast motion", impact.run(fast, 0.25, 4.) == 1.);
  impact.kinetic = 1e-6;
  check("nor where that turns round", impact.run(fast, 4., 20.) == 1.);
  impact.force = 10.;
  check("but once it is pressed much harder", impact.run(fast, 20., 40.) == 1.1);
  check("not at once in slow motion", press.run(penalties, 4., 100.) == 1.1);
  check("until penetration takes 0.3 to 0.4 %", press.softness() < 0.004 && press.softness() > 0.0025);
  const DiagnosticList messages = penalties.take_diagnostics();
  check("a note on each raise, of the pair that presses alone", messages.size() >= 2 && messages.size() <= 4);
  check("and no more", penalties.take_diagnostics().empty());
  check("then it stays", press.run(penalties, 100., 200.) == 1.);
  press.body *= 4.; // as a strip that is pressed flat
  press.run(penalties, 200., 400.);
  check("and rises again where the body becomes stiffer", press.softness() < 0.0045);
}

void check_limits() {
  auto penalties = control(true);
  Press stiff;
  stiff.body = 1e3;
  stiff.run(penalties, 0.25, 400.);
  check("by a hundred times", std::abs(stiff.contact / 1000. - 1.) < 1e-12);
  auto own = control(false);
  Press given;
  check("what the scene sets stays", given.run(own, 0.25, 100.) == 1.);
  auto light = control(true);
  Press small;
  PenaltyControl::Energies energies = small.at(1.);
  double maximum = 1.;
  for (double time = 0.25; time < 50.; time += 0.25) {
    energies.time = time;
    energies.all.elastic = 1e3 * energies.of_bodies[0]; // of other bodies
    maximum = std::max(maximum, light.raises(energies, {{100., 100.}, {100., 100.}})[0].normal);
  }
  check("not where it is no matter for the scene", maximum == 1.);
  LoadPath loaded;
  loaded.bodies = {0};
  loaded.pairs = {0, 1};
  loaded.bears_given_loads = true;
  PenaltyControl support({{"end", true, true}, {"other", true, true}}, {loaded}, max_raise);
  Press heavy;
  check("nor where loads are given, whose forces are right", heavy.run(support, 0.25, 100.) == 1.);
  auto twice = control(true);
  Press once;
  once.run(twice, 0.25, 8.);
  const double before = once.contact;
  once.contact *= twice.raises(once.at(7.75), {{once.room, 1.}, {once.room, 1.}})[0].normal;
  check("once at a time", once.contact == before);
}

/// A node that sticks with a force of 1 to a spring, on a body, whose stiffness is 1, under a pressure.
struct Stuck {
  double spring = 27., pressure = 10., room = 100.;

  /// The last raise.
  double run(PenaltyControl &control, const double from, const double end) {
    double last = 1.;
    for (double time = from; time < end; time += 0.25) {
      PenaltyControl::Energies energies = Press().at(time);
      energies.sticking[0] = {pressure, 1., 1. / spring, 0.5 / spring};
      last = control.raises(energies, {{1., room}, {1., room}})[0].tangential;
      spring *= last;
      room /= last;
    }
    return last;
  }
};

void check_friction() {
  auto penalties = control(true);
  Stuck stuck;
  check("tangential penalties rise where friction that sticks lacks a part",
        stuck.run(penalties, 0.25, 0.5) == 4.);
  check("until that is 0.15 to 0.2 %",
        stuck.run(penalties, 0.5, 10.) == 1. && stuck.spring > 1. / 0.002 && stuck.spring < 1. / 0.00125);
  const DiagnosticList messages = penalties.take_diagnostics();
  check("with a note on each raise", messages.size() == 3);
  auto own = control(false);
  Stuck given;
  given.run(own, 0.25, 10.);
  check("what the scene sets stays, there too", given.spring == 27.);
  auto light = control(true);
  Stuck small;
  small.pressure = 1e3;
  small.run(light, 0.25, 10.);
  check("nor does it rise where friction is little beside pressure", small.spring == 27.);
}

/// Constant energies of a path of two pairs and a body, and of friction on the first pair, over all time.
struct Constant {
  double penetration = 0.01, softness = 0.03;
  double part_of_all = 0.03;  ///< penetration, of all energies of deformation
  double kinetic = 0.;        ///< over all energies of deformation
  double share_of_other = 0.; ///< of the second pair, in the penetration
  double room = 1e5;
  StickSoftness sticking;

  PenaltyControl::Factors raise(PenaltyControl &control, const std::size_t pair = 0) const {
    PenaltyControl::Energies energies;
    energies.time = 1.;
    energies.of_pairs = {(1. - share_of_other) * penetration, share_of_other * penetration};
    energies.of_bodies = {penetration * (1. / softness - 1.)};
    const double all = penetration / part_of_all;
    energies.all.contact = penetration;
    energies.all.elastic = all - penetration;
    energies.all.kinetic = kinetic * all;
    energies.sticking = {sticking, {}};
    return control.raises(energies, {{room, room}, {room, room}})[pair];
  }
  PenaltyControl::Factors raise(const std::size_t pair = 0,
                                const double at_once = PenaltyControl::in_implicit_scenes) const {
    PenaltyControl all(pairs, {path()}, at_once);
    return raise(all, pair);
  }
  static LoadPath path() {
    LoadPath path;
    path.bodies = {0};
    path.pairs = {0, 1};
    return path;
  }
  const std::vector<PenaltyControl::Pair> pairs{{"end", true, true}, {"other", true, true}};
};

/// (L8) with numbers.
void check_formula() {
  constexpr double rounding = 1e-9;
  const auto normal = [](const double softness, const double part_of_all, const double kinetic) {
    Constant constant;
    constant.softness = softness;
    constant.part_of_all = part_of_all;
    constant.kinetic = kinetic;
    return constant.raise().normal;
  };
  check("0.4 % of the deformation raises penalties",
        normal(3.9e-3, 3e-3, 0.) == 1. && normal(4.1e-3, 3e-3, 0.) > 1.);
  check("so that 0.3 % are left", std::abs(normal(6e-3, 6e-3, 0.) - 2.), rounding);
  check("fourfold at most", normal(0.03, 0.03, 0.) == 4.);
  check("0.2 % of all energies count", normal(0.01, 2.1e-3, 0.) > 1. && normal(0.01, 1.9e-3, 0.) == 1.);
  check("motion is slow with a hundredth of the energy of deformation",
        normal(0.01, 0.01, 9.5e-3) > 1. && normal(0.01, 0.01, 1.05e-2) == 1.);
  check("explicit penalties rise by a tenth at a time",
        std::abs(Constant().raise(0, PenaltyControl::in_explicit_scenes).normal - 1.1), rounding);
  Constant shared;
  shared.share_of_other = 0.052;
  check("pairs with a twentieth of the penetration rise, too", shared.raise(1).normal == 4.);
  shared.share_of_other = 0.048;
  check("those with less do not", shared.raise(1).normal == 1. && shared.raise(0).normal == 4.);

  // A pair at its default, 10 E/h, may rise by a factor of 1e5.
  Constant described;
  described.softness = described.part_of_all = 6e-3;
  PenaltyControl control(described.pairs, {Constant::path()}, PenaltyControl::in_implicit_scenes);
  described.raise(control);
  const DiagnosticList messages = control.take_diagnostics();
  check("the message knows the penalty",
        !messages.empty() && messages.front().text().find("rises to 20 E/h") != std::string::npos);
}

/// (L9) with numbers.
void check_friction_formula() {
  // Loses this part of the friction, which is that part of the pressure.
  const auto tangential = [](const double part, const double of_pressure) {
    Constant constant;
    constant.sticking.lost = part;
    constant.sticking.friction = 1. - part;
    constant.sticking.pressure = part / of_pressure;
    return constant.raise().tangential;
  };
  check("0.2 % of friction that sticks raises penalties",
        tangential(1.9e-3, 0.1) == 1. && tangential(2.1e-3, 0.1) > 1.);
  check("so that 0.15 % are left", std::abs(tangential(3e-3, 0.1) - 2.), 1e-9);
  check("fourfold at most, there too", tangential(0.03, 0.1) == 4.);
  check("0.02 % of the pressure count", tangential(0.01, 2.1e-4) > 1. && tangential(0.01, 1.9e-4) == 1.);
}

} // namespace

BILLET_TEST(penalty_control) {
  check_raises();
  check_limits();
  check_friction();
  check_formula();
  check_friction_formula();
}

} // namespace penalty_control_test
