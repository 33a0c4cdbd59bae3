// SPDX-License-Identifier: LGPL-2.1-or-later
// The report of --check against closed forms, on one, two and three ranks.
#include "billet/run/body_report.h"
#include "billet/run/pair_report.h"
#include "billet/run/run_forecast.h"

#include "restart_run.h"

namespace scene_report_test {

using namespace billet;
using billet::testing::check;
using dealii::Tensor;

namespace {

constexpr double tolerance = 1e-12;

template <class Problem> SceneReport make_report(const Scene &scene, const MPI_Comm communicator) {
  const Discretization discretization(scene, communicator);
  SceneReport report;
  report.bodies = report_bodies(scene, discretization);
  report.pairs = report_pairs(scene, discretization, report.bodies);
  Problem problem(scene, discretization);
  if constexpr (std::is_same_v<Problem, ExplicitDynamics>)
    report.run = forecast_run(scene, problem, report);
  else
    report.run = forecast_run(scene, problem);
  return report;
}

double distance(const Tensor<1, 3> &a, const Tensor<1, 3> &b) { return (a - b).norm(); }

void check_block(const BodyReport &block) {
  check("block: elements", block.n_elements == 24);
  check("block: nodes", block.n_nodes == 60);
  check("block: one part", block.n_parts == 1);
  check("block: box", distance(block.low, {}) + distance(block.high, Tensor<1, 3>({4., 1., 1.5})), tolerance);
  check("block: volume", std::abs(block.volume - 6.), tolerance);
  check("block: mass", std::abs(block.mass - 12.), tolerance);
  check("block: least edge", std::abs(block.min_edge - 0.5), tolerance);
  check("block: mean edge", std::abs(block.mean_edge - 2. / 3.), tolerance);
  check("block: largest edge", std::abs(block.max_edge - 1.), tolerance);
  check("block: quality", std::abs(block.min_quality - 1.), tolerance);
  check("block: six boundaries", block.boundaries.size() == 6);
  const BoundaryReport &top = block.boundaries.at(5);
  check("top: id", top.id == 5 && top.names.empty());
  check("top: faces", top.n_faces == 8);
  check("top: area", std::abs(top.area - 4.), tolerance);
  check("top: centre", distance(top.centre, Tensor<1, 3>({2., 0.5, 1.5})), tolerance);
  check("top: normal", distance(top.normal, Tensor<1, 3>({0., 0., 1.})), tolerance);
  check("top: flat", std::abs(top.flatness - 1.), tolerance);
}

void check_sheared(const BodyReport &sheared) {
  check("sheared: volume", std::abs(sheared.volume - 1.), tolerance);
  check("sheared: quality", std::abs(sheared.min_quality - std::sqrt(0.5)), tolerance);
  check("sheared: largest edge", std::abs(sheared.max_edge - std::sqrt(0.5)), tolerance);
  const BoundaryReport &side = sheared.boundaries.at(1);
  check("side: area", std::abs(side.area - std::sqrt(2.)), tolerance);
  check("side: centre", distance(side.centre, Tensor<1, 3>({11.5, 0.5, 0.5})), tolerance);
  check("side: normal", distance(side.normal, std::sqrt(0.5) * Tensor<1, 3>({1., 0., -1.})), tolerance);
}

void check_cubes(const BodyReport &cubes) {
  check("cubes: two parts", cubes.n_parts == 2);
  check("cubes: mass", std::abs(cubes.mass - 6.), tolerance);
  const auto lids = std::find_if(cubes.boundaries.begin(), cubes.boundaries.end(), [](const auto &boundary) {
    return boundary.names == std::vector<std::string>{"lids"};
  });
  const auto rest = std::find_if(cubes.boundaries.begin(), cubes.boundaries.end(),
                                 [](const auto &boundary) { return boundary.names.empty(); });
  check("cubes: lids and the rest",
        cubes.boundaries.size() == 2 && lids != cubes.boundaries.end() && rest != cubes.boundaries.end());
  check("lids: area", std::abs(lids->area - 2.), tolerance);
  check("lids: centre", distance(lids->centre, Tensor<1, 3>({21.5, 0.5, 1.})), tolerance);
  check("rest: area", std::abs(rest->area - 10.), tolerance);
  check("rest: mean normal", distance(rest->normal, Tensor<1, 3>({0., 0., -1.})), tolerance);
  check("rest: bent", std::abs(rest->flatness - 0.2), tolerance);
}

/// `gap`: all facing nodes have it. `time` < 0: never.
void check_pair(const PairReport &pair, const std::size_t n_facing, const std::size_t n_nodes,
                const double gap, const double time, const std::size_t n_meeting) {
  const std::string &name = pair.name;
  check(name + ": nodes", pair.gap.n_facing == n_facing && pair.gap.n_nodes == n_nodes);
  check(name + ": least gap", std::abs(pair.gap.least - gap), tolerance);
  check(name + ": mean gap", std::abs(pair.gap.mean - gap), tolerance);
  check(name + ": meets", pair.meeting.has_value() == (time >= 0.));
  if (!pair.meeting)
    return;
  check(name + ": time", std::abs(pair.meeting->time - time), 1e-8);
  check(name + ": nodes that meet", pair.meeting->n_nodes == n_meeting);
}

void check_pairs(const std::vector<PairReport> &pairs) {
  check_pair(pairs.at(0), 15, 15, 0.5, 0.25, 15);
  check("on die: first node", distance(pairs[0].meeting->first, Tensor<1, 3>({0., 0., 1.5})), tolerance);
  check_pair(pairs.at(1), 15, 15, 0.5, std::sqrt(0.5), 15);
  check_pair(pairs.at(2), 15, 15, 1., -1., 0);
  check_pair(pairs.at(3), 15, 15, 1., std::atan(0.25), 3);
  check("on turning: x of the first node", std::abs(pairs[3].meeting->first[0] - 4.), tolerance);
  check("away: no node faces the die", pairs.at(4).gap.n_facing == 0 && pairs[4].gap.n_nodes == 15);
  check("away: never", !pairs[4].meeting);
  check_pair(pairs.at(5), 5, 19, 0.75, 0.25, 5);
  check("on turning: nothing else moves", !pairs[3].depends_on_forces);
  const PairReport &apart = pairs.at(6);
  check("apart: no node is in front", apart.gap.n_facing == 0 && apart.gap.n_nodes == 12);
  check("apart: never", !apart.meeting);
}

void check_run(const RunReport &run, const double safety_factor) {
  check("run: dofs", run.n_dofs == 3 * (60 + 27 + 16 + 12));
  check("run: stable step", run.stable_step.has_value());
  const StableStepReport &stable = *run.stable_step;
  check("stable step: body", stable.body == "flyer");
  check("stable step: element", distance(stable.element, Tensor<1, 3>({1.25, 0.5, 2.375})), tolerance);
  check("stable step: least edge", std::abs(stable.min_edge - 0.25), tolerance);
  const double crossing = 0.25 / std::sqrt(1000. / 2.); // of a wave through its thickness
  check("stable step: time of a wave",
        stable.of_elements > 0.5 * crossing && stable.of_elements < 1.01 * crossing);
  check("first steps: within the stable step",
        stable.step > 0.3 * stable.of_elements &&
            stable.step < 1.000001 * safety_factor * stable.of_elements);
  check("shortest steps: from where the turning die meets the block",
        std::abs(stable.shortest_from - std::atan(0.25)), 1e-8);
  check("shortest steps: by its penalty", stable.shortest < 0.9 * stable.step);
  const double n_steps = stable.shortest_from / stable.step + (1. - stable.shortest_from) / stable.shortest;
  check("run: number of steps, as the run prints", std::abs(run.n_steps - 1. / stable.step), 1.);
  check("run: number of steps if contact lasts", std::abs(run.max_steps - n_steps), 1.);
  check("run: memory", run.memory > 1e8 && run.memory < 1e9);
}

/// Numbers that no partition changes, but for round-off. The last node among equal ones may differ.
std::vector<double> numbers_of(const SceneReport &report) {
  std::vector<double> numbers;
  for (const BodyReport &body : report.bodies) {
    for (const std::size_t n : {body.n_elements, body.n_nodes, body.n_parts, body.boundaries.size()})
      numbers.push_back(static_cast<double>(n));
    for (const double value : {body.volume, body.mass, body.min_edge, body.mean_edge, body.max_edge,
                               body.min_quality, body.low.norm(), body.high.norm()})
      numbers.push_back(value);
    for (const BoundaryReport &boundary : body.boundaries)
      for (const double value : {static_cast<double>(boundary.n_faces), boundary.area, boundary.centre.norm(),
                                 boundary.normal[0], boundary.normal[1], boundary.normal[2]})
        numbers.push_back(value);
  }
  for (const PairReport &pair : report.pairs) {
    for (const double value : {static_cast<double>(pair.gap.n_nodes), static_cast<double>(pair.gap.n_facing),
                               pair.gap.least, pair.gap.mean, pair.meeting ? pair.meeting->time : -1.})
      numbers.push_back(value);
    if (pair.meeting) {
      numbers.push_back(static_cast<double>(pair.meeting->n_nodes));
      numbers.push_back(pair.meeting->first.norm());
    }
  }
  numbers.push_back(report.run->stable_step->of_elements);
  numbers.push_back(report.run->stable_step->element.norm());
  return numbers;
}

double difference(const std::vector<double> &a, const std::vector<double> &b) {
  if (a.size() != b.size())
    return std::numeric_limits<double>::infinity();
  testing::WorstError worst;
  for (std::size_t i = 0; i < a.size(); ++i)
    worst.add(std::abs(a[i] - b[i]) / std::max(1., std::abs(a[i])));
  return worst.value();
}

void check_lifted(const MPI_Comm communicator) {
  const Scene scene(testing::read_test_scene("scene_report_lifted.prm"));
  const SceneReport report = make_report<ImplicitSolution>(scene, communicator);
  check("lifted: no mass", report.bodies.at(0).mass == 0.);
  const PairReport &pair = report.pairs.at(0);
  check("lifted: gap", std::abs(pair.gap.least - 0.5), tolerance);
  check("lifted: time", std::abs((pair.meeting ? pair.meeting->time : -1.) - 0.25), 1e-8);
  check("lifted: the whole block moves", !pair.depends_on_forces);
  check("lifted: steps", report.run->n_steps == 4. && report.run->is_minimum);
  check("lifted: no stable step", !report.run->stable_step);
}

/// A ball and a plate as one wedge, with prisms on the axis.
void check_wedge(const MPI_Comm communicator) {
  const Scene scene(testing::read_test_scene("wedge_impact.prm"));
  const SceneReport report = make_report<ExplicitDynamics>(scene, communicator);
  const BodyReport &ball = report.bodies.at(0), &plate = report.bodies.at(1);
  const double angle = M_PI / 6., factor = 2. * M_PI / std::sin(angle), sphere = 4000. / 3. * M_PI;
  check("wedge: full circle", std::abs(plate.circle_factor * plate.volume / (8000. * M_PI) - 1.), tolerance);
  check("wedge: volume of the smooth ball", std::abs(factor * ball.smooth_volume.value_or(0.) / sphere - 1.),
        1e-4);
  check("wedge: the polyhedron is smaller", ball.volume < 0.98 * ball.smooth_volume.value_or(0.));
  check("wedge: the plate has no curves", !plate.smooth_volume);
  check("wedge: least edge of prisms", std::abs(plate.min_edge - 4. * std::sin(0.5 * angle)), tolerance);
  check("wedge: quality of prisms", std::abs(plate.min_quality - std::cos(0.5 * angle)), tolerance);
}

} // namespace

BILLET_MPI_TEST(scene_report) {
  if (!testing::is_first_rank())
    std::cout.setstate(std::ios::failbit); // one rank speaks
  const Scene scene(testing::read_test_scene("scene_report.prm"));
  const SceneReport report = make_report<ExplicitDynamics>(scene, MPI_COMM_WORLD);
  check_block(report.bodies.at(0));
  check_sheared(report.bodies.at(1));
  check_cubes(report.bodies.at(2));
  check_pairs(report.pairs);
  check_run(*report.run, scene.parameters().explicit_dynamics.safety_factor);
  check_lifted(MPI_COMM_WORLD);
  check_wedge(MPI_COMM_WORLD);
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  for (unsigned int n = 1; n <= n_ranks; ++n)
    testing::on_ranks(n, [&](const MPI_Comm some) {
      const SceneReport other = make_report<ExplicitDynamics>(scene, some);
      check("alike on " + std::to_string(n), difference(numbers_of(report), numbers_of(other)), tolerance);
    });
}

} // namespace scene_report_test
