// SPDX-License-Identifier: LGPL-2.1-or-later
// Friction laws alone: limits against their closed forms, slopes against finite differences, and the return
// map with them: the traction lies on the law's limit at the slip rate that it leaves, and its exact tangent
// is its derivative.
#include "billet/contact/traction.h"
#include "billet/friction/coulomb.h"
#include "billet/friction/pressure_dependent.h"
#include "billet/friction/shear_limited.h"
#include "billet/friction/static_kinetic.h"

#include "../testing.h"

namespace friction_laws_test {

using namespace billet;
using billet::testing::central_difference;
using billet::testing::check;
using billet::testing::WorstError;

namespace {

constexpr ContactStiffness stiffness{3.5e5, 1.2e5};
constexpr double duration = 0.02;

void check_law(const std::string &name, const FrictionLaw &law) {
  billet::testing::Random random;
  WorstError pressure_slope, rate_slope, on_limit, back_along_trial, tangent;
  unsigned int n_slip = 0;
  for (unsigned int sample = 0; sample < 400; ++sample) {
    const double pressure = random(5., 3000.), rate = random(0., 0.5);
    const FrictionLimit here = law.limit(pressure, rate);
    pressure_slope.add(std::abs(
        central_difference([&](double h) { return law.limit(pressure + h, rate).value; }, 1e-3 * pressure) -
        here.pressure_slope));
    if (rate > 0.01)
      rate_slope.add(
          std::abs(central_difference([&](double h) { return law.limit(pressure, rate + h).value; }, 1e-3) -
                   here.rate_slope) /
          pressure);

    const double gap = -pressure / stiffness.normal;
    const std::array<double, 2> before{random(-100., 100.), random(-100., 100.)};
    TangentialIncrement increment{{random(-0.01, 0.01), random(-0.01, 0.01)}};
    increment.per_time = 1. / duration;
    const auto evaluate = [&](const double g, const std::array<double, 2> &value) {
      TangentialIncrement moved = increment;
      moved.value = value;
      return compute_traction(law, stiffness, {}, g, before, moved);
    };
    const FrameTraction t = evaluate(gap, increment.value);
    const double size = std::hypot(t.tangential[0], t.tangential[1]);
    const double slip = std::hypot(t.slip[0], t.slip[1]);
    if (t.status != ContactStatus::slip || slip < 1e-4)
      continue;
    ++n_slip;
    on_limit.add(std::abs(size - law.limit(t.pressure, slip / duration).value) / size);
    back_along_trial.add(std::abs(t.slip[0] * t.tangential[1] - t.slip[1] * t.tangential[0]) / (slip * size));
    if (std::abs(law.limit(pressure * 1.01, 0.).pressure_slope -
                 law.limit(pressure * 0.99, 0.).pressure_slope) > 0.1 * here.pressure_slope)
      continue; // across the shear limit's kink
    for (unsigned int j = 0; j < 3; ++j)
      for (unsigned int i = 0; i < 3; ++i) {
        const double derivative = central_difference(
            [&](const double h) {
              auto value = increment.value;
              if (j < 2)
                value[j] += h;
              const FrameTraction moved = evaluate(j == 2 ? gap + h : gap, value);
              return i == 2 ? moved.pressure : moved.tangential[i];
            },
            j == 2 ? 1e-4 * std::abs(gap) : 1e-6);
        tangent.add(std::abs(t.tangent[i][j] + derivative) / stiffness.normal);
      }
  }
  check(name + ": some points slip", n_slip > 50);
  check(name + ": slope over pressure", pressure_slope.value(), 1e-8);
  check(name + ": slope over slip rate", rate_slope.value(), 1e-7);
  check(name + ": the traction lies on the limit", on_limit.value(), 1e-12);
  check(name + ": the slip is against the traction", back_along_trial.value(), 1e-12);
  check(name + ": exact tangent", tangent.value(), 1e-7);
}

} // namespace

BILLET_TEST(friction_laws) {
  check_law("Coulomb", Coulomb{0.3});
  check_law("shear limited", ShearLimited{0.3, 1e9});
  check_law("shear limited, at its limit", ShearLimited{0.3, 1.});
  check_law("static-kinetic", StaticKinetic{0.3, 0.1, 8.});
  check_law("pressure dependent", PressureDependent{0.3, 200., 0.7});

  check("shear limited: the smaller of the two",
        std::abs(ShearLimited{0.2, 50.}.limit(300., 0.).value - 50.) +
            std::abs(ShearLimited{0.2, 50.}.limit(200., 0.).value - 40.),
        1e-13);
  check("static-kinetic at rest", std::abs(StaticKinetic{0.3, 0.1, 8.}.limit(100., 0.).value - 30.), 1e-13);
  check("static-kinetic when fast", std::abs(StaticKinetic{0.3, 0.1, 8.}.limit(100., 100.).value - 10.),
        1e-13);
  check("pressure dependent at its reference",
        std::abs(PressureDependent{0.3, 200., 0.7}.limit(200., 0.).value - 60.), 1e-13);
}

} // namespace friction_laws_test
