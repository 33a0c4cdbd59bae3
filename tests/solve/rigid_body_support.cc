// SPDX-License-Identifier: LGPL-2.1-or-later
// Rigid-body modes of bodies that supports, contact, friction and driven tools leave free, (Q2): counts that
// are known by hand.
#include "billet/solve/rigid_body_support.h"

#include "../testing.h"

#include <deal.II/base/mpi.h>

namespace rigid_body_support_test {

using namespace billet;
using billet::testing::check;
using dealii::Tensor;
using Friction = SupportingPoint::Friction;

namespace {

const Tensor<1, 3> x({1., 0., 0.}), y({0., 1., 0.}), z({0., 0., 1.});
const RigidBodySupport::Side first{0, {}, {}}, second{1, {}, {}}, standing{};

/// The corners of a face of the cube [-1, 1]³.
std::vector<Tensor<1, 3>> corners(const Tensor<1, 3> &normal) {
  std::vector<Tensor<1, 3>> result;
  const Tensor<1, 3> a = std::abs(normal[2]) > 0.5 ? x : z, b = dealii::cross_product_3d(normal, a);
  for (const double s : {-1., 1.})
    for (const double t : {-1., 1.})
      result.push_back(normal + s * a + t * b);
  return result;
}

/// The cube touches something at the face with this outward normal.
void touch(RigidBodySupport &support, const Tensor<1, 3> &face, const Friction friction,
           const Tensor<1, 3> &slip = {}, const RigidBodySupport::Side &of = first,
           const RigidBodySupport::Side &on = standing) {
  for (const auto &corner : corners(face))
    support.add_contact({corner, -face, friction, slip}, of, on);
}

RigidBodySupport one_cube(const std::size_t n_tools = 0) {
  return {MPI_COMM_WORLD, {{Tensor<1, 3>(), 2.}}, n_tools};
}

} // namespace

BILLET_MPI_TEST(rigid_body_support) {
  { check("nothing touches: six modes", one_cube().find().n_free == 6); }
  {
    RigidBodySupport support = one_cube();
    touch(support, -z, Friction::none);
    check("without friction on a plane: three modes", support.find().n_free == 3);
    touch(support, -x, Friction::none);
    check("and on a wall: one", support.find().n_free == 1);
    const auto free = support.find().free;
    check("which is the slide along both", std::abs(free->motion.translation * y) > 0.99);
    touch(support, y, Friction::none);
    check("and on a third wall: none", support.find().n_free == 0);
  }
  {
    RigidBodySupport support = one_cube();
    touch(support, -z, Friction::sticks);
    check("sticking on a plane: none", support.find().n_free == 0 && !support.find().sliding);
  }
  {
    RigidBodySupport support = one_cube();
    touch(support, -z, Friction::slips, x);
    const auto found = support.find();
    check("full sliding: the slide is free", found.n_free == 1 && found.free->motion.translation * x > 0.99);
    support.add_contact({x - z, z, Friction::sticks, {}}, first, standing);
    check("one node that sticks resists it", support.find().n_free == 0 && !support.find().sliding);
  }
  {
    RigidBodySupport support = one_cube();
    touch(support, -z, Friction::slips, x);
    touch(support, z, Friction::slips, -x);
    const auto found = support.find();
    check("between two that slide apart: bounded by the slip, which is reported",
          found.n_free == 0 && found.sliding && std::abs(found.sliding->motion.translation * x) > 0.99);
    touch(support, z, Friction::slips, x);
    check("the same all one way but for one: bounded, too", support.find().n_free == 0);
  }
  {
    RigidBodySupport support = one_cube();
    touch(support, -z, Friction::slips, x);
    touch(support, -x, Friction::none);
    check("dragged by a wall that pushes: supported", support.find().n_free == 0);
  }
  {
    RigidBodySupport support = one_cube();
    for (const auto &corner : corners(-z))
      support.add_unloaded_contact({corner, z, Friction::sticks, {}}, first, standing);
    const auto found = support.find();
    check("what rests without a force slides, turns and lifts off", found.n_free > 3);
    for (const auto &corner : corners(z))
      support.add_unloaded_contact({corner, -z, Friction::sticks, {}}, first, standing);
    check("between two planes it slides and turns", support.find().n_free == 3);
  }
  {
    RigidBodySupport support = one_cube();
    touch(support, -z, Friction::none);
    support.add_support(0, -x, x);
    support.add_support(0, -x - y, y);
    check("a support at a point leaves the turn about it", support.find().n_free == 1);
    support.add_support(0, x, y);
    check("two hold it", support.find().n_free == 0);
  }
  {
    // A punch that a force drives down presses the cube on nothing, then on a table.
    RigidBodySupport support = one_cube(1);
    const RigidBodySupport::Side punch{{}, 0, -z};
    touch(support, z, Friction::sticks, {}, first, punch);
    check("a tool that a force drives holds nothing along it", support.find().n_free == 1);
    touch(support, -z, Friction::none);
    check("but on a table it does", support.find().n_free == 0);
  }
  {
    RigidBodySupport support(MPI_COMM_WORLD, {{Tensor<1, 3>(), 2.}, {2. * z, 2.}}, 0);
    touch(support, -z, Friction::sticks);
    check("a second body without contact: its six", support.find().n_free == 6);
    touch(support, z, Friction::none, {}, first, second);
    check("on the first without friction: three", support.find().n_free == 3);
    check("and it is the second", support.find().free->body == 1);
    touch(support, z, Friction::sticks, {}, first, second);
    check("with friction: none", support.find().n_free == 0);
  }
  {
    RigidBodySupport support(MPI_COMM_WORLD, {{Tensor<1, 3>(), 2.}, {2. * z, 2.}}, 0);
    touch(support, z, Friction::sticks, {}, first, second);
    check("two that hold each other: six in common", support.find().n_free == 6);
  }
  const auto push = [](RigidBodySupport &support, const Tensor<1, 3> &face, const Friction friction,
                       const RigidBodySupport::Side &of = first,
                       const RigidBodySupport::Side &on = standing) {
    support.weigh_pushes();
    for (const auto &corner : corners(face))
      support.add_pushing_contact({corner, -face, friction, {}}, of, on);
  };
  {
    RigidBodySupport support = one_cube();
    push(support, z, Friction::sticks);
    const auto found = support.find();
    check("a tool that sticks to a loose body and pushes it: it may let go",
          found.is_free[0] && found.free && found.free->body == 0);
    push(support, -z, Friction::none);
    check("until it lies on a table", !support.find().is_free[0]);
  }
  {
    RigidBodySupport support = one_cube(1);
    push(support, z, Friction::sticks, first, {{}, 0, -z});
    push(support, -z, Friction::none);
    check("a tool without a load holds nothing on a table", support.find().is_free[0]);
    support.add_load(0, 5.);
    check("with a load it does", !support.find().is_free[0]);
  }
  {
    RigidBodySupport support = one_cube(1);
    push(support, z, Friction::sticks, first, {{}, 0, -z});
    push(support, -z, Friction::none);
    support.add_load(0, -5.);
    check("unless that draws it up", support.find().is_free[0]);
  }
  {
    RigidBodySupport support(MPI_COMM_WORLD, {{Tensor<1, 3>(), 2.}, {2. * z, 2.}}, 0);
    push(support, -z, Friction::sticks);
    push(support, z, Friction::sticks, first, second);
    const auto found = support.find();
    check("two that lie on each other may both lift off", found.is_free[0] && found.is_free[1]);
    support.hold(1);
    check("a hold of the upper one holds both", !support.find().is_free[0] && !support.find().is_free[1]);
  }
  {
    RigidBodySupport support(MPI_COMM_WORLD, {{Tensor<1, 3>(), 2.}, {9. * z, 2.}}, 0);
    push(support, -z, Friction::sticks);
    push(support, z, Friction::none);
    const auto found = support.find();
    check("of two bodies that do not touch one is free", !found.is_free[0] && found.is_free[1]);
  }
  {
    const auto unresisted = [](RigidBodySupport &support, const Tensor<1, 3> &translation) {
      support.weigh_translations({{translation}});
      return support.find().unresisted[0][0];
    };
    RigidBodySupport support = one_cube();
    push(support, -z, Friction::none);
    check("on a table: the part along it is free", (unresisted(support, x - z) - x).norm(), 0.02);
    check("what goes down is not", unresisted(support, -z).norm() == 0.);
    check("what goes up is", (unresisted(support, 3. * (y + z)) - 3. * (y + z)).norm(), 0.06);
    push(support, x, Friction::none);
    check("a wall resists what goes into it", unresisted(support, x).norm() == 0.);
    check("and not what goes away", (unresisted(support, -x) + x).norm(), 0.02);
  }
  {
    // Pressed between planes, with friction spent along x, but for what the squeeze adds away from the
    // middle.
    RigidBodySupport support = one_cube();
    for (const auto &face : {z, -z})
      for (const auto &corner : corners(face)) {
        Tensor<1, 3> slip = 2. * x + 0.5 * (corner * y) * y;
        slip /= slip.norm();
        support.add_spent_contact({corner, -face, Friction::sticks, slip}, first, standing);
      }
    const auto found = support.find();
    check("spent friction: the body slides along it",
          found.sliding && std::abs(found.sliding->motion.translation * x) > 0.99 &&
              found.sliding->motion.rotation.norm() < 0.01);
  }
}

} // namespace rigid_body_support_test
