// SPDX-License-Identifier: LGPL-2.1-or-later
// A slave node on a facet of a deformable body: the reaction on the facet's corners balances force and
// moment, and friction in the frame that goes along with the facet.
#include "billet/contact/slave_traction.h"
#include "billet/contact/facet_reaction.h"
#include "billet/friction/coulomb.h"
#include "billet/friction/static_kinetic.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/facet_rotation.h"
#include "billet/geometry/planed_facet.h"

#include "../geometry/facet_samples.h"

namespace slave_traction_test {

using namespace billet;
using billet::testing::check;
using billet::testing::Random;
using billet::testing::random_facet;
using billet::testing::random_vector;
using billet::testing::WorstError;
using dealii::Tensor;

namespace {

const Tensor<2, 3> identity = dealii::unit_symmetric_tensor<3>();
constexpr ContactStiffness stiffness{2e3, 1e3};

Tensor<1, 3> point_on(Random &random, const FacetCorners &corners) {
  return facet::interpolate(facet::weights({random(-0.9, 0.9), random(-0.9, 0.9)}), corners);
}

template <class Facet> void check_balance(const std::string &name) {
  Random random;
  WorstError force_error, moment_error, pressure_error;
  double max_couple = 0.;
  for (unsigned int i = 0; i < 3000; ++i) {
    const double size = std::pow(10., random(-6., 6.));
    FacetCorners corners = random_facet(random, size, 0.2);
    if (i % 4 == 0)
      corners[3] = corners[1];
    const Tensor<1, 3> x = point_on(random, corners) + random_vector(random, 0.1 * size);
    const FacetProjection p = Facet(corners).project(x, {});
    if (!p.exists)
      continue;
    const Tensor<1, 3> force = random_vector(random, std::pow(10., random(-6., 6.)));
    const auto balance = [&](const Tensor<1, 3> &F, WorstError &forces, WorstError &moments) {
      const FacetCorners reaction = FacetReaction(corners)(p.weights, x, F);
      Tensor<1, 3> sum = F, moment = dealii::cross_product_3d(x - corners[0], F);
      double couple = 0.;
      for (unsigned int a = 0; a < 4; ++a) {
        sum += reaction[a];
        moment += dealii::cross_product_3d(corners[a] - corners[0], reaction[a]);
        couple = std::max(couple, (reaction[a] + p.weights[a] * F).norm() / F.norm());
      }
      forces.add(sum.norm() / F.norm());
      moments.add(moment.norm() / (F.norm() * size));
      return couple;
    };
    max_couple = std::max(max_couple, balance(force, force_error, moment_error));
    // The weights balance a pressure without the couple.
    pressure_error.add(balance(force[0] * p.normal, force_error, moment_error));
  }
  check(name + ": forces on a node and a facet balance", force_error.value(), 1e-15);
  check(name + ": their moments balance", moment_error.value(), 4e-15);
  check(name + ": a pressure needs no couple", pressure_error.value(), 1e-14);
  check(name + ": friction does", max_couple > 0.01);
}

void check_rotation() {
  Random random;
  WorstError rigid, orthogonal, stretched;
  for (unsigned int i = 0; i < 2000; ++i) {
    const FacetCorners corners = random_facet(random, 1., 0.3);
    const Tensor<2, 3> R = random.rotation();
    const Tensor<1, 3> shift = random_vector(random, 3.);
    FacetCorners moved;
    for (unsigned int a = 0; a < 4; ++a)
      moved[a] = R * corners[a] + shift;
    rigid.add((facet_rotation(corners, moved) - R).norm());
    for (auto &x : moved)
      x += random_vector(random, 0.2);
    const Tensor<2, 3> Q = facet_rotation(corners, moved);
    orthogonal.add((Q * dealii::transpose(Q) - identity).norm());
    orthogonal.add(std::abs(dealii::determinant(Q) - 1.));
    const Tensor<2, 3> forth_and_back = facet_rotation(moved, corners) * Q;
    stretched.add((forth_and_back - identity).norm());
  }
  check("rotation of a facet: that of a rigid motion", rigid.value(), 1e-14);
  check("rotation of a facet: is one", orthogonal.value(), 1e-14);
  check("rotation of a facet: back again", stretched.value(), 1e-14);
  const FacetCorners corners = random_facet(random, 1., 0.);
  const FacetCorners point{corners[0], corners[0], corners[0], corners[0]};
  check("rotation of a facet: the identity without an area",
        facet_rotation(point, corners) == identity && facet_rotation(corners, point) == identity);
}

/// Node and facet, with one step after another.
struct Pair {
  FacetCorners corners;
  Tensor<1, 3> x;
  SlaveHistory history;

  SlaveTraction step(const FrictionLaw &law, const FacetCorners &new_corners, const Tensor<1, 3> &new_x,
                     const double duration) {
    const FacetProjection p = PlanedFacet(new_corners).project(new_x, {});
    const SlaveMotion motion = compute_slave_motion(corners, new_corners, p.weights, x, new_x, duration);
    const SlaveTraction t = compute_slave_traction(law, stiffness, p.normal, p.gap, motion, history, history);
    corners = new_corners;
    x = new_x;
    return t;
  }
};

/// In contact, and stretched sideways by about a hundredth of the facet.
Pair make_pair(Random &random) {
  Pair pair{random_facet(random, 1., 0.1), {}, {}};
  const Tensor<1, 3> normal = PlanedFacet(pair.corners).project(pair.corners[0], {}).normal;
  pair.x = point_on(random, pair.corners) - 0.05 * normal;
  pair.step(Coulomb{100.}, pair.corners, pair.x, 0.);
  pair.step(Coulomb{100.}, pair.corners, pair.x + 0.01 * pair.history.frame.q - 0.007 * pair.history.frame.r,
            0.);
  return pair;
}

void check_rigid_rotation() {
  Random random;
  WorstError components, slip, frame_error, magnitude;
  for (unsigned int i = 0; i < 10; ++i) {
    Pair pair = make_pair(random);
    const std::array<double, 2> start = pair.history.tangential;
    const Frame first = pair.history.frame;
    magnitude.add(
        std::abs(std::hypot(start[0], start[1]) / (stiffness.tangential * std::hypot(0.01, 0.007)) - 1.));
    Tensor<1, 3> axis = random_vector(random, 1.);
    axis /= axis.norm();
    const FacetCorners corners = pair.corners;
    const Tensor<1, 3> x = pair.x;
    constexpr unsigned int n = 10000;
    Tensor<2, 3> R;
    for (unsigned int k = 1; k <= n; ++k) {
      // Three turns in all, and a drift.
      R = dealii::Physics::Transformations::Rotations::rotation_matrix_3d(axis, 6. * M_PI * k / n);
      const Tensor<1, 3> shift = 1e-3 * k * axis;
      FacetCorners moved;
      for (unsigned int a = 0; a < 4; ++a)
        moved[a] = R * corners[a] + shift;
      slip.add(pair.step(Coulomb{100.}, moved, R * x + shift, 0.).slip);
    }
    for (unsigned int k = 0; k < 2; ++k)
      components.add(std::abs(pair.history.tangential[k] - start[k]) / stiffness.tangential);
    const Frame &Z = pair.history.frame;
    frame_error.add((Z.q - R * first.q).norm() + (Z.r - R * first.r).norm() + (Z.n - R * first.n).norm());
    frame_error.add((dealii::cross_product_3d(Z.q, Z.r) - Z.n).norm() + std::abs(Z.q * Z.r));
  }
  check("a pair that sticks has the traction of its stretch", magnitude.value(), 1e-12);
  check("ten thousand small turns keep the traction components", components.value(), 1e-12);
  check("and do not slip", slip.value(), 0.);
  check("and carry an orthonormal frame along", frame_error.value(), 1e-11);
}

void check_friction() {
  Random random;
  WorstError cycle, energy, cone, direction, work;
  for (unsigned int i = 0; i < 200; ++i) {
    Pair pair{random_facet(random, 1., 0.), {}, {}};
    const Tensor<1, 3> n = PlanedFacet(pair.corners).project(pair.corners[0], {}).normal;
    pair.x = point_on(random, pair.corners) - 0.01 * n;
    pair.step(Coulomb{0.3}, pair.corners, pair.x, 1.);
    const Frame Z = pair.history.frame;
    const Tensor<1, 3> x = pair.x;

    // Around a loop small enough to stick all the way.
    SlaveTraction t;
    for (unsigned int k = 1; k <= 20; ++k)
      t = pair.step(Coulomb{0.3}, pair.corners,
                    x + 2e-3 * (std::sin(0.1 * M_PI * k) * Z.q + (1. - std::cos(0.1 * M_PI * k)) * Z.r), 1.);
    cycle.add((t.traction - stiffness.normal * 0.01 * n).norm() / stiffness.normal);
    energy.add(std::abs(t.stored_energy - 0.5 * stiffness.normal * 1e-4) / stiffness.normal);

    // Slide: μ p against the motion; all work goes into the spring and into heat.
    const double angle = random(0., 2. * M_PI);
    const Tensor<1, 3> along = std::cos(angle) * Z.q + std::sin(angle) * Z.r;
    double heat = 0., path = 0., work_done = 0.;
    for (unsigned int k = 0; k < 100; ++k) {
      const Tensor<1, 3> before = t.traction;
      t = pair.step(Coulomb{0.3}, pair.corners, pair.x + 2e-4 * along, 1.);
      heat += t.dissipation;
      path += t.slip;
      work_done -= 0.5 * (before + t.traction) * along * 2e-4;
    }
    cone.add(std::abs((t.traction - t.pressure * n).norm() - 0.3 * t.pressure) / stiffness.normal);
    cone.add(std::abs(t.pressure - 0.01 * stiffness.normal) / stiffness.normal);
    direction.add((t.traction - t.pressure * n + 0.3 * t.pressure * along).norm() / stiffness.normal);
    direction.add(std::abs(pair.history.slip - path));
    work.add(std::abs(heat + t.stored_energy - 0.5 * stiffness.normal * 1e-4 - work_done) / work_done);
  }
  check("a loop without slip leaves no friction", cycle.value(), 1e-14);
  check("and no energy in its spring", energy.value(), 1e-14);
  check("sliding traction is the coefficient times the pressure", cone.value(), 1e-12);
  check("against the motion", direction.value(), 1e-13);
  check("work is heat and energy stored", work.value(), 1e-2);
}

void check_entry() {
  // A node that comes through a third of the way down: two thirds of the tangential motion count.
  Random random;
  const FacetCorners corners = random_facet(random, 1., 0.);
  const FacetProjection p = PlanedFacet(corners).project(corners[0], {});
  const Tensor<1, 3> foot = point_on(random, corners);
  const Tensor<1, 3> along = Frame::from_normal(p.normal).q;
  Pair pair{corners, foot + 0.01 * p.normal - 0.003 * along, {}};
  const SlaveTraction t = pair.step(Coulomb{100.}, corners, foot - 0.02 * p.normal, 1.);
  const Tensor<1, 3> expected =
      0.02 * stiffness.normal * p.normal - 2. / 3. * 0.003 * stiffness.tangential * along;
  check("a node that enters slides from there on", (t.traction - expected).norm() / stiffness.normal, 1e-14);

  const SlaveTraction frictionless =
      compute_slave_traction(Frictionless(), stiffness.normal, p.normal, -0.02);
  check("without friction: pressure only",
        (frictionless.traction - 0.02 * stiffness.normal * p.normal).norm() / stiffness.normal +
            std::abs(frictionless.stored_energy / (0.5 * stiffness.normal * 0.0004) - 1.),
        1e-14);
}

void check_slip_rate() {
  // Twice as fast, in half the time: a law that looks at the rate answers by the rate.
  const StaticKinetic law{0.4, 0.1, 1.};
  Random random;
  Pair pair{random_facet(random, 1., 0.), {}, {}};
  const Tensor<1, 3> n = PlanedFacet(pair.corners).project(pair.corners[0], {}).normal;
  pair.x = point_on(random, pair.corners) - 0.01 * n;
  pair.step(law, pair.corners, pair.x, 0.1);
  SlaveTraction t;
  for (unsigned int k = 0; k < 200; ++k)
    t = pair.step(law, pair.corners, pair.x + 1e-3 * pair.history.frame.q, 0.05);
  const double coefficient = law.limit(1., 1e-3 / 0.05).value;
  check("a law of the slip rate", std::abs((t.traction - t.pressure * n).norm() / t.pressure - coefficient),
        1e-10);
}

/// A node that comes down on a facet at rest, sticks, slides this way and that under a changing pressure and
/// lifts: the work of its tangential tractions is what friction dissipates and damps, since nothing is stored
/// before and after. The area changes with each step.
void check_account(const double start_weight, const std::string &rule_name) {
  const FrictionRule rule{stiffness.tangential, start_weight};
  const Coulomb law{0.6};
  Random random;
  WorstError balance, still, steady, negative;
  for (unsigned int sample = 0; sample < 50; ++sample) {
    Pair pair{random_facet(random, 1., 0.), {}, {}};
    const Tensor<1, 3> n = PlanedFacet(pair.corners).project(pair.corners[0], {}).normal;
    const Tensor<1, 3> start = point_on(random, pair.corners);
    pair.x = start + 0.001 * n;
    Tensor<1, 3> force_n;
    double work = 0., dissipated = 0., damped = 0., maximum = 0., area_n = 0.;
    constexpr unsigned int n_steps = 30;
    for (unsigned int k = 1; k <= n_steps; ++k) {
      const SlaveHistory history_n = pair.history;
      const Tensor<1, 3> x_n = pair.x;
      const double depth = k < n_steps ? random(0.001, 0.01) : -0.001;
      Tensor<1, 3> x = start + random_vector(random, 0.01);
      x -= (depth + (x - start) * n) * n;
      const FacetProjection p = PlanedFacet(pair.corners).project(x, {});
      const SlaveMotion motion = compute_slave_motion(pair.corners, pair.corners, p.weights, x_n, x, 0.);
      Tensor<1, 3> traction;
      if (depth > 0.) {
        const SlaveTraction t = pair.step(law, pair.corners, x, 0.);
        traction = t.traction - t.pressure * n;
      } else
        pair.history = SlaveHistory();
      const FrictionAccount account = compute_friction_account(history_n, pair.history, motion, rule);
      const double area = depth > 0. ? random(0.5, 2.) : 0.;
      dissipated += account.dissipated(area_n, area);
      damped += area * account.damping;
      // With the area of the start, which changes what the spring holds by itself.
      negative.add(std::max(0., -account.dissipated(1., 1.)));
      work -= (start_weight * force_n + (1. - start_weight) * area * traction) * (x - x_n);
      maximum = std::max(maximum, std::abs(work));
      force_n = area * traction;
      area_n = area;
    }
    balance.add(std::abs(dissipated + damped - work) / maximum);
    still.add(start_weight == 0.5 ? std::abs(damped) : std::max(0., -damped));

    // Moved as one rigid body it dissipates nothing; sliding steadily, what the return map says.
    Pair turned = make_pair(random);
    const SlaveHistory history_n = turned.history;
    const Tensor<2, 3> R = random.rotation();
    FacetCorners corners = turned.corners;
    for (auto &corner : corners)
      corner = R * corner;
    const Tensor<1, 3> x_n = turned.x, x = R * turned.x;
    const FacetCorners corners_n = turned.corners;
    const FacetProjection p = PlanedFacet(corners).project(x, {});
    turned.step(Coulomb{100.}, corners, x, 0.);
    const SlaveMotion rigid = compute_slave_motion(corners_n, corners, p.weights, x_n, x, 0.);
    still.add(std::abs(compute_friction_account(history_n, turned.history, rigid, rule).dissipated(1., 1.)));
  }
  check(rule_name + " account: what tractions do from touching to lifting", balance.value(), 1e-12);
  check(rule_name + " account: nothing in a rigid motion", still.value(), 1e-11);
  if (start_weight == 0.)
    check(rule_name + " account: friction makes no energy", negative.value(), 1e-12);

  Pair pair{random_facet(random, 1., 0.), {}, {}};
  const Tensor<1, 3> n = PlanedFacet(pair.corners).project(pair.corners[0], {}).normal;
  pair.x = point_on(random, pair.corners) - 0.01 * n;
  for (unsigned int k = 0; k < 20; ++k) {
    const SlaveHistory history_n = pair.history;
    const Tensor<1, 3> x_n = pair.x;
    const Tensor<1, 3> x = x_n + 3e-3 * (k == 0 ? Tensor<1, 3>() : pair.history.frame.q);
    const FacetProjection p = PlanedFacet(pair.corners).project(x, {});
    const SlaveMotion motion = compute_slave_motion(pair.corners, pair.corners, p.weights, x_n, x, 0.);
    const SlaveTraction t = pair.step(law, pair.corners, x, 0.);
    if (k > 10)
      steady.add(std::abs(compute_friction_account(history_n, pair.history, motion, rule).dissipated(1., 1.) /
                              t.dissipation -
                          1.));
  }
  check(rule_name + " account: that of the return map where the traction stays", steady.value(), 1e-10);
}

/// A node that slides as it comes down on a facet at rest, or leaves it: one step dissipates what a thousand
/// do, but for what its spring takes. And one that its spring pulls back farther than that can makes none.
void check_parts_of_steps() {
  Random random;
  const Coulomb law{0.6};
  constexpr double depth = 0.01, height = 0.02, slide = 0.3;
  const FrictionRule rule{stiffness.tangential, 0.5, &FrictionAccounting::of_equilibria};
  const auto dissipated = [&](const bool enters, const unsigned int n_steps) {
    Random same;
    Pair pair{random_facet(same, 1., 0.), {}, {}};
    const Tensor<1, 3> n = PlanedFacet(pair.corners).project(pair.corners[0], {}).normal;
    const Frame frame = Frame::from_normal(n);
    const Tensor<1, 3> middle = point_on(same, pair.corners);
    pair.x = middle + (enters ? height : -depth) * n;
    if (!enters) // slides already
      for (unsigned int k = 0; k < 20; ++k)
        pair.step(law, pair.corners, pair.x + 0.01 * frame.q, 0.);
    const Tensor<1, 3> start = pair.x;
    double sum = 0.;
    for (unsigned int k = 1; k <= n_steps; ++k) {
      const double way = static_cast<double>(k) / n_steps, gap_n = (pair.x - middle) * n,
                   gap = enters ? height - way * (height + depth) : -depth + way * (height + depth);
      const Tensor<1, 3> x_n = pair.x, x = start + way * slide * frame.q + (gap - (start - middle) * n) * n;
      const SlaveHistory history_n = pair.history;
      const SlaveMotion motion = compute_slave_motion(
          pair.corners, pair.corners, PlanedFacet(pair.corners).project(x, {}).weights, x_n, x, 0.);
      if (gap < 0.)
        pair.step(law, pair.corners, x, 0.);
      else
        pair.history = SlaveHistory();
      pair.x = x;
      if (!history_n.is_active && gap >= 0.)
        continue;
      double part = 1.;
      if (!history_n.is_active)
        part = gap / (gap - gap_n);
      else if (gap > 0.)
        part = part_before_leaving(-gap_n, gap - gap_n);
      sum += compute_friction_account(history_n, pair.history, motion, rule, part).dissipated(1., 1.);
    }
    return sum;
  };
  for (const bool enters : {true, false})
    check(std::string(enters ? "entering" : "leaving") + " in one step dissipates what a thousand do",
          std::abs(dissipated(enters, 1) / dissipated(enters, 1000) - 1.), 0.05);

  const FrictionAccount account =
      compute_friction_account({{1., 0.}, {0., 0.}, {10. / stiffness.tangential, 0.}, false, 0.5}, rule);
  // Two nodes that hand the traction 1 over in a step of 10 slips dissipate what one does that slides on.
  const std::array<double, 2> on{-1., 0.}, off{0., 0.}, way{10. / stiffness.tangential, 0.};
  const FrictionAccount left = compute_friction_account({on, off, way, false, 0.1}, rule),
                        come = compute_friction_account({off, on, way, true, 0.1}, rule);
  // A node that sticks at the start, with a third of what it could bear, slips once it bears the traction 1.
  const std::array<double, 2> little{-1. / 3., 0.};
  const FrictionAccount begins = compute_friction_account({little, on, way, true, 1., 1.}, rule);
  const double slipped = 10. - (1. - 1. / 3.); // in 1/k_t
  check("friction that begins within a step is the limit's, over the slip",
        std::abs(begins.dissipated(1., 1.) * stiffness.tangential / slipped - 1.), 1e-12);
  check("without what mean forces miss of it it is their work, less the change of springs",
        std::abs((begins.dissipated(1., 1.) - begins.missed(1.)) * stiffness.tangential +
                 0.5 * (1. - 1. / 9.) - 0.5 * (1. + 1. / 3.) * 10.),
        1e-12);
  // So does one that sticks against that, whose traction pushes it at first.
  const FrictionAccount pushed = compute_friction_account({{1. / 3., 0.}, on, way, true, 1., 1.}, rule);
  check("whichever way it was held",
        std::abs(pushed.dissipated(1., 1.) * stiffness.tangential / (10. - (1. + 1. / 3.)) - 1.), 1e-12);
  check("less what mean forces miss, and what they are given, it is their work, too",
        std::abs((pushed.dissipated(1., 1.) - pushed.missed(1.) + pushed.taken_beyond(1., 1.)) *
                     stiffness.tangential +
                 0.5 * (1. - 1. / 9.) - 0.5 * (1. - 1. / 3.) * 10.),
        1e-12);
  check("a load that is handed over dissipates without a pause",
        std::abs((left.handed_over().dissipated(1., 1.) + come.handed_over().dissipated(1., 1.)) *
                     stiffness.tangential / 10. -
                 1.),
        1e-12);
  check("by itself each node takes its part",
        (left.dissipated(1., 1.) + come.dissipated(1., 1.)) * stiffness.tangential < 2.);
  check("a node that springs off makes no energy", account.dissipation_n >= 0.);
  check("what it leaves out is what mean forces take besides",
        std::abs(account.beyond_n -
                 (-5. + 0.5 - account.dissipation_n * stiffness.tangential) / stiffness.tangential) *
            stiffness.tangential,
        1e-12);
}

} // namespace

BILLET_TEST(slave_traction) {
  check_parts_of_steps();
  check_balance<PlanedFacet>("planed");
  check_balance<BilinearFacet>("bilinear");
  check_rotation();
  check_rigid_rotation();
  check_friction();
  check_entry();
  check_slip_rate();
  check_account(0.5, "trapezoidal");
  check_account(0., "end value's");
}

} // namespace slave_traction_test
