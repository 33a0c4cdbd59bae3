// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/element_block.h"

namespace billet {

std::unique_ptr<ElementBlock> make_element_block(const std::shared_ptr<const PointLaw> &law,
                                                 const ElementFormulation &formulation) {
  return formulation.element.make_block(law, formulation);
}

dealii::Tensor<1, 3> find_centre(const ElementVectors &positions) {
  dealii::Tensor<1, 3> centre;
  for (unsigned int i = 0; i < n_element_dofs; ++i)
    centre[i % 3] += positions[i] / n_element_nodes;
  return centre;
}

} // namespace billet
