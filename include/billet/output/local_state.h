// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_LOCAL_STATE_H
#define BILLET_OUTPUT_LOCAL_STATE_H

#include "billet/mechanics/element_block.h"
#include "billet/solve/element_points.h"

#include <deal.II/base/point.h>

#include <memory>

namespace billet {

/// Stress and strains at a point of an element.
struct LocalState {
  dealii::SymmetricTensor<2, 3> cauchy_stress; ///< [stress]
  dealii::SymmetricTensor<2, 3> strain;        ///< logarithmic, in space
  double equivalent_plastic_strain = 0.;
};

/// Element of a body with what its block knows of it.
struct ElementData {
  ElementVectors positions; ///< undeformed
  ElementVectors displacements;
  ElementSummary summary;
  const ElementPoints *points; ///< null: only means are known
};

/// Evaluates stress and strains within the elements of a body, (B18) to (B20) of doc/theory. They
/// vary along the three directions of a brick, as the stresses at its points do. The stress along a
/// direction does not vary in it: the bending stress is plane. It does not exceed the yield stress.
class LocalStates {
public:
  LocalStates(std::shared_ptr<const PointLaw> law, const ElementFormulation &formulation)
      : law_(std::move(law)), formulation_(formulation) {}

  /// Returns the state at coordinates from 0 to 1, in deal.II's order.
  LocalState evaluate(const ElementData &element, const dealii::Point<3> &coordinates) const;

private:
  /// Returns the part of `bending` that the yield stress at this plastic strain allows, from 0
  /// to 1.
  double find_share(const ElementData &element, double volume_ratio, double equivalent_plastic_strain,
                    const dealii::SymmetricTensor<2, 3> &bending) const;

  std::shared_ptr<const PointLaw> law_;
  ElementFormulation formulation_;
};

} // namespace billet

#endif
