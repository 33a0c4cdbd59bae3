// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_WHOLE_SECTION_H
#define BILLET_SCENE_WHOLE_SECTION_H

#include <deal.II/base/tensor.h>

#include <cmath>

namespace billet {

/// Forces on the whole of a model in two dimensions, a layer or a wedge: per unit of width, or on
/// the full circle.
struct WholeSection {
  enum class Kind {
    model,       ///< a solid model, or a layer of width 1: forces are those of the model
    per_width,   ///< plane strain
    full_circle, ///< axisymmetric: forces across the axis balance
  };

  Kind kind = Kind::model;
  bool is_layer = false;     ///< whether all bodies are layers in plane strain, of any width
  double factor = 1.;        ///< of forces on the model
  dealii::Tensor<1, 3> axis; ///< of the circle, a unit vector

  /// Returns the force in the whole.
  dealii::Tensor<1, 3> of(const dealii::Tensor<1, 3> &force) const {
    return factor * (kind == Kind::full_circle ? (force * axis) * axis : force);
  }
  /// Returns the size of this force.
  double size_of(const dealii::Tensor<1, 3> &force) const {
    return kind == Kind::model ? force.norm() : of(force).norm();
  }
};

} // namespace billet

#endif
