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

} // namespace

BILLET_TEST(softness_limit) {
  check_what_is_given_up();
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
