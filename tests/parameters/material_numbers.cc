// SPDX-License-Identifier: LGPL-2.1-or-later
// Numbers of materials: bodies share one if all parameters have the same values, written in any way.
#include "billet/parameters/material_texts.h"

#include "../testing.h"

#include <deal.II/base/mpi.h>

#include <fstream>

namespace material_numbers_test {

using namespace billet;
using billet::testing::check;

namespace {

std::string body(const std::string &name, const std::string &material) {
  return "  subsection " + name + "\n    subsection Material\n" + material +
         "      set Density = 1e-9\n    end\n  end\n";
}

parameters::Scene read(const std::string &bodies) {
  std::ofstream("scene.prm") << "subsection Bodies\n" << bodies << "end\n";
  return parameters::Scene::read("scene.prm");
}

} // namespace

BILLET_MPI_TEST(material_numbers) {
  const std::string rubber = "      set Elasticity = Mooney-Rivlin\n      set Poisson ratio = 0.4\n",
                    steel = "      set Young modulus = 200e3\n      set Yield stress = 300\n";
  const parameters::Scene scene =
      read(body("a", rubber + "      set C10 = 1\n      set C01 = 0\n") +
           body("b", rubber + "      set C10 = 0\n      set C01 = 1\n") + body("c", steel) +
           body("d", rubber + "      set C01 = 1.0\n      set C10 = 0e0\n") +
           body("e", steel + "      set Backstress moduli = 1000, 200\n      set Backstress rates = 1, 2\n") +
           body("f", steel + "      set Elasticity = Hencky\n") +
           body("g", steel + "      set Backstress rates = 1.0,2\n      set Backstress moduli = 1e3,200\n"));
  check("laws of equal moduli, and laws with and without backstress, differ",
        parameters::number_materials(scene) == std::vector<std::size_t>{0, 1, 2, 1, 3, 2, 3});
  const auto changed = parameters::compare_materials(parameters::find_material_texts(scene, "c"),
                                                     parameters::find_material_texts(scene, "e"));
  check("what differs is named", changed.size() == 2 && changed[0].key == "Backstress moduli" &&
                                     changed[0].before == "default" && changed[0].after == "1000, 200");
}

} // namespace material_numbers_test
