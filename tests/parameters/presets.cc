// SPDX-License-Identifier: LGPL-2.1-or-later
// Presets that depend on the laws of bodies: the same flow curve gets the same ones, whatever names its
// parameters have; the default profile shortens static steps where stresses depend on the path; and float is
// for laws and elements that the kernels have.
#include "billet/parameters/scene.h"

#include "../testing.h"

#include <deal.II/base/mpi.h>

#include <fstream>

namespace presets_test {

using namespace billet;
using billet::testing::check;

namespace {

/// Returns the presets of a scene with this material, by its name, in their order.
std::vector<std::string> presets_of(const std::string &top, const std::string &material,
                                    const std::string &scheme = "explicit") {
  std::ofstream("scene.prm") << "subsection Bodies\n"
                                "  subsection cube\n"
                                "    subsection Material\n"
                                "      set Poisson ratio = 0.3\n"
                                "      set Density = 7.8e-9\n"
                             << material
                             << "    end\n"
                                "  end\n"
                                "end\n"
                                "subsection Time stepping\n"
                                "  set Scheme = "
                             << scheme << "\n  set End time = 1e-4\nend\n"
                             << top;
  std::vector<std::string> presets;
  for (const parameters::Preset &preset : parameters::Scene::read("scene.prm").presets)
    presets.push_back(to_string(preset));
  return presets;
}

bool has(const std::vector<std::string> &presets, const std::string &preset) {
  return std::find(presets.begin(), presets.end(), preset) != presets.end();
}

const std::string young = "set Young modulus = 200e3\n", soft = "set Young modulus = 2e3\n",
                  line = "set Yield stress = 300\nset Hardening modulus = 500\n",
                  table = "set Hardening = table\nset Table = 0 : 300, 1 : 800\n",
                  power = "set Hardening = power law\nset Strength coefficient = 700\nset Prestrain = 0.01\n"
                          "set Hardening exponent = 0.2\n",
                  target = "set Target error = 1 percent\n", fast = "set Profile = fast\n",
                  of_rates = "Bodies / cube / Material / Elasticity = hypoelastic",
                  in_float = "Explicit dynamics / Number type = float";

void check_flow_curves() {
  const auto by_line = presets_of(target, young + line);
  check("target: hypoelastic where elastic strains are small", has(by_line, of_rates));
  check("target: the same flow curve by a table", presets_of(target, young + table) == by_line);
  check("target: a law without 'Yield stress'", has(presets_of(target, young + power), of_rates));
  check("target: not where they are large",
        !has(presets_of(target, soft + line), of_rates) && !has(presets_of(target, soft + table), of_rates));
  check("target: not in elastic bodies", !has(presets_of(target, young), of_rates));
  check("steps: by plasticity", presets_of(target, young + line, "quasi-static") ==
                                    presets_of(target, young + table, "quasi-static"));
  check("steps: not those of elastic bodies",
        presets_of(target, young + line, "quasi-static") != presets_of(target, young, "quasi-static"));
}

void check_default_steps() {
  const std::string step = "Time stepping / Maximum step = 5e-06",
                    set = "subsection Time stepping\n  set Maximum step = 2e-5\nend\n";
  check("balanced: shorter steps where stresses depend on the path",
        presets_of("", young + line, "quasi-static") == std::vector<std::string>{step});
  check("balanced: not in elastic bodies", presets_of("", young, "quasi-static").empty());
  check("balanced: not where the scene sets them", presets_of(set, young + line, "quasi-static").empty());
  check("balanced: not in dynamics",
        presets_of("", young + line, "implicit dynamics").empty() && presets_of("", young + line).empty());
}

void check_number_types() {
  for (const std::string &law : {line, table, power})
    check("fast: float where kernels have the law", has(presets_of(fast, young + law), in_float));
  // A law that only the scene, not the profile, can refuse.
  bool is_refused = false;
  try {
    presets_of(fast, "set Young modulus = -1\n" + line);
  } catch (const InputError &error) {
    is_refused = std::string(error.what()).find("'Young modulus'") != std::string::npos;
  }
  check("fast: a refused value is named as without a profile", is_refused);
}

} // namespace

BILLET_MPI_TEST(presets) {
  check_flow_curves();
  check_default_steps();
  check_number_types();
}

} // namespace presets_test
