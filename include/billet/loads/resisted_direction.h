// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_LOADS_RESISTED_DIRECTION_H
#define BILLET_LOADS_RESISTED_DIRECTION_H

#include "billet/loads/load.h"

namespace billet {

/// Projection P of loads that resist a motion: I, or d ⊗ d along a direction d.
class ResistedDirection {
public:
  static TypeParameter parameter();
  explicit ResistedDirection(const TypeInput &input);

  /// Returns P f.
  dealii::Tensor<1, 3> project(const dealii::Tensor<1, 3> &f, const LoadedNode &node) const {
    if (kind_ == Kind::all)
      return f;
    const dealii::Tensor<1, 3> &d = along(node);
    return (f * d) * d;
  }
  /// Returns orthogonal unit vectors of its range, on a face with this normal.
  std::vector<dealii::Tensor<1, 3>> directions(const dealii::Tensor<1, 3> &normal) const;
  /// Adds c P to `matrix`.
  void add(double c, const LoadedNode &node, dealii::FullMatrix<double> &matrix) const;

private:
  enum class Kind { all, normal, vector };
  const dealii::Tensor<1, 3> &along(const LoadedNode &node) const {
    return kind_ == Kind::normal ? node.normal : vector_;
  }

  Kind kind_;
  dealii::Tensor<1, 3> vector_; ///< unit vector
};

} // namespace billet

#endif
