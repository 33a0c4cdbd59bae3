// SPDX-License-Identifier: LGPL-2.1-or-later
// Viscous forces on bodies that contact is yet to support, (Q3): derivatives of their potential, the closed
// form of a body that moves steadily, works, fading, and what a checkpoint keeps.
#include "billet/solve/contact_stabilisation.h"
#include "billet/diagnostic_kinds.h"

#include "../scenes/scene_run.h"

#include <numeric>

namespace contact_stabilisation_test {

using namespace billet;
using billet::testing::check;
using Values = std::vector<double>;

namespace {

dealii::ArrayView<const double> view(const Values &values) { return {values.data(), values.size()}; }
dealii::ArrayView<double> writable(Values &values) { return {values.data(), values.size()}; }

/// Three nodes of two bodies, in other places than their numbers, and one of a third that is not stabilised.
ContactStabilisation three_nodes() {
  ContactStabilisation stabilisation(MPI_COMM_WORLD, {1., 3., 0.}, {{0, 6, 2.}, {0, 0, 0.5}, {1, 3, 4.}});
  stabilisation.hold(0);
  stabilisation.hold(1);
  return stabilisation;
}

Values residual(const ContactStabilisation &stabilisation, const Values &u, const Values &u_n) {
  Values result(u.size(), 0.);
  stabilisation.add_forces(view(u), view(u_n), writable(result));
  return result;
}

/// The potential of −f in the step, Σ ½ k |u − u_n|².
double potential(const ContactStabilisation &stabilisation, const Values &u, const Values &u_n) {
  double sum = 0.;
  for (const auto &node : stabilisation.nodes())
    for (std::size_t i = node.first; i < node.first + 3; ++i)
      sum += 0.5 * stabilisation.stiffness(node) * (u[i] - u_n[i]) * (u[i] - u_n[i]);
  return sum;
}

/// Checks the messages about a block without supports that has moved, where all work is so many times that of
/// the stabilising forces, and where forces are so many times these forces.
RigidBodies::LoadFilter springs_after(const double t) {
  return [t](const LoadTimes &times) { return times.acts_after(t); };
}

void check_messages() {
  auto parameters = parameters::Scene::read(std::string(SOURCE_DIR) + "/confined_element.prm");
  parameters.bodies[0].supports.clear();
  parameters.bodies[0].is_stabilised.value = true;
  const Scene scene(parameters);
  const Discretization discretization(scene, MPI_COMM_WORLD);
  BodyStabilisation stabilisation(scene, discretization);
  stabilisation.prepare(RigidBodies(scene, discretization, holding_after(0.), springs_after(0.)));
  stabilisation.start_step(1.);
  StepState step(discretization);
  step.trial.displacements = 1.;
  RigidBodySupport::Result support;
  support.is_free = {true};
  stabilisation.commit(step, support, 0.);
  const auto tells = [&](const DiagnosticKind &kind, const double work, const double forces,
                         const double own_forces = 1.) {
    const ContactStabilisation &own = *stabilisation.get();
    for (const Diagnostic &message : stabilisation.finish({1.,
                                                           work * own.work_of_motion(0),
                                                           forces * own.last_force(0),
                                                           {own_forces * own.last_force(0)},
                                                           support}))
      if (&message.kind() == &kind)
        return true;
    return false;
  };
  check("a warning is printed if forces do much of all work",
        tells(diagnostic::stabilisation_too_strong, 10., 1.) &&
            !tells(diagnostic::stabilisation_too_strong, 1e5, 1.));
  check("and those that bear much at the end",
        tells(diagnostic::stabilised_loads, 1., 10.) && !tells(diagnostic::stabilised_loads, 1., 1e5));
  check("a note, if that is much of the forces on the body alone",
        tells(diagnostic::stabilised_at_end, 1., 1e5, 10.) &&
            !tells(diagnostic::stabilised_at_end, 1., 10., 10.));
  check("none, if it is less", !tells(diagnostic::stabilised_at_end, 1., 1e5, 1e5));
  // In equilibrium all that moves the body is a load, as large as the viscous forces.
  const double size =
      2. * RigidBodies(scene, discretization, holding_after(0.), springs_after(0.)).frames[0].size;
  const auto tells_of_drift = [&](const double distance) {
    support.unresisted = {{dealii::Tensor<1, 3>()}, {distance * dealii::Tensor<1, 3>({1., 0., 0.})}};
    stabilisation.commit(step, support, 0.);
    return tells(diagnostic::stabilised_drift, 1., 1.);
  };
  check("a warning is printed if loads move it by much of its size",
        tells_of_drift(0.2 * size) && !tells_of_drift(1e-4 * size));
}

} // namespace

BILLET_MPI_TEST(contact_stabilisation) {
  billet::testing::Random random;
  Values u, u_n;
  for (unsigned int i = 0; i < 12; ++i) {
    u.push_back(random(-1., 1.));
    u_n.push_back(random(-1., 1.));
  }
  {
    ContactStabilisation stabilisation = three_nodes();
    stabilisation.start_step(0.25);
    stabilisation.commit(view(u_n), view(u_n), {true, false, false}); // φ = 0.1 and 1
    const Values r = residual(stabilisation, u, u_n);
    billet::testing::WorstError first, second;
    for (std::size_t i = 0; i < u.size(); ++i) {
      const auto moved = [&](const double h) {
        Values there = u;
        there[i] += h;
        return there;
      };
      first.add(std::abs(r[i] -
                         billet::testing::central_difference(
                             [&](const double h) { return potential(stabilisation, moved(h), u_n); }, 1e-2)));
      double slope = 0.;
      for (const auto &node : stabilisation.nodes())
        if (i >= node.first && i < node.first + 3)
          slope += stabilisation.stiffness(node);
      second.add(std::abs(
          slope - billet::testing::central_difference(
                      [&](const double h) { return residual(stabilisation, moved(h), u_n)[i]; }, 1e-2)));
    }
    check("forces are the gradient of the potential", first.value(), 1e-11);
    check("stiffnesses are that of the forces", second.value(), 1e-11);
    check("a body that is not stabilised feels none", r[9] == 0. && r[10] == 0. && r[11] == 0.);
  }
  {
    // A body of volume 24 in four nodes moves by d = (0.3, 0, 0) per step of 0.2, T = 2, L = 3, E = 500.
    std::vector<ContactStabilisation::Node> nodes;
    for (std::size_t n = 0; n < 4; ++n)
      nodes.push_back({0, 3 * n, ContactStabilisation::damping(500., 3., 2., 6.)});
    ContactStabilisation stabilisation(MPI_COMM_WORLD, {1.5}, nodes);
    stabilisation.hold(0);
    const double force = ContactStabilisation::strength * 500. * 2. / 9. * 24. * 0.3 / 0.2;
    check("the norm of the forces at a given speed", // of four equal ones
          std::abs(stabilisation.force_scale() - 0.5 * force), 1e-12 * force);
    double work = 0.;
    Values here(12, 0.);
    for (unsigned int step = 0; step < 3; ++step) {
      Values next = here;
      for (std::size_t n = 0; n < 4; ++n)
        next[3 * n] += 0.3;
      stabilisation.start_step(0.2);
      const Values r = residual(stabilisation, next, here);
      check("force of steady motion", std::abs(r[0] + r[3] + r[6] + r[9] - force), 1e-12 * force);
      work += stabilisation.commit(view(next), view(here), {false});
      here = next;
    }
    check("work: half of the first step's, all of the others'", std::abs(work - 2.5 * force * 0.3),
          1e-12 * work);
    check("and it is the body's", std::abs(work - stabilisation.work(0)), 1e-12 * work);
    stabilisation.start_step(0.);
    const Values last = residual(stabilisation, here, here);
    check("at the start of a step: the last forces", std::abs(last[0] + last[3] + last[6] + last[9] - force),
          1e-12 * force);
    check("without a stiffness", stabilisation.stiffness(nodes[0]) == 0.);
  }
  {
    ContactStabilisation stabilisation = three_nodes();
    stabilisation.start_step(1.);
    const auto accept = [&](const bool first, const bool second) {
      stabilisation.commit(view(u_n), view(u_n), {first, second, false});
    };
    check("a body that is not to be stabilised never is", !stabilisation.acts_on(2));
    accept(false, true);
    check("it does not fade without support", stabilisation.factor(0) == 1.);
    const double faded = stabilisation.factor(1);
    check("with support it does", faded > 0. && faded < 0.5);
    accept(false, false);
    check("and does not come back", stabilisation.factor(1) == faded);
    unsigned int n = 1;
    for (; stabilisation.acts_on(1) && n < 100; ++n)
      accept(false, true);
    check("after some steps with support it is gone", n < 20 && stabilisation.factor(1) == 0.);
    check("of that body only", stabilisation.acts() && stabilisation.acts_on(0));
  }
  {
    // A part of E over L² per unit of volume and time, (Q3).
    check("the strength of the forces",
          std::abs(ContactStabilisation::damping(500., 3., 2., 6.) /
                       (ContactStabilisation::strength * 500. * 2. * 6. / 9.) -
                   1.),
          1e-14);
    const auto stays = [&](const double factor) {
      ContactStabilisation stabilisation = three_nodes();
      stabilisation.load({factor, 0., 0., 1., 0., 0., 0., 0., 0.});
      stabilisation.start_step(1.);
      stabilisation.commit(view(u_n), view(u_n), {true, true, false});
      return stabilisation.acts_on(0);
    };
    check("they fade to little, then they are gone", stays(0.5) && !stays(1e-5));
  }
  {
    ContactStabilisation stabilisation = three_nodes(), resumed = three_nodes();
    stabilisation.start_step(0.5);
    stabilisation.commit(view(u), view(u_n), {false, true, false});
    resumed.load(stabilisation.save());
    resumed.set_last_forces(stabilisation.last_forces());
    for (auto *each : {&stabilisation, &resumed}) {
      each->start_step(0.125);
      each->commit(view(u_n), view(u), {true, true, false});
    }
    check("a checkpoint keeps all", stabilisation.save() == resumed.save() &&
                                        stabilisation.last_forces() == resumed.last_forces() &&
                                        resumed.work(0) != 0. && resumed.factor(1) < 0.1);
  }
  {
    ContactStabilisation stabilisation = three_nodes();
    stabilisation.start_step(1.);
    const double all = stabilisation.commit(view(u), view(u_n), {false, false, false});
    const double first = stabilisation.work(0), second = stabilisation.work(1);
    check("the work of motion is all", stabilisation.work_of_motion(0) == first);
    stabilisation.start_step(1.);
    const double more = stabilisation.commit(view(u), view(u_n), {false, false, false}, all);
    check("less what driven tools do in a step",
          std::abs(stabilisation.work_of_motion(0) + stabilisation.work_of_motion(1) - more), 1e-12 * more);
    stabilisation.start_step(1.);
    stabilisation.commit(view(u), view(u_n), {false, false, false}, 1e3 * more);
    check("which may be all of it",
          std::abs(stabilisation.work_of_motion(0) + stabilisation.work_of_motion(1) - more), 1e-12 * more);
    check("the whole work goes on", stabilisation.work(0) > first && stabilisation.work(1) > second);
    double square = 0.;
    for (const double force : stabilisation.last_forces())
      square += force * force;
    check("norms of the last forces",
          std::abs(std::hypot(stabilisation.last_force(0), stabilisation.last_force(1)) - std::sqrt(square)),
          1e-12 * std::sqrt(square));
  }
  {
    ContactStabilisation stabilisation = three_nodes();
    stabilisation.start_step(0.5);
    Values rest = residual(stabilisation, u, u_n);
    rest[6] -= 3.; // a load of 3 along x on the first body
    const auto motions = stabilisation.motions(view(u), view(u_n), view(rest));
    dealii::Tensor<1, 3> mean;
    for (std::size_t i = 0; i < 3; ++i)
      mean[i] = (2. * (u[6 + i] - u_n[6 + i]) + 0.5 * (u[i] - u_n[i])) / 2.5;
    const dealii::Tensor<1, 3> x({1., 0., 0.}), none;
    check("the mean displacement in the step", (motions[0].mean - mean).norm(), 1e-14);
    check("the loads in it",
          (motions[0].load - 3. * x).norm() + motions[1].load.norm() + motions[2].load.norm(), 1e-14);
    check("and the stiffness", std::abs(motions[0].stiffness - 5.), 1e-14);
    check("a body that is not stabilised has no motion", motions[2].mean.norm() == 0.);
    const auto drift = [&](const dealii::Tensor<1, 3> &unresisted) {
      stabilisation.add_drifts({0.25 * x, none, none}, motions, {unresisted, none, none});
      return stabilisation.drifts()[0];
    };
    check("loads that do half of the work make a drift", (drift(1.1 * x) - 1.35 * x).norm(), 1e-14);
    check("else something else moves the body", drift(1.3 * x) == 0.25 * x && drift(-x) == 0.25 * x);
  }
  check_messages();
}

} // namespace contact_stabilisation_test
