// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/plane.h"

#include "billet/geometry/frame.h"

namespace billet {

SurfacePicture Plane::picture(const dealii::Tensor<1, 3> &centre, const double radius) const {
  const auto foot = centre - ((centre - point_) * normal_) * normal_;
  const Frame frame = Frame::from_normal(normal_);
  SurfacePicture picture;
  for (const auto &corner : {std::array<double, 2>{-1., -1.}, {1., -1.}, {1., 1.}, {-1., 1.}})
    picture.points.push_back(foot + radius * (corner[0] * frame.q + corner[1] * frame.r));
  picture.facets.push_back({0, 1, 2, 3});
  return picture;
}

} // namespace billet
