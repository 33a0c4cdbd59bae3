// SPDX-License-Identifier: LGPL-2.1-or-later
// Axes of loads: a dead traction along the radius, the circumference and the axis of a line, one in a fixed
// triad, and a force on a point.
#include "make_load.h"

#include "../testing.h"

namespace axes_test {

using namespace billet;
using billet::testing::check;
using dealii::Tensor;

namespace {

/// Force of a traction 1 ; 2 ; 3 on a node of area 2 of a face about `centre`.
Tensor<1, 3> force(const std::string &axes, const dealii::Point<3> &centre) {
  const Load load =
      testing::make_load("dead traction", "set Boundary ids = 0\nset Traction = 1 ; 2 ; 3\n" + axes).load;
  LoadValues values(3, 1, true);
  for (unsigned int i = 0; i < 3; ++i)
    values.at(0)[i] = 1. + i;
  std::array<double, nodal_stride> zero{}, sum{};
  const std::vector<LoadedNode> nodes{{0, 2., Tensor<1, 3>({0., 0., 1.}), centre}};
  std::get<std::shared_ptr<const NodalLoad>>(load.action)
      ->add_forces(nodes, values, {zero.data(), zero.data(), zero.data()}, sum.data());
  return get_vector(sum.data(), 0);
}

} // namespace

BILLET_TEST(axes) {
  const dealii::Point<3> centre(1., 4., 7.);
  check("global", (force("", centre) - Tensor<1, 3>({2., 4., 6.})).norm(), 1e-14);
  // About the line through (1, 1, 1) along z the radius at (1, 4, 7) is y, and the circumference −x.
  check("cylindrical",
        (force("set Axes = cylindrical\nset Axis point = 1, 1, 1\nset Axis direction = 0, 0, 5", centre) -
         Tensor<1, 3>({-4., 2., 6.}))
            .norm(),
        1e-14);
  // e_1 = z, e_2 = x, e_3 = y.
  check("local",
        (force("set Axes = local\nset First axis = 0, 0, 2\nset Second axis = 1, 0, 1", centre) -
         Tensor<1, 3>({4., 6., 2.}))
            .norm(),
        1e-14);
  const Load load =
      testing::make_load("force", "set Point = 1, 4, 7\nset Force = 1 ; 2 ; 3\nset Axes = cylindrical\n"
                                  "set Axis point = 1, 1, 1\nset Axis direction = 0, 0, 5")
          .load;
  const std::array<double, 3> values{1., 2., 3.};
  const auto &point = std::get<std::shared_ptr<const PointLoad>>(load.action);
  check("force on a point", (point->force(values.data()) - Tensor<1, 3>({-2., 1., 3.})).norm(), 1e-14);
  check("where it acts", point->position() == dealii::Point<3>(1., 4., 7.) && !point->takes_nearest_node());
}

} // namespace axes_test
