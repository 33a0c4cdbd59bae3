// SPDX-License-Identifier: LGPL-2.1-or-later
// Differences of histories in closed form, what they extrapolate to, and levels of meshes.
#include "billet/output/history_comparison.h"

#include "billet/run/body_levels.h"
#include "billet/run/mesh_levels.h"

#include "../testing.h"

#include <fstream>

namespace history_comparison_test {

using namespace billet;
using billet::testing::check;

namespace {

/// A box of these numbers of elements, with these refinements. Nothing varies along y, unless a side is free.
parameters::Scene read_box(const std::string &counts, const unsigned int refinements,
                           const std::string &planes = "x = 0 ; y = 0 ; y = 1 ; z = 0") {
  const std::string file = "levels.prm";
  std::ofstream(file) << "subsection Bodies\n  subsection box\n    subsection Mesh\n"
                         "      set Primitive = subdivided_hyper_rectangle\n      set Arguments = "
                      << counts << " : 0, 0, 0 : 1, 1, 1\n      set Refinements = " << refinements
                      << "\n    end\n    subsection Material\n      set Young modulus = 1\n    end\n"
                         "    set Symmetry planes = "
                      << planes
                      << "\n  end\nend\n"
                         "subsection Time stepping\n  set End time = 1\nend\n";
  return parameters::Scene::read(file);
}

unsigned int levels_of(const std::string &counts, const unsigned int refinements) {
  return count_coarser_levels(read_box(counts, refinements), 2);
}

} // namespace

BILLET_TEST(history_comparison) {
  // Straight lines, with rows that do not match.
  std::vector<std::vector<double>> coarse(2), fine(2);
  for (const double t : {0., 0.5, 1.}) {
    coarse[0].push_back(t);
    coarse[1].push_back(2. * t);
  }
  for (const double t : {0., 0.25, 0.5, 0.75, 1.}) {
    fine[0].push_back(t);
    fine[1].push_back(4. * t);
  }
  const HistoryDifference half = compare_histories(HistoryTable({"time", "die.force_z"}, coarse),
                                                   HistoryTable({"time", "die.force_z"}, fine), false, 1.);
  check("forces of half the size", std::abs(half.part - 0.5), 1e-14);
  check("they are forces", half.of_what == "forces");
  const auto compare_rows = [](const std::vector<std::string> &names, const std::vector<double> &a,
                               const std::vector<double> &b) {
    std::vector<std::vector<double>> of_a, of_b;
    for (std::size_t i = 0; i < names.size(); ++i) {
      of_a.push_back({a[i]});
      of_b.push_back({b[i]});
    }
    return compare_histories(HistoryTable(names, of_a), HistoryTable(names, of_b), false, 1.);
  };
  check("a single step counts from zero on",
        std::abs(compare_rows({"time", "die.force_z"}, {1., 3.}, {1., 4.}).part - 0.25), 1e-14);
  const HistoryDifference beside =
      compare_rows({"time", "die.force_z", "bar.support foot.force_z"}, {1., 3., 1000.}, {1., 4., 1000.});
  check("large reactions do not dilute the force of a tool",
        std::abs(beside.part - 0.25) < 1e-14 && beside.of_what == "forces");
  const HistoryDifference loaded = compare_rows(
      {"time", "bar.load gas.force_z", "bar.symmetry plane x = 0.force_x", "bar.support a.force_y"},
      {1., 1000., 2., 0.}, {1., 1000., 1., 1.});
  check("reactions do count, and given forces do not",
        std::abs(loaded.part - 1.) < 1e-14 && loaded.of_what == "reactions");
  const HistoryDifference twisted = compare_rows({"time", "bar.support a.force_z", "bar.support a.moment_z"},
                                                 {1., 1e-9, 3.}, {1., 2e-9, 4.});
  check("moments stand for forces that are round-off",
        std::abs(twisted.part - 0.25) < 1e-14 && twisted.of_what == "moments of supports");
  const HistoryDifference pushed =
      compare_rows({"time", "die.force_z", "die.moment_y"}, {1., 1., 1000.}, {1., 2., 1000.});
  check("but not for others", std::abs(pushed.part - 0.5) < 1e-14 && pushed.of_what == "forces");
  coarse[1] = {0., 1., 0.};
  fine[1] = {0., 1., 2., 1., 0.}; // twice the hat, of areas 0.5 and 1
  const HistoryDifference hat = compare_histories(HistoryTable({"time", "kinetic_energy"}, coarse),
                                                  HistoryTable({"time", "kinetic_energy"}, fine), true, 1.);
  check("a hat of half the height", std::abs(hat.part - 0.5), 1e-14);
  check("forces of impacts do not count",
        compare_histories(HistoryTable({"time", "die.force_z"}, coarse),
                          HistoryTable({"time", "die.force_z"}, fine), true, 1.)
            .of_what.empty());

  // F_i = F (1 + c h^p): differences c h^p (2^p − 1), error c h^p.
  for (const double order : {1., 1.5, 2.}) {
    const double error = 0.01, last = error * (std::exp2(order) - 1.);
    const MeshLevelError found = extrapolate({last * std::exp2(order), last});
    check("order " + std::to_string(order),
          std::abs(found.order - order) + std::abs(found.error / (1.25 * error) - 1.), 1e-12);
  }
  check("no order above that of bricks", std::abs(extrapolate({0.9, 0.03}).error - 0.0125), 1e-12);
  check("one difference stands for the error", extrapolate({0.02}).error == 0.02);
  check("or counts as of the order expected", std::abs(extrapolate({0.03}, 2.).error - 0.01), 1e-15);
  check("differences that grow have no order",
        !extrapolate({0.02, 0.03}).is_known && extrapolate({0.02, 0.03}).error == 0.03);
  check("nor have those that hardly fall", !extrapolate({0.0141, 0.01}).is_known &&
                                               extrapolate({0.0141, 0.01}).error == 0.0141 &&
                                               extrapolate({0.0142, 0.01}).is_known);

  check("refinements make levels", levels_of("1, 1, 1", 1) == 1 && levels_of("1, 1, 1", 3) == 2);
  check("numbers of elements do", levels_of("8, 1, 8", 0) == 2 && levels_of("4, 1, 2", 0) == 1);
  check("odd ones do not", levels_of("9, 1, 8", 0) == 0);
  const parameters::Scene box = read_box("8, 1, 4", 0);
  check("coarser", at_mesh_levels(box, {-1}).bodies[0].mesh.arguments.rfind("4, 1, 2 :", 0) == 0);
  const parameters::Scene finer = at_mesh_levels(box, {2});
  check("finer, but where nothing varies",
        finer.bodies[0].mesh.refinements == 0 && finer.bodies[0].mesh.arguments.rfind("32, 1, 16 :", 0) == 0);
  const parameters::Scene wall = read_box("8, 1, 8", 0, "x = 0 ; y = 0");
  check("a wall of one element has no coarser mesh", count_coarser_levels(wall, 2) == 0);
  check("and finer ones divide it", at_mesh_levels(wall, {1}).bodies[0].mesh.refinements == 1);
}

} // namespace history_comparison_test
