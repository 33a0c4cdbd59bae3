// SPDX-License-Identifier: LGPL-2.1-or-later
// Usage: element_cost forces|tangents
//
// Evaluates every implicit element with every elasticity of metals, linear hardening, `n_elements` of them in
// a step in which all points yield, `n_rounds` times: for a profiler, which tells them by the names of their
// LawBlock. Prints the number of evaluations of each.
#include "../sample_formulations.h"
#include "../sample_laws.h"

#include <iostream>
#include <random>
#include <string>

using namespace billet;
using billet::testing::LawFormulation;
using billet::testing::MaterialLaw;

int main(int argc, char *argv[]) {
  const std::string what = argc == 2 ? argv[1] : "";
  if (what != "forces" && what != "tangents")
    return 2;
  constexpr std::size_t n_elements = 50, n_rounds = 4;
  std::mt19937 random(1);
  const auto uniform = [&](const double size) {
    return size * (2. * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 1.);
  };
  const MaterialLaw material{ElasticModuli::from_young_poisson(2e5, 0.3), LinearHardening{700., 300.}};
  for (const auto element : all_elements())
    for (const auto &elasticity : testing::metal_elasticities()) {
      LawFormulation formulation;
      formulation.element = element;
      formulation.elasticity = elasticity;
      const auto block = make_element_block(material, formulation);
      std::vector<ElementVectors> positions(n_elements), displacements(n_elements);
      for (std::size_t e = 0; e < n_elements; ++e)
        for (unsigned int k = 0; k < n_element_dofs; ++k) {
          positions[e][k] = (((k / 3) >> (k % 3)) & 1U) + uniform(0.1);
          displacements[e][k] = (k % 3 == 2 ? -0.2 : 0.1) * positions[e][k] + uniform(0.05);
        }
      std::size_t offender = 0;
      if (!block->initialize(positions, offender))
        return 1;
      ElementVectors force;
      ElementMatrix matrix;
      for (std::size_t round = 0; round < n_rounds; ++round)
        for (std::size_t e = 0; e < n_elements; ++e)
          if (!block->evaluate(e, displacements[e], force, what == "tangents" ? &matrix : nullptr))
            return 1;
    }
  std::cout << n_elements * n_rounds << std::endl;
  return 0;
}
