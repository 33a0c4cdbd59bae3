// SPDX-License-Identifier: LGPL-2.1-or-later
// A probe that the library does not know, on a circle, registered here and named by a scene: the
// displacements of a pulled cube on a circle about its axis.

#include "pulled_cube.h"

#include "billet/output/probe_reader.h"

#include <algorithm>

namespace added_probe_test {

using namespace billet;
using billet::testing::check;

namespace {

ProbeType circle_type() {
  return {"circle",
          "quantities at points at equal distances on a circle about the z axis",
          {probed_body(),
           probed_point(),
           {"Radius", "1", TypeParameter::Kind::number, "> 0. Of the circle about 'Point'. [length]"},
           probed_quantities(),
           probed_statistics()},
          [](const TypeInput &input) {
            constexpr unsigned int n = 12;
            const double radius = input.positive("Radius");
            ProbedPoints points{{}, ProbedPoints::Place::material};
            for (unsigned int i = 0; i < n; ++i) {
              const double angle = 2. * dealii::numbers::PI * i / n;
              points.points.emplace_back(input.vector("Point") +
                                         radius *
                                             dealii::Tensor<1, 3>({std::cos(angle), std::sin(angle), 0.}));
            }
            Probe probe{std::move(points)};
            probe.quantities = read_quantities(input);
            probe.statistics = read_statistics(input, true);
            probe.names_sites = true;
            return probe;
          }};
}

} // namespace

BILLET_MPI_TEST(added_probe) {
  probe_types().add(circle_type());
  bool is_refused = false;
  try {
    probe_types().add(circle_type());
  } catch (const std::logic_error &) {
    is_refused = true;
  }
  check("a second one of the same name is refused", is_refused);

  constexpr double stretch = 1.05;
  testing::read_pulled_cube("mean dilatation",
                            "set Law = elastic\nset Young modulus = 200e3\nset Poisson ratio = 0.3", stretch,
                            1., false, 1);
  std::ofstream("probed.prm") << "include static.prm\n"
                                 "subsection Probes\n"
                                 "  subsection ring\n"
                                 "    set Type   = circle\n"
                                 "    set Point  = 0.5, 0.5, 0.4\n"
                                 "    set Radius = 0.4\n"
                                 "    set Values = each, largest, mean\n"
                                 "  end\n"
                                 "end\n";
  testing::SceneRun run(parameters::Scene::read("probed.prm"));
  run.finish();
  const ProbeReader reader(run.scene, run.discretization);
  const std::vector<double> values = reader.read(run.problem);
  const std::vector<std::string> columns = probe_columns(run.scene);
  const auto value = [&](const std::string &name) {
    return values.at(
        static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name) - columns.begin()));
  };
  check("columns", columns.size() == 14 * 4 && values.size() == columns.size());
  const double lateral = std::pow(stretch, -testing::cube_poisson) - 1.;
  check("first point, across", std::abs(value("ring.1.displacement_x") - 0.9 * lateral), 1e-7);
  check("fourth point, across", std::abs(value("ring.4.displacement_y") - 0.9 * lateral), 1e-7);
  check("mean along the axis", std::abs(value("ring.mean_displacement_z") - 0.4 * (stretch - 1.)), 1e-7);
  check("largest across", std::abs(value("ring.largest_displacement_x") - 0.1 * lateral), 1e-7);
}

} // namespace added_probe_test
