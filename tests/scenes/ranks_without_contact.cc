// SPDX-License-Identifier: LGPL-2.1-or-later
// A scene whose contact is all at one end of a long bar, on three ranks: at least one of them has no face and
// no node of any contact pair, neither of slaves nor of what they touch. Forces, energies and iterations are
// those of one rank but for round-off, in statics and in explicit dynamics, with a tool and between bodies.
#include "explicit_run.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <set>
#include <utility>

namespace ranks_without_contact_test {

using namespace billet;
using billet::testing::check;

namespace {

/// Named columns over time, and how many ranks have no contact.
struct Course {
  std::vector<std::pair<std::string, std::vector<double>>> columns;
  unsigned int n_without_contact = 0, n_with_contact = 0;

  void add(const std::string &name, const double value) {
    for (auto &column : columns)
      if (column.first == name)
        return column.second.push_back(value);
    columns.push_back({name, {value}});
  }
  void add(const SolutionState &state) {
    for (unsigned int i = 0; i < 3; ++i) {
      const std::string axis(1, "xyz"[i]);
      add("force of the ball, " + axis, state.tool_loads[0].force[i]);
      add("moment of the ball, " + axis, state.tool_loads[0].moment[i]);
      add("force between the bodies, " + axis, state.body_pair_loads[0].force[i]);
    }
    add("area under the ball", state.tool_loads[0].area);
    add("area between the bodies", state.body_pair_loads[0].area);
    add("elastic energy", state.energies.elastic);
    add("plastic work", state.energies.plastic);
    add("energy in contact", state.energies.contact);
    add("friction", state.energies.friction);
    add("work", state.energies.external);
  }
};

/// Whether a boundary of a body is part of a contact pair.
bool is_of_pair(const Scene &scene, const std::size_t body, const unsigned int boundary_id) {
  const auto has = [&](const std::vector<unsigned int> &ids) {
    return std::find(ids.begin(), ids.end(), boundary_id) != ids.end();
  };
  for (const ContactPair &pair : scene.pairs())
    if (pair.body == body && has(pair.boundary_ids))
      return true;
  for (const BodyPair &pair : scene.body_pairs())
    for (const unsigned int side : {0U, 1U})
      if (pair.bodies[side] == body && has(pair.boundary_ids[side]))
        return true;
  return false;
}

/// Counts the ranks on which a node of a contact pair belongs to some brick, and those without. Collective.
void count_ranks(const Scene &scene, const Discretization &discretization, Course &course) {
  const MPI_Comm some = discretization.communicator();
  std::vector<DofIndex> nodes; // of faces in pairs, by their first dofs
  bool has_elements = false;
  for (std::size_t body = 0; body < discretization.n_bodies(); ++body)
    for (const auto &element : discretization.elements(body)) {
      has_elements = true;
      for (const unsigned int f : element.cell->face_indices())
        if (element.cell->face(f)->at_boundary() &&
            is_of_pair(scene, body, element.cell->face(f)->boundary_id()))
          for (unsigned int v = 0; v < 4; ++v)
            nodes.push_back(element.cell->face(f)->vertex_dof_index(v, 0));
    }
  std::set<DofIndex> all;
  for (const auto &of_rank : dealii::Utilities::MPI::all_gather(some, nodes))
    all.insert(of_rank.begin(), of_rank.end());
  bool has_contact = false;
  for (std::size_t body = 0; body < discretization.n_bodies(); ++body)
    for (const auto &element : discretization.elements(body))
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        has_contact = has_contact || all.count(element.dofs[std::size_t{3} * a]) > 0;
  course.n_with_contact = dealii::Utilities::MPI::sum(has_contact ? 1U : 0U, some);
  course.n_without_contact = dealii::Utilities::MPI::sum(has_elements && !has_contact ? 1U : 0U, some);
}

Course run_statics(const parameters::Scene &parameters, const unsigned int n) {
  Course course;
  testing::on_ranks(n, [&](MPI_Comm some) {
    const Scene scene(testing::for_comparison(parameters));
    const Discretization discretization(scene, some);
    ImplicitSolution problem(scene, discretization);
    count_ranks(scene, discretization, course);
    const double step = parameters.time_stepping.initial_step;
    for (double t = step; t < parameters.time_stepping.end_time + 0.5 * step; t += step) {
      const NewtonReport report = problem.step(t, t > step ? step : 0.);
      course.add(problem.state());
      course.add("iterations",
                 report.converged ? static_cast<double>(report.iterations.size()) : std::nan(""));
    }
  });
  return course;
}

Course run_explicitly(parameters::Scene parameters, const unsigned int n) {
  parameters.time_stepping.scheme = parameters::TimeStepping::Scheme::explicit_dynamics;
  Course course;
  testing::on_ranks(n, [&](MPI_Comm some) {
    testing::ExplicitRun run(parameters, some);
    count_ranks(run.scene, run.discretization, course);
    run.finish(0.1, [&] { course.add(run.state()); });
  });
  return course;
}

template <class Run> void compare(const std::string &name, const Run &run, const double tolerance) {
  const Course one = run(1), several = run(3);
  if (!testing::is_first_rank())
    return; // one rank compares
  std::cout << several.n_without_contact << " of three ranks are without contact" << std::endl;
  check(name + ": a rank or two are without contact",
        several.n_without_contact > 0 && several.n_with_contact > 0);
  check(name + ": one rank is not", one.n_without_contact == 0);
  for (const auto &[what, values] : one.columns) {
    std::vector<double> others;
    for (const auto &column : several.columns)
      if (column.first == what)
        others = column.second;
    double maximum = 0.;
    testing::WorstError error;
    for (std::size_t i = 0; i < values.size(); ++i) {
      maximum = std::max(maximum, std::abs(values[i]));
      error.add(std::abs(others.at(i) - values[i]));
    }
    check(name + ": " + what, maximum > 0. ? error.value() / maximum : 1., tolerance);
  }
}

} // namespace

BILLET_MPI_TEST(ranks_without_contact) {
  const parameters::Scene scene = testing::read_test_scene("ranks_without_contact.prm");
  compare(
      "statics", [&](const unsigned int n) { return run_statics(scene, n); }, 1e-9);
  compare(
      "explicit", [&](const unsigned int n) { return run_explicitly(scene, n); }, 1e-9);
}

} // namespace ranks_without_contact_test
