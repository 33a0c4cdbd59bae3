// SPDX-License-Identifier: LGPL-2.1-or-later
// Which steps SoftnessLimit augments, (L7): a spring k presses a body of stiffness K, which gives way by d in
// so many steps. The force is that of rigid contact as far as it should be, and soft bodies cost little.
#include "billet/solve/softness_limit.h"

#include "../testing.h"

#include <cmath>
#include <string>

namespace softness_limit_test {

using billet::ContactSprings;
using billet::SoftnessLimit;
using billet::testing::check;

namespace {

/// F = K (d − g) = k (a + g) at a lift a.
struct Press {
  double K, k, lift = 0.;

  double gap(const double d) const { return (K * d - k * lift) / (K + k); }
  ContactSprings springs(const double d) const {
    ContactSprings springs;
    springs.normal.force = K * (d - gap(d));
    springs.normal.held = k * std::abs(gap(d));
    return springs;
  }
  void augment(const double d) { lift += gap(d); }
};

struct Outcome {
  double worst = 0.; ///< part of the force that is missing
  unsigned int augmentations = 0;
};

Outcome press(const double K, const unsigned int n_steps) {
  Press body{K, 1.};
  SoftnessLimit limit({SoftnessLimit::Rule::general});
  Outcome outcome;
  for (unsigned int n = 1; n <= n_steps; ++n) {
    const double d = static_cast<double>(n) / n_steps;
    limit.begin();
    std::vector<ContactSprings> springs{body.springs(d)};
    for (unsigned int round = 0; round < 20 && limit.excess(springs)[0] > 1.; ++round) {
      body.augment(d);
      ++outcome.augmentations;
      const std::vector<ContactSprings> after{body.springs(d)};
      const double change = std::abs(after[0].normal.force - springs[0].normal.force);
      limit.learn(springs, {{SoftnessLimit::Change{change, change}, SoftnessLimit::Change{}}});
      springs = after;
    }
    limit.commit(springs);
    outcome.worst = std::max(outcome.worst, std::abs(springs[0].normal.force / (K * d) - 1.));
  }
  return outcome;
}

/// A force that each augmentation changes by 1 % of the largest, until it is given up.
void check_what_is_given_up() {
  SoftnessLimit limit({SoftnessLimit::Rule::general, SoftnessLimit::Rule::none});
  ContactSprings springs;
  springs.normal.force = 2.;
  springs.normal.held = 0.1;
  const auto step = [&](const double change, const double force) {
    springs.normal.force = force;
    limit.begin();
    using Changes = std::array<SoftnessLimit::Change, 2>;
    const Changes of_first{{{change, change}, {}}}, of_second{{{1., 1.}, {}}};
    limit.learn({springs, springs}, {of_first, of_second});
    limit.commit({springs, springs});
  };
  step(1e-5, 1.);
  check("what settles is not reported", limit.unsettled()[0] == 0.);
  step(0.02, 2.);
  check("what is given up is, over the largest force", std::abs(limit.unsettled()[0] - 0.01), 1e-15);
  step(1e-5, 4.);
  check("also of an earlier step", std::abs(limit.unsettled()[0] - 0.005), 1e-15);
  check("of pairs that limit softness", limit.unsettled()[1] == 0.);
  SoftnessLimit other({SoftnessLimit::Rule::general, SoftnessLimit::Rule::none});
  other.load(limit.save());
  check("and after a restart", other.unsettled() == limit.unsettled());
}

ContactSprings springs_of(const double force, const double held, const double friction = 0.,
                          const double held_tangentially = 0.) {
  ContactSprings springs;
  springs.normal.force = force;
  springs.normal.held = held;
  springs.tangential.force = friction;
  springs.tangential.held = held_tangentially;
  return springs;
}

/// The multiple of the allowed part that is missing once an augmentation has changed the force by `ratio` of
/// what springs held, in a former step.
double excess_after(const double ratio, const double held_then, const ContactSprings &now) {
  SoftnessLimit limit({SoftnessLimit::Rule::general});
  limit.learn({springs_of(1., held_then)},
              {{SoftnessLimit::Change{ratio * held_then, 1.}, SoftnessLimit::Change{}}});
  limit.begin();
  return limit.excess({now})[0];
}

/// Whether a is b but for round-off.
bool is(const double a, const double b) { return std::abs(a - b) <= 1e-12 * std::abs(b); }

/// (L7) with numbers.
void check_formula() {
  SoftnessLimit limit({SoftnessLimit::Rule::general});
  // Of a force of 1, 0.002 may be missing. All augmentations add 5 times what springs hold, as far as known.
  check("springs that hold a fifth of 0.002 meet the limit", is(limit.excess({springs_of(1., 4e-4)})[0], 1.));
  check("those that hold half of the force count once",
        is(limit.excess({springs_of(1., 0.52)})[0], 260.) &&
            is(limit.excess({springs_of(1., 0.48)})[0], 1200.));
  // The geometric series ρ + ρ² + ...
  check("half of what they hold is granted: it is missing",
        is(excess_after(0.5, 0.1, springs_of(1., 2e-3)), 1.));
  check("three quarters: three times as much", is(excess_after(0.75, 0.1, springs_of(1., 2e-3)), 3.));
  check("all: five times", is(excess_after(1., 0.1, springs_of(1., 2e-3)), 5.));
  check("what is below 1e-4 of the force shows nothing",
        is(excess_after(0.5, 1.1e-4, springs_of(1., 2e-3)), 1.) &&
            is(excess_after(0.5, 0.9e-4, springs_of(1., 2e-3)), 5.));
  limit.learn({springs_of(1., 0.1)}, {{SoftnessLimit::Change{0.1, 1e-3}, SoftnessLimit::Change{}}});
  check("within the step it is no more than the last augmentation changed",
        is(limit.excess({springs_of(1., 0.1)})[0], 0.5));

  SoftnessLimit two({SoftnessLimit::Rule::general, SoftnessLimit::Rule::general});
  check("a pair counts with a hundredth of the largest force at least",
        is(two.excess({springs_of(100., 0.), springs_of(1e-3, 2e-4)})[1], 0.5));
  SoftnessLimit sticks({SoftnessLimit::Rule::general});
  check("friction with a fiftieth of the pressure",
        is(sticks.excess({springs_of(50., 0., 0., 2e-4)})[0], 0.5));
  check("and in its own proportion where it is more",
        is(sticks.excess({springs_of(50., 0., 10., 2e-3)})[0], 0.5));
  check("but not what iterations do not resolve: 0.01 of a pressure of 50",
        is(sticks.excess({springs_of(50., 0., 10., 2e-3)}, 1.9e-4)[0], 0.5) &&
            sticks.excess({springs_of(50., 0., 10., 2e-3)}, 2.1e-4)[0] == 0.);
  // Friction of 1: slip has used half of its 0.002, then all.
  SoftnessLimit slips({SoftnessLimit::Rule::general});
  slips.commit({springs_of(1., 0., 1., 1e-3)});
  slips.begin();
  check("slip of former steps takes from what is allowed",
        is(slips.excess({springs_of(1., 0., 1., 1e-4)})[0], 0.5));
  slips.commit({springs_of(1., 0., 1., 0.1)});
  check("a tenth of it is left", is(slips.excess({springs_of(1., 0., 1., 2e-5)})[0], 0.5));
}

/// The multiple of the allowed part that is missing in a sheet, whose springs hold this part of the force and
/// of which an augmentation has added three quarters to it.
double excess_of_sheet(const double held) {
  SoftnessLimit limit({SoftnessLimit::Rule::sheet});
  limit.learn({springs_of(1., held)}, {{SoftnessLimit::Change{held, 0.75 * held}, SoftnessLimit::Change{}}});
  return limit.excess({springs_of(1., held)})[0];
}

/// As much as that, if it is half of a geometric series; three times as much, if it is three quarters.
void check_sheets() {
  check("augmentations of a sheet show its stiffness if springs hold a hundredth of the force",
        is(excess_of_sheet(0.0102), 3. * 0.75 * 0.0102 / 0.002) &&
            is(excess_of_sheet(0.0098), 0.75 * 0.0098 / 0.002));
}

} // namespace

BILLET_TEST(softness_limit) {
  check_what_is_given_up();
  check_formula();
  check_sheets();
  for (const double K : {0.3, 0.1, 1e-2, 1e-3, 1e-5})
    for (const unsigned int n_steps : {1U, 10U, 100U}) {
      const std::string name = "K/k = " + std::to_string(K) + ", " + std::to_string(n_steps) + " steps: ";
      const Outcome outcome = press(K, n_steps);
      check(name + "what is missing", outcome.worst, 2e-3 * (1. + 1e-9));
      if (K < 2e-3) // once when it begins, and whenever the force has doubled
        check(name + "augmentations", outcome.augmentations <= 2 + std::log2(n_steps));
    }
  {
    SoftnessLimit limit({SoftnessLimit::Rule::none});
    check("a pair that does not limit it asks for nothing",
          limit.excess({Press{1., 1.}.springs(1.)})[0] == 0.);
  }
  {
    // What a step has learnt goes on from a checkpoint.
    SoftnessLimit limit({SoftnessLimit::Rule::general}), restored({SoftnessLimit::Rule::general});
    const ContactSprings before = Press{0.1, 1.}.springs(1.);
    limit.learn({before}, {{SoftnessLimit::Change{0.01, 0.01}, SoftnessLimit::Change{}}});
    restored.load(limit.save());
    limit.begin();
    check("a checkpoint has it all", limit.excess({before})[0] == restored.excess({before})[0]);
  }
}

} // namespace softness_limit_test
