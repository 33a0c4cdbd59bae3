// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_AXES_H
#define BILLET_GEOMETRY_AXES_H

#include "billet/registered_type.h"

#include <deal.II/base/symmetric_tensor.h>

#include <array>
#include <string>
#include <vector>

namespace billet {

/// Axes of the components of a vector at an undeformed position, such as a prescribed displacement.
/// They are those of space, a fixed triad, or the radial, circumferential and axial directions
/// about a line.
class Axes {
public:
  static std::vector<TypeParameter> parameters();

  /// Those of space.
  Axes() = default;
  /// Refuses wrong values.
  explicit Axes(const TypeInput &input);
  /// A fixed triad of orthogonal unit vectors.
  explicit Axes(const std::array<dealii::Tensor<1, 3>, 3> &triad);
  /// Returns cylindrical axes about the line through this point along this unit vector.
  static Axes about(const dealii::Tensor<1, 3> &point, const dealii::Tensor<1, 3> &direction);

  bool are_global() const { return kind_ == Kind::global; }
  bool are_cylindrical() const { return kind_ == Kind::cylindrical; }
  /// Returns a description for messages and checkpoints, such as "axes (0, 1, 0), (1, 0, 0)".
  std::string description() const;
  /// Returns the distance to the line of cylindrical axes [length].
  double radius(const dealii::Tensor<1, 3> &position) const;
  /// Returns the unit vectors. On the line itself, that of the radius is arbitrary.
  std::array<dealii::Tensor<1, 3>, 3> at(const dealii::Tensor<1, 3> &position) const;
  /// Returns the vector with these components.
  dealii::Tensor<1, 3> to_global(const double *components, const dealii::Tensor<1, 3> &position) const;
  /// Return the components of a vector or tensor of space along these axes.
  dealii::Tensor<1, 3> from_global(const dealii::Tensor<1, 3> &vector,
                                   const dealii::Tensor<1, 3> &position) const;
  dealii::SymmetricTensor<2, 3> from_global(const dealii::SymmetricTensor<2, 3> &tensor,
                                            const dealii::Tensor<1, 3> &position) const;

private:
  enum class Kind { global, local, cylindrical };

  Kind kind_ = Kind::global;
  std::array<dealii::Tensor<1, 3>, 3> triad_; ///< the third is the axis of cylindrical ones
  dealii::Tensor<1, 3> point_;                ///< on the axis
};

} // namespace billet

#endif
