// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/assumed_strain_element.h"
#include "billet/mechanics/element_comparison.h"
#include "billet/mechanics/law_block.h"

#include "billet/vector_text.h"

#include <cmath>
#include <stdexcept>
#include <string>

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

/// (B19)
PlaneFactors find_plane_factors(const ElasticModuli &elastic, const ElementFormulation &formulation,
                                const ElementVectors &positions, const unsigned int direction) {
  if (formulation.points_through > AssumedStrainElement<>::points_through) // of plane stress
    return {3., std::sqrt(1. + 0.5 * kept_shear_of_layers * kept_shear_of_layers)};
  const auto modes = compute_modes(positions);
  const auto constants =
      compute_strain_constants(elastic, {2. * modes[0].norm(), 2. * modes[1].norm(), 2. * modes[2].norm()});
  const double share = std::sqrt(constants.share[(direction + 1) % 3][direction] *
                                 constants.share[(direction + 2) % 3][direction]);
  const PlaneFactors of_displacements = plane_factors_of_displacements(elastic);
  return {of_displacements.mean / (share * (1. + 2. * constants.thinning[direction])),
          of_displacements.rest / share};
}

constexpr ElementKind assumed_strain_kind = {"assumed strain",
                                             &make_block,
                                             /*is_stabilised=*/false,
                                             /*has_layers=*/true,
                                             LaneElement::assumed_strain,
                                             &compare,
                                             /*may_lock_in_bending=*/false,
                                             /*may_be_soft=*/false,
                                             &find_plane_factors};

const std::string points_key = "Points through thickness", direction_key = "Thickness direction";

/// Returns "2|3|5|7".
std::string numbers_through() {
  std::string text;
  for (const unsigned int n : all_points_through)
    text += (text.empty() ? "" : "|") + std::to_string(n);
  return text;
}

std::vector<TypeParameter> layer_parameters() {
  return {{points_key, "2", TypeParameter::Kind::choice,
           numbers_through() +
               ": Gauss points of each brick along the thickness direction. More than 2 need a static scene "
               "or implicit dynamics. Use 5 for the springback of sheets, with two bricks through the "
               "thickness rather than one."},
          {direction_key, "", TypeParameter::Kind::text,
           "Direction from the inner to the outer side, for more than 2 points through the thickness. Three "
           "muParser expressions of the undeformed position x, y, z. '0 ; 0 ; 1' is that of a plate, 'x ; y "
           "; 0' that of a tube about z. Each brick uses its axis nearest to it."}};
}

void read_layers(const TypeInput &input, ElementChoice &choice) {
  choice.points_through = static_cast<unsigned int>(std::stoul(input.text(points_key)));
  choice.thickness_direction = split_vector(input.text(direction_key));
  choice.points_origin = input.origin(points_key);
  choice.direction_origin = input.origin(direction_key);
  const bool has_layers = choice.points_through > AssumedStrainElement<>::points_through;
  if (has_layers && choice.thickness_direction.size() != 3)
    input.reject(direction_key,
                 "three expressions, separated by commas or semicolons, such as '0 ; 0 ; 1', since '" +
                     points_key + "' is more than 2");
  if (!has_layers && !choice.thickness_direction.empty())
    input.reject(direction_key, "no value: '" + points_key + " = 2' does not use it");
}

} // namespace

const BrickElement BrickElement::assumed_strain(assumed_strain_kind);

ElementType assumed_strain_type() {
  return make_element_type(
      BrickElement::assumed_strain,
      "eight points, accurate in bending with one brick through a thickness and in plastic flow",
      layer_parameters(), &read_layers);
}

} // namespace billet
