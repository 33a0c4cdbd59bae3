// SPDX-License-Identifier: LGPL-2.1-or-later
// Depths that a finer mesh brings about on a tool, (R7): what counts as such a depth, how it fades in
// statics and in explicit steps, what leaves with a node, and what another scheme makes of it.
#include "billet/contact/rigid_contact_parts.h"

#include "../testing.h"

#include <deal.II/base/mpi.h>

namespace fading_gaps_test {

using namespace billet;
using namespace billet::testing;

namespace {

using Scheme = parameters::TimeStepping::Scheme;

parameters::Scene make_scene(const Scheme scheme) {
  const std::string scenes = std::string(SOURCE_DIR) + "/../scenes/";
  parameters::Scene parameters = parameters::Scene::read(scenes + "hard_blow.prm");
  parameters.time_stepping.scheme = scheme;
  if (scheme == Scheme::quasi_static) { // a scene needs supports
    parameters.bodies[0].supports = parameters::Scene::read(scenes + "block_on_plane.prm").bodies[0].supports;
    parameters.bodies[0].supports[0].displacement.value = {"0", "0", "0"};
  }
  return parameters;
}

/// A pair of a block and a plane, after a finer mesh has changed the gaps of three nodes.
struct Bench {
  explicit Bench(const Scheme scheme)
      : scene(make_scene(scheme)), discretization(scene, MPI_COMM_WORLD),
        parts(scene, scene.pairs()[0], discretization) {
    parts.states.resize(parts.slaves.nodes.size());
    set(0, -0.1, -0.3); // touched on the coarse mesh, and is deeper on the fine one
    set(1, -0.1, -0.05);
    set(2, 0.2, -0.4); // was open
  }

  void set(const std::size_t i, const double before, const double now) {
    parts.slaves.nodes[i].size = 1.;
    parts.slaves.nodes[i].gap_n = before;
    parts.states[i].gap = now;
  }
  double depth(const std::size_t i) const { return parts.slaves.nodes[i].initial_penetration; }
  double offset(const std::size_t i, const double time) {
    parts.step.allowed_part = parts.allowed_part(time);
    return parts.step.gap_offset(parts.slaves.nodes[i]);
  }

  Scene scene;
  Discretization discretization;
  RigidContactParts parts;
};

void check_statics() {
  Bench bench(Scheme::quasi_static);
  bench.parts.fade_gaps({1., 3.}, true);
  check("a node may have the depth that it has gained", near(bench.depth(0), 0.2, 1e-14));
  check("  none, if it is less deep", bench.depth(1) == 0.);
  check("  all, if it was open", near(bench.depth(2), 0.4, 1e-14));
  check("at first all of it counts as none", near(bench.offset(0, 1.), -0.2, 1e-14));
  check("  halfway half of it", near(bench.offset(0, 2.), -0.1, 1e-14));
  check("  at last and later nothing", bench.offset(0, 3.) == 0. && bench.offset(0, 9.) == 0.);
  check("  and before it all", near(bench.offset(0, 0.5), -0.2, 1e-14));

  bench.offset(0, 2.);
  bench.parts.fade_gaps({5., 6.}, false);
  check("statics that resume go on with the same times", near(bench.offset(0, 2.5), -0.05, 1e-14));

  Bench late(Scheme::quasi_static);
  late.parts.fade_gaps({1., 1.}, true);
  check("without time to fade, no depth counts as none", late.offset(0, 1.) == 0.);
}

void check_explicit() {
  Bench bench(Scheme::explicit_dynamics);
  bench.parts.fade_gaps({1., 3.}, true);
  check("in explicit steps depths fade, too", near(bench.offset(0, 2.), -0.1, 1e-14));
  bench.offset(0, 1.);
  bench.parts.states[0].gap = 0.05;
  bench.parts.states[2].gap = -0.1;
  bench.parts.states[2].status = ContactStatus::slip;
  bench.parts.commit();
  check("  less what a node leaves by", near(bench.depth(0), 0.15, 1e-14));
  check("  and all while it presses", near(bench.depth(2), 0.4, 1e-14));
  bench.parts.states[0].gap = 1.;
  bench.parts.commit();
  check("  nothing is left of it where it has left by more", bench.depth(0) == 0.);
}

void check_other_schemes() {
  Bench bench(Scheme::implicit_dynamics);
  bench.parts.fade_gaps({1., 3.}, true);
  check("implicit dynamics allows no depths", bench.depth(0) == 0. && !bench.parts.fading_gaps);

  Bench to_dynamics(Scheme::implicit_dynamics);
  to_dynamics.parts.slaves.nodes[0].initial_penetration = 0.2;
  to_dynamics.parts.fading_gaps = FadingGaps{1., 3.};
  to_dynamics.offset(0, 2.5);
  to_dynamics.parts.fade_gaps({2.5, 3.}, false);
  check("  but keeps what others had left", near(to_dynamics.offset(0, 9.), -0.05, 1e-14));

  Bench from_statics(Scheme::explicit_dynamics);
  from_statics.parts.slaves.nodes[0].initial_penetration = 0.2;
  from_statics.parts.fading_gaps = FadingGaps{1., 3.}; // as a checkpoint of statics has it
  from_statics.offset(0, 2.5);
  from_statics.parts.fade_gaps({2.5, 2.5}, false);
  check("explicit steps go on with the times of statics", near(from_statics.offset(0, 2.75), -0.025, 1e-14));

  Bench to_statics(Scheme::quasi_static);
  to_statics.parts.slaves.nodes[0].initial_penetration = 0.2;
  to_statics.parts.fading_gaps = FadingGaps{1., std::numeric_limits<double>::infinity()};
  to_statics.offset(0, 2.);
  to_statics.parts.fade_gaps({2., 4.}, false);
  check("statics fade what implicit dynamics has kept", near(to_statics.offset(0, 3.), -0.1, 1e-14));
}

} // namespace

BILLET_MPI_TEST(fading_gaps) {
  check_statics();
  check_explicit();
  check_other_schemes();
}

} // namespace fading_gaps_test
