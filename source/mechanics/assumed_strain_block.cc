// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/assumed_strain_element.h"
#include "billet/mechanics/element_comparison.h"
#include "billet/mechanics/law_block.h"

#include <stdexcept>

namespace billet {

ElementType assumed_strain_type();
// Each is in a file of its own, to reduce compile time.
std::unique_ptr<ElementBlock> make_assumed_strain_block_3(const std::shared_ptr<const PointLaw> &law,
                                                          const ElementFormulation &formulation);
std::unique_ptr<ElementBlock> make_assumed_strain_block_5(const std::shared_ptr<const PointLaw> &law,
                                                          const ElementFormulation &formulation);
std::unique_ptr<ElementBlock> make_assumed_strain_block_7(const std::shared_ptr<const PointLaw> &law,
                                                          const ElementFormulation &formulation);

namespace {

std::unique_ptr<ElementBlock> make_block(const std::shared_ptr<const PointLaw> &law,
                                         const ElementFormulation &formulation) {
  switch (formulation.points_through) {
  case 2:
    return make_law_block<AssumedStrainElement<>>(law, formulation);
  case 3:
    return make_assumed_strain_block_3(law, formulation);
  case 5:
    return make_assumed_strain_block_5(law, formulation);
  case 7:
    return make_assumed_strain_block_7(law, formulation);
  }
  throw std::logic_error("there is no block for this number of points through the thickness");
}

bool compare(const ElementComparison &comparison, const ComparedBrick &brick, ElementEnergies &energies) {
  energies.used += brick.accurate.energy;
  if (comparison.formulation().points_through == AssumedStrainElement<>::points_through)
    comparison.add_dissipation(brick.accurate, energies);
  return true;
}

constexpr ElementKind kind = {"assumed strain", &make_block, false, true, LaneElement::assumed_strain,
                              &compare};

} // namespace

const BrickElement BrickElement::assumed_strain(kind);

ElementType assumed_strain_type() {
  return make_element_type(
      BrickElement::assumed_strain,
      "eight points, accurate in bending with one brick through a thickness and in plastic flow");
}

} // namespace billet
