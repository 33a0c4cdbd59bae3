// SPDX-License-Identifier: LGPL-2.1-or-later
// Where steps have to end, and in which directions nothing holds what moves.

#include "scene_run.h"

#include "../loads/make_load.h"

#include "billet/scene/expression.h"

#include <deal.II/base/mpi.h>

#include <cmath>

namespace stops_test {

using namespace billet;
using billet::testing::check;
using Times = std::vector<double>;

namespace {

parameters::Amplitude amplitude(const Times &times, const Times &values) {
  parameters::Amplitude result;
  result.name = "course";
  result.times = times;
  result.values = values;
  result.interpolation = parameters::Amplitude::Interpolation::linear;
  return result;
}

void check_corners() {
  check("a ramp begins and comes to rest", corners(amplitude({0., 1.}, {0., 2.})) == Times{0., 1.});
  check("one point rests", corners(amplitude({0.5}, {2.})).empty());
  check("so do equal values", corners(amplitude({0., 1., 2.}, {3., 3., 3.})).empty());
  check("a straight point is none", corners(amplitude({0., 0.3, 1.}, {0., 0.31, 1.})) == Times{0., 1.});
  check("nor is a pace somewhat slower", corners(amplitude({0., 0.5, 1.}, {0., 1., 1.6})) == Times{0., 1.});
  check("after a quick approach it still turns",
        corners(amplitude({0., 0.002, 0.6, 1.}, {0., 0.05, 0.1, 0.05})) == Times{0., 0.002, 0.6, 1.});
  check("a hold begins and ends, however short",
        corners(amplitude({0., 1., 1.001, 2.}, {0., 1., 1., 0.})) == Times{0., 1., 1.001, 2.});
  check("before time 0, too", corners(amplitude({-1., 0., 1.}, {0., 1., 0.})) == Times{-1., 0., 1.});
  constexpr double pi = 3.14159265358979323846;
  for (const unsigned int n : {24U, 240U}) {
    Times times, values;
    for (unsigned int i = 0; i <= 2 * n; ++i) {
      times.push_back(static_cast<double>(i) / n);
      values.push_back(1. - std::cos(2. * pi * times.back()));
    }
    const Times found = corners(amplitude(times, values));
    check("of a sampled curve those about its turning points",
          found.size() > 4 && found.size() < 14 && std::count(found.begin(), found.end(), 0.5) == 1);
  }
}

/// Stops of the billet, whose die's motion has an amplitude.
Times stops(const parameters::Amplitude &course, const Times &own, const bool is_used = true) {
  parameters::Scene parameters = testing::read_shipped_scene("billet_upsetting.prm");
  parameters.amplitudes = {course};
  parameters.tools[0].motion.translation.value = {{"0", "0", is_used ? "-course" : "-t"}};
  parameters.time_stepping.end_time = 2.;
  parameters.time_stepping.max_step = 0.1;
  parameters.time_stepping.stops = own;
  Times found = Scene(parameters).stops();
  std::sort(found.begin(), found.end());
  return found;
}

void check_stops() {
  const Times times = {0., 0.5, 1., 2.}, values = {0., 1., 0., 1.};
  check("steps end at corners", stops(amplitude(times, values), {}) == Times{0.5, 1.});
  check("not where the scene says so anyway, or as good as that",
        stops(amplitude(times, values), {0.50001, 1.}).empty());
  check("nor at those of an amplitude that drives nothing",
        stops(amplitude(times, values), {}, false).empty());
  check("of a jump at its beginning",
        stops(amplitude({0., 0.5, 0.500001, 2.}, {0., 0.1, 1., 1.1}), {}) == Times{0.5});

  parameters::TimeStepping stepping;
  stepping.control = parameters::TimeStepping::Control::automatic;
  stepping.end_time = 1.;
  stepping.initial_step = stepping.max_step = 0.25;
  stepping.min_step = 1e-6;
  StepControl control(stepping, 0., {0.5});
  check("the first step ends at none", !control.ends_at_stop());
  control.accept(3);
  check("the second does, and the next is as long",
        control.ends_at_stop() && control.time_after_next() == 0.75);
}

void check_free_directions() {
  using Directions = std::array<bool, 3>;
  const auto directions = [](parameters::Scene parameters, const auto &change) {
    change(parameters);
    return Scene(parameters).free_directions();
  };
  const parameters::Scene tubes = testing::read_shipped_scene("tube_impact.prm");
  check("nothing holds the tubes",
        directions(tubes, [](parameters::Scene &) {}) == Directions{{true, true, true}});
  const auto halved = [](parameters::Scene &scene) {
    scene.bodies[1].symmetry_planes.value = {{dealii::Tensor<1, 3>({1., 0., 0.}), 0., "x = 0"}};
  };
  check("symmetry planes hold along their normals",
        directions(tubes, halved) == Directions{{false, true, true}});
  const auto loaded = [](parameters::Scene &scene) {
    scene.bodies[1].loads = {testing::make_load("acceleration", "set Acceleration = 0 ; 0 ; -9.81")};
  };
  check("loads hold or drive", directions(tubes, loaded) == Directions{});
  const auto supported = [](parameters::Scene &scene) {
    scene.bodies[0].supports.resize(1);
    scene.bodies[0].supports[0].components = {{false, true, false}};
    scene.bodies[0].supports[0].displacement.value = {{"0", "0", "0"}};
  };
  check("supports do in theirs", directions(tubes, supported) == Directions{{true, false, true}});
  check("tools do in all", directions(testing::read_shipped_scene("taylor_bar.prm"),
                                      [](parameters::Scene &) {}) == Directions{});
}

} // namespace

BILLET_MPI_TEST(stops) {
  check_corners();
  check_stops();
  check_free_directions();
}

} // namespace stops_test
