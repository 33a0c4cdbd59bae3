// SPDX-License-Identifier: LGPL-2.1-or-later
// Levels of bodies' meshes, against errors in closed form: each body makes c_b h_b^p.
#include "billet/run/body_levels.h"

#include "../testing.h"

namespace body_levels_test {

using namespace billet;
using billet::testing::check;

namespace {

/// Bodies with these errors at level 0.
struct Model {
  std::vector<double> errors;
  double order;
  double estimated = 1.; ///< estimates of bodies over their errors

  double error(const std::vector<int> &levels) const {
    double sum = 0.;
    for (std::size_t b = 0; b < levels.size(); ++b)
      sum += errors[b] * std::exp2(-order * levels[b]);
    return sum;
  }
  /// Rises to the target, at most n times.
  BodyLevels climb(const double target, const unsigned int n) const {
    BodyLevels bodies(errors.size(), 0, target);
    double before = 0.;
    for (unsigned int run = 0; run <= n; ++run) {
      if (run > 0)
        bodies.rise();
      const double now = error(bodies.levels());
      std::vector<BodyMesh> meshes;
      for (std::size_t b = 0; b < errors.size(); ++b)
        meshes.push_back({static_cast<std::size_t>(1) << (3 * bodies.levels()[b]),
                          estimated * errors[b] * std::exp2(-order * bodies.levels()[b])});
      bodies.add(before - now, meshes);
      before = now;
      if (bodies.is_met())
        break;
    }
    return bodies;
  }
};

} // namespace

BILLET_TEST(body_levels) {
  constexpr double safety = 1.25; // of an observed order
  const Model one{{0.5}, 2.};
  const BodyLevels of_one = one.climb(0.01, 9);
  check("one body rises until its error is small", of_one.levels() == std::vector<int>{3});
  check("its error is the true one, with safety",
        std::abs(of_one.error().error / (safety * one.error({3})) - 1.), 1e-12);

  const Model two{{0.5, 0.001}, 2., 0.4};
  const BodyLevels of_two = two.climb(0.0125, 9);
  check("a body of little error stays behind", of_two.levels() == std::vector<int>({3, 1}));
  // The first level had no order to observe.
  check("their error is the true one, with safety of the body that rises",
        std::abs(of_two.error().error / (safety * 0.5 / 64. + 0.001 / 4.) - 1.), 1e-12);
  check("their order is that of the body that rises", std::abs(of_two.error().order - 2.), 1e-12);
  // An order of 1 instead of 2 makes the first difference three times the error.
  check("without estimates the order is 1 at first",
        std::abs(Model{{0.5}, 2., 0.}.climb(0.01, 1).error().error / one.error({1}) - 3.), 1e-12);
  check("without estimates all rise",
        Model{{0.5, 0.001}, 2., 0.}.climb(0.01, 9).levels() == std::vector<int>({3, 3}));

  const Model many{{0.3, 0.2, 0.03, 0.001}, 1.};
  const BodyLevels of_many = many.climb(0.01, 20);
  check("each of many stays behind at a level of its own",
        of_many.levels() == std::vector<int>({7, 7, 6, 1}));
  check("the error of many is met", of_many.is_met() && many.error(of_many.levels()) <= 0.01);

  const BodyLevels short_of = two.climb(0.0125, 2);
  check("not met", !short_of.is_met());
  check("what it takes", short_of.rises_to_target() == 1);
  check("elements that it takes", std::abs(short_of.growth() - (8. * 64. + 8.) / (64. + 8.)), 1e-12);

  BodyLevels again(2, -2, 0.1);
  again.add(0., {{1, 0.1}, {1, 0.1}});
  again.restart();
  check("a level that fails is left out",
        again.level() == -1 && !again.has_error() && again.levels() == std::vector<int>({-1, -1}));

  // Two coarse meshes may miss the same detail; on the way to the given mesh no body stays behind.
  BodyLevels below(2, -2, 0.1);
  below.add(0., {{1, 0.5}, {1, 0.}});
  below.rise();
  below.add(0., {{8, 0.5}, {8, 0.}});
  check("two meshes coarser than given do not do", !below.is_met());
  below.rise();
  check("all rise to the given mesh", below.levels() == std::vector<int>({0, 0}));
  below.add(0., {{64, 0.5}, {64, 0.}});
  check("the given mesh does", below.is_met());
  BodyLevels ordered(1, -3, 0.1);
  for (const double difference : {0., 0.04, 0.01}) {
    if (difference > 0.)
      ordered.rise();
    ordered.add(difference, {{1, 0.5}});
  }
  check("three coarser ones do", ordered.level() == -1 && ordered.is_met());

  // Differences from a mesh of single elements tell nothing: the next two do.
  BodyLevels walls(1, 0, 0.1);
  walls.add(0., {{1, 0., false}});
  walls.rise();
  walls.add(1e-3, {{8, 0.04}});
  check("a level of single elements shows no error", !walls.error().is_known && !walls.is_met());
  walls.rise();
  walls.add(0.02, {{64, 0.02}});
  check("the levels after it do", walls.is_met() && std::abs(walls.error().error - 0.02) < 1e-12);

  BodyLevels rising(2, 0, 0.1);
  for (const double difference : {0., 0.1, 0.2}) {
    if (rising.has_error() || difference > 0.)
      rising.rise();
    rising.add(difference, {{1, 0.5}, {1, 0.}});
  }
  check("differences that grow: no order, and all rise that rose",
        !rising.error().is_known && !rising.is_met());
}

} // namespace body_levels_test
