// SPDX-License-Identifier: LGPL-2.1-or-later
// A rate factor that the library does not know, registered here and named by a scene, and that of Cowper and
// Symonds: the flow stress of one step against (M15) of doc/theory.md, steps that tend to the rate's own flow
// curve, and explicit dynamics against statics.

#include "pulled_cube.h"

#include "billet/material/rate_factor.h"

namespace added_rate_factor_test {

using namespace billet;
using billet::testing::check;

namespace {

/// 1 + C ln(1 + ε̇/D).
class LogarithmicFactor final : public RateFactor {
public:
  LogarithmicFactor(const double reference, const double factor) : reference_(reference), factor_(factor) {}

  std::string description() const override { return "times a logarithm of the rate"; }
  double value(const double rate) const override { return 1. + factor_ * std::log1p(rate / reference_); }
  double slope(const double rate) const override { return factor_ / (reference_ + rate); }

private:
  double reference_, factor_;
};

RateFactorType logarithmic_type() {
  using Kind = TypeParameter::Kind;
  return {"logarithmic",
          "1 + C ln(1 + rate/D)",
          {{"Reference rate", "0", Kind::number, "D > 0, at which the flow stress has doubled. [1/time]"},
           {"Logarithmic factor", "0", Kind::number, "C > 0."}},
          [](const TypeInput &input) -> std::shared_ptr<const RateFactor> {
            return std::make_shared<const LogarithmicFactor>(input.positive("Reference rate"),
                                                             input.positive("Logarithmic factor"));
          }};
}

struct Case {
  std::string parameters;
  std::function<double(double)> factor; ///< of a rate
};

const Case
    logarithmic = {"set Rate factor = logarithmic\nset Reference rate = 2\nset Logarithmic factor = 0.1",
                   [](const double rate) { return 1. + 0.1 * std::log1p(rate / 2.); }},
    cowper_symonds = {"set Rate factor = Cowper-Symonds\nset Reference rate = 40\nset Rate exponent = 5",
                      [](const double rate) { return 1. + std::pow(rate / 40., 0.2); }};

std::string material(const Case &chosen) {
  return "set Young modulus = 200e3\nset Poisson ratio = 0.3\nset Yield stress = 300\nset Hardening modulus "
         "= 500\n" +
         chosen.parameters;
}

/// The same by n steps of (M15), E (ε − α) = (300 + 500 α) R(Δα/Δt): elastic energy and plastic work.
std::array<double, 2> integrate(const Case &chosen, const double stretch, const double duration,
                                const unsigned int n) {
  double alpha_n = 0., work = 0., stress = 0.;
  const double dt = duration / n;
  for (unsigned int i = 1; i <= n; ++i) {
    const double strain = std::log(1. + (stretch - 1.) * 0.5 * (1. - std::cos(dealii::numbers::PI * i / n)));
    const auto trial = [&](const double alpha) { return testing::cube_young * (strain - alpha); };
    const auto flow = [&](const double alpha) {
      return (300. + 500. * alpha) * chosen.factor((alpha - alpha_n) / dt);
    };
    double alpha = alpha_n;
    if (trial(alpha_n) > 300. + 500. * alpha_n) {
      double low = alpha_n, high = strain;
      for (unsigned int k = 0; k < 200; ++k) {
        alpha = 0.5 * (low + high);
        (trial(alpha) > flow(alpha) ? low : high) = alpha;
      }
    }
    work += chosen.factor((alpha - alpha_n) / dt) * (300. + 250. * (alpha + alpha_n)) * (alpha - alpha_n);
    stress = trial(alpha);
    alpha_n = alpha;
  }
  return {0.5 * stress * stress / testing::cube_young, work};
}

void test(const std::string &name, const Case &chosen) {
  constexpr double stretch = 1.2, duration = 0.1;
  for (const std::string element : testing::all_element_names)
    for (const unsigned int n : {1U, 10U}) {
      const auto found = testing::pull(element, material(chosen), stretch, duration, n);
      const auto exact = integrate(chosen, stretch, duration, n);
      const std::string what = name + ", " + element + ", steps: " + std::to_string(n);
      check(what + ", elastic energy", std::abs(found.elastic - exact[0]) / exact[1], 1e-8);
      check(what + ", plastic work", std::abs(found.plastic / exact[1] - 1.), 1e-8);
    }
  // Twice as fast takes more work.
  const auto work = [&](const double time) {
    return testing::pull("one point", material(chosen), 1.2, time, 50).plastic;
  };
  const double slow = work(1e-1), fast = work(1e-3);
  check(name + ", faster takes more", fast > 1.05 * slow);
  constexpr double quick = 2e-4;
  check(name + ", explicit",
        std::abs(testing::pull_explicitly("assumed strain", material(chosen), 1.2, quick).plastic /
                     integrate(chosen, 1.2, quick, 4000)[1] -
                 1.),
        5e-3);
}

} // namespace

BILLET_MPI_TEST(added_rate_factor) {
  rate_factor_types().add(logarithmic_type());
  test("logarithmic", logarithmic);
  test("Cowper and Symonds", cowper_symonds);
}

} // namespace added_rate_factor_test
