// SPDX-License-Identifier: LGPL-2.1-or-later
// Supports of static scenes that begin and end, on a column: the force of one that ends fades, and the column
// relaxes along the way; one that begins holds its nodes where they are, or moves them from there. Runs that
// stop on the way go on alike.
#include "restart_run.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <fstream>

namespace timed_supports_test {

using namespace billet;
using billet::testing::SceneRun;

namespace {

template <class... Values> void check(const std::string &name, const Values... values) {
  if (testing::is_first_rank())
    testing::check(name, values...);
}

constexpr double young = 1e4, height = 2.;

/// A column of section 1 on z = 0 whose sides are free, without lateral strain.
parameters::Scene read(const std::string &supports, const std::string &loads, const std::string &tools = "") {
  const std::string file = "timed_supports.prm";
  if (testing::is_first_rank())
    std::ofstream(file)
        << "subsection Bodies\n  subsection body\n    set Symmetry planes = x = 0 ; y = 0 ; z = 0\n"
           "    subsection Mesh\n      set Primitive = subdivided_hyper_rectangle\n"
           "      set Arguments = 1, 1, 4 : 0, 0, 0 : 1, 1, 2 : true\n    end\n"
           "    subsection Material\n      set Law = elastic\n      set Young modulus = 1e4\n"
           "      set Poisson ratio = 0\n    end\n    subsection Supports\n"
        << supports << "    end\n    subsection Loads\n"
        << loads
        << "    end\n  end\nend\nsubsection Time stepping\n  set End time = 1\n"
           "  set Step control = fixed\n  set Initial step = 0.1\nend\n"
           "subsection Output\n  set Format = none\nend\n"
        << tools;
  MPI_Barrier(MPI_COMM_WORLD);
  parameters::Scene scene = parameters::Scene::read(file);
  MPI_Barrier(MPI_COMM_WORLD);
  scene.solver.force_tolerance = 1e-10;
  return scene;
}

std::string support(const std::string &name, const std::string &displacement, const std::string &times) {
  return "      subsection " + name +
         "\n        set Boundary ids = 5\n        set Components = z\n        set Displacement = 0 ; 0 ; " +
         displacement + "\n" + times + "      end\n";
}

const std::string growing_force = "      subsection push\n        set Type = force\n        set Boundary ids "
                                  "= 5\n        set Force = 0 ; 0 ; -20*t\n      end\n";

/// Least and largest displacement of the top along z. Collective.
std::array<double, 2> top(const SceneRun &run) {
  double low = 1e9, high = -1e9;
  const Vector &u = run.problem.state().displacements;
  for (const auto &element : run.discretization.elements(0))
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      if (element.cell->vertex(a)[2] > height - 1e-6) {
        low = std::min(low, u(element.dofs[3 * a + 2]));
        high = std::max(high, u(element.dofs[3 * a + 2]));
      }
  return {dealii::Utilities::MPI::min(low, MPI_COMM_WORLD),
          dealii::Utilities::MPI::max(high, MPI_COMM_WORLD)};
}

/// Distance of the top from a displacement.
double off(const SceneRun &run, const double expected) {
  const std::array<double, 2> now = top(run);
  return std::max(std::abs(now[0] - expected), std::abs(now[1] - expected));
}

/// Axial force at a displacement of the top: that of the Hencky law without lateral strain.
double force_at(const double displacement) {
  const double stretch = 1. + displacement / height;
  return young * std::log(stretch) / stretch;
}

double reaction(const SceneRun &run, const std::string &name) {
  const std::vector<NamedSupport> supports = named_supports(run.scene);
  for (std::size_t i = 0; i < supports.size(); ++i)
    if (supports[i].name == "support " + name)
      return run.problem.reactions().of_supports[i].force[2];
  return std::nan("");
}

bool is_at(const SceneRun &run, const double time) {
  return std::abs(run.problem.state().time - time) < 1e-6;
}

void check_release() {
  SceneRun run(
      read(support("press", "-0.01*t", "        set Until = 0.4\n        set Fade time = 0.4\n"), ""));
  double before = 0., held = 1., half = 1., after = 1., defect = 0., stored = 0.;
  double fades = 0., gone = 1.;
  run.finish([&](const NewtonReport &) {
    const double borne = std::abs(reaction(run, "press"));
    defect = std::max(defect, run.problem.reactions().balance.defect());
    stored = std::max(stored, run.problem.state().energies.elastic);
    if (is_at(run, 0.4)) {
      before = force_at(-0.004);
      held = std::abs(borne / std::abs(before) - 1.);
    } else if (run.problem.state().time > 0.4) {
      const double left = std::max(0., 1. - (run.problem.state().time - 0.4) / 0.4);
      fades = std::max(fades, std::abs(borne / std::abs(before) - left));
      gone = borne;
    }
    if (is_at(run, 0.6))
      half = std::abs(force_at(top(run)[0]) / (0.5 * before) - 1.);
  });
  after = off(run, 0.);
  check("release: the reaction at the end of the support", held, 1e-6);
  check("release: the reaction fades after it", fades, 1e-6);
  check("release: no reaction in the end", gone, 1e-12);
  check("release: half of the force at half of the fade time", half, 1e-6);
  check("release: relaxed in the end", after, 1e-9);
  check("release: forces balance", defect, 1e-9);
  const EnergyLedger &energies = run.problem.state().energies;
  check("release: energy of the column", std::abs(stored / (0.25 * young * 0.004 * 0.004) - 1.), 1e-2);
  check("release: the faded force takes the work that the support has done", std::abs(energies.external),
        1e-3 * stored);
}

void check_constraint() {
  SceneRun run(read(support("stop", "0", "        set From = 0.5\n"), growing_force));
  double held = 0., place = 0., before = 0.;
  run.finish([&](const NewtonReport &) {
    if (is_at(run, 0.5)) {
      place = top(run)[0];
      before = std::abs(reaction(run, "stop"));
    } else if (run.problem.state().time > 0.5)
      held = std::max(held, off(run, place));
  });
  check("late support: the column has given way before it", std::abs(force_at(place) / -10. - 1.), 1e-6);
  check("late support: no reaction before it", before, 1e-12);
  check("late support: it holds the nodes where they are", held, 1e-12);
  check("late support: it bears what the load has grown by", std::abs(reaction(run, "stop") / 10. - 1.),
        1e-6);
}

void check_motion() {
  SceneRun run(read(support("die", "-0.01*(t - 0.25)", "        set From = 0.5\n"), growing_force));
  double place = 0.;
  run.finish([&](const NewtonReport &) {
    if (is_at(run, 0.5))
      place = top(run)[0];
  });
  check("late motion: it counts from where the nodes are", off(run, place - 0.005), 1e-12);
}

/// One support takes over from the other at once.
void check_handover() {
  SceneRun run(read(support("first", "-0.01*t", "        set Until = 0.4\n        set Fade time = 0.2\n") +
                        support("second", "0", "        set From = 0.4\n"),
                    ""));
  double moved = 0.;
  run.finish([&](const NewtonReport &) {
    if (run.problem.state().time > 0.4)
      moved = std::max(moved, off(run, -0.004));
  });
  check("handover: the column stays", moved, 1e-12);
  check("handover: the second support bears the force once that of the first has faded",
        std::abs(reaction(run, "second") / force_at(-0.004) - 1.), 1e-6);
}

/// A support takes over from two tools that hold the column alone, and are removed at its beginning.
void check_takeover() {
  const auto tool = [](const std::string &name, const std::string &plane, const std::string &translation) {
    return "  subsection " + name + "\n    subsection Surfaces\n      subsection face\n" + plane +
           "      end\n    end\n    subsection Motion\n      set Translation = 0 ; 0 ; " + translation +
           "\n      set Removal time = 0.4\n    end\n  end\n";
  };
  parameters::Scene scene =
      read(support("hold", "0", "        set From = 0.4\n"), "",
           "subsection Tools\n" + tool("die", "", "0") +
               tool("punch", "        set Point = 0, 0, 2\n        set Normal = 0, 0, -1\n", "-0.01*t") +
               "end\nset Contact = all\n");
  scene.bodies[0].symmetry_planes.value.pop_back(); // z = 0
  SceneRun run(scene);
  run.finish([](const NewtonReport &) {});
  check("takeover: the run goes on to its end", std::abs(run.problem.state().time - 1.), 1e-9);
  check("takeover: the top stays", off(run, -0.004), 1e-5);
}

/// A support that leaves a static body free is refused.
void check_refusal() {
  parameters::Scene scene = read(support("press", "0", "        set Until = 0.4\n"), "");
  scene.bodies[0].symmetry_planes.value.pop_back(); // z = 0
  std::string message;
  try {
    const SceneRun run(scene);
  } catch (const InputError &error) {
    message = error.what();
  }
  check("refusal: names the time", message.find("no support from time 0.4 on") != std::string::npos);
}

} // namespace

BILLET_MPI_TEST(timed_supports) {
  check_release();
  check_constraint();
  if (testing::n_ranks() == 1) {
    check_motion();
    check_handover();
    check_takeover();
    check_refusal();
  }
  testing::test_going_on<testing::ImplicitSolutionRun>(
      "Timed supports",
      read(support("press", "-0.01*t", "        set Until = 0.4\n        set Fade time = 0.3\n") +
               support("late", "-0.002*t", "        set From = 0.55\n        set Until = 0.85\n"),
           growing_force),
      testing::n_ranks() == 1 ? std::vector<double>{0.3, 0.6, 0.9} : std::vector<double>{0.6},
      [](auto &run, const double time, testing::History &history) { run.run(time, history); });
}

} // namespace timed_supports_test
