// SPDX-License-Identifier: LGPL-2.1-or-later
// A run that ends half-way, with its mesh and all that knows it, and another one that continues its files:
// the history, with columns of probes, is that of one run without interruption, bit by bit. A change of the
// mesh during a run is to take this way.
#include "implicit_run.h"

#include "billet/run/run.h"
#include "billet/run/simulation.h"

#include <fstream>
#include <sstream>

namespace handed_over_test {

using namespace billet;

namespace {

std::string read_history(const std::string &folder) {
  std::ifstream file(folder + "/history.csv");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void take_steps(Run &run, RunOutput &output, const unsigned int n_steps) {
  for (unsigned int taken = 0; taken < n_steps && !run.is_finished();)
    if (run.step(output)) {
      run.after_step(output);
      ++taken;
    }
}

struct Result {
  bool is_half_way, has_same_history;
};

/// Adds probes of each place to the first body, which has this point, and whose top has the boundary id 5.
void add_probes(parameters::Scene &parameters, const dealii::Point<3> &point) {
  const auto add = [&](const std::string &name, const Probe &probe) {
    parameters::Probe input;
    input.name = name;
    input.probe = probe;
    input.body.value = parameters.bodies[0].name;
    input.boundary_ids.value = {5};
    input.opposite_ids.value = {4};
    parameters.probes.push_back(input);
  };
  const std::vector<ProbeStatistic> all{ProbeStatistic::least, ProbeStatistic::largest, ProbeStatistic::mean,
                                        ProbeStatistic::sum};
  Probe fixed{ProbedPoints{{point, point + dealii::Point<3>(0., 0., 0.3)}, ProbedPoints::Place::space}};
  Probe carried{ProbedPoints{{point}, ProbedPoints::Place::nearest_node}}, nodes{ProbedFaces{}};
  for (const ProbeQuantity &quantity : probe_quantities()) {
    if (quantity.kind == ProbeQuantity::Kind::velocity && !parameters.scheme().has_inertia)
      continue;
    carried.quantities.push_back(quantity);
    if (quantity.is_nodal())
      nodes.quantities.push_back(quantity);
  }
  fixed.quantities = carried.quantities;
  fixed.statistics = carried.statistics = {ProbeStatistic::each};
  fixed.names_sites = true;
  nodes.statistics = all;
  Probe thickness{ProbedThickness{}};
  thickness.statistics = all;
  add("fixed", fixed);
  add("carried", carried);
  add("nodes", nodes);
  add("thickness", thickness);
}

/// Hands over after so many steps.
Result hand_over(const std::string &name, parameters::Scene parameters, const unsigned int n_steps) {
  parameters.output.folder.value = name + "_whole";
  run_simulation(parameters, MPI_COMM_WORLD);

  parameters.output.folder.value = name + "_in_parts";
  const Scene scene(parameters);
  Diagnostics diagnostics(testing::is_first_rank());
  std::unique_ptr<Run> run = make_run(scene, MPI_COMM_WORLD, nullptr);
  RunOutput output(scene, MPI_COMM_WORLD, diagnostics, nullptr);
  run->begin(output, nullptr);
  take_steps(*run, output, n_steps);
  const bool is_half_way = !run->is_finished();
  output.write_checkpoint(run->time(), [&run](StateWriter &writer) { run->save(writer); });
  run.reset();

  parameters::Scene resumed(parameters);
  resumed.restart.file.value = output.checkpoints().last();
  const std::unique_ptr<Resumption> resumption = Resumption::open(resumed, MPI_COMM_WORLD);
  run = make_run(scene, MPI_COMM_WORLD, resumption.get());
  run_to_end(std::move(run), scene, output, resumption.get());
  const std::string history = read_history(name + "_in_parts");
  return {is_half_way, !history.empty() && history == read_history(name + "_whole")};
}

} // namespace

BILLET_MPI_TEST(handed_over) {
  parameters::Scene press = testing::read_test_scene("restart_press.prm");
  press.time_stepping.end_time = 0.4;
  parameters::Scene impact = testing::read_test_scene("explicit_ranks.prm");
  impact.time_stepping.end_time = 0.02e-3;
  for (parameters::Scene *scene : {&press, &impact})
    scene->output.format = parameters::Output::Format::none;
  add_probes(press, {1.1, 0.95, 2.95});
  add_probes(impact, {1.3, 0.9, -0.1});

  std::ostringstream console; // of the runs
  std::streambuf *const standard_output = std::cout.rdbuf(console.rdbuf());
  const std::vector<std::pair<std::string, Result>> results = {{"press", hand_over("press", press, 3)},
                                                               {"impact", hand_over("impact", impact, 5)}};
  std::cout.rdbuf(standard_output);
  for (const auto &[name, result] : results) {
    if (!testing::is_first_rank())
      continue;
    testing::check(name + " is handed over before its end", result.is_half_way);
    testing::check(name + ": history", result.has_same_history);
  }
}

} // namespace handed_over_test
