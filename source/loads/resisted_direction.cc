// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/loads/resisted_direction.h"

namespace billet {

TypeParameter ResistedDirection::parameter() {
  return {"Direction", "all", TypeParameter::Kind::text,
          "Direction of the resistance: all, normal (of the undeformed face), or a vector 'x, y, z'."};
}

ResistedDirection::ResistedDirection(const TypeInput &input) {
  const std::string text = input.text("Direction");
  kind_ = text == "all" ? Kind::all : text == "normal" ? Kind::normal : Kind::vector;
  if (kind_ == Kind::normal && input.is_set("Nodes"))
    input.reject("Direction", "all, or a vector 'x, y, z': 'Nodes' have no normal");
  if (kind_ == Kind::vector)
    vector_ = input.direction("Direction");
}

std::vector<dealii::Tensor<1, 3>> ResistedDirection::directions(const dealii::Tensor<1, 3> &normal) const {
  switch (kind_) {
  case Kind::all:
    return {dealii::Tensor<1, 3>({1., 0., 0.}), dealii::Tensor<1, 3>({0., 1., 0.}),
            dealii::Tensor<1, 3>({0., 0., 1.})};
  case Kind::normal:
    return {normal};
  case Kind::vector:
    return {vector_};
  }
  return {};
}

void ResistedDirection::add(const double c, const LoadedNode &node,
                            dealii::FullMatrix<double> &matrix) const {
  const dealii::Tensor<1, 3> &d = along(node);
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      matrix(i, j) += c * (kind_ == Kind::all ? (i == j ? 1. : 0.) : d[i] * d[j]);
}

} // namespace billet
