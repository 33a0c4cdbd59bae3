// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/loads/node_site.h"
#include "billet/loads/resisted_direction.h"

namespace billet {

LoadType spring_type();

namespace {

/// F_a = −A_a k P u.
class Spring final : public NodalLoad {
public:
  Spring(const double stiffness, const ResistedDirection &direction)
      : stiffness_(stiffness), direction_(direction) {}

  void add_forces(const std::vector<LoadedNode> &nodes, const LoadValues & /*values*/,
                  const NodalMotion &motion, double *forces) const override {
    for (const LoadedNode &at : nodes)
      add_vector(forces, at.node,
                 direction_.project(-(stiffness_ * at.area) * get_vector(motion.displacements, at.node), at));
  }
  LoadTangent tangent() const override { return LoadTangent::symmetric; }
  void add_tangent(const LoadedNode &node, const double * /*values*/, const NodalMotion & /*motion*/,
                   double /*damping_factor*/, dealii::FullMatrix<double> &matrix) const override {
    direction_.add(stiffness_ * node.area, node, matrix);
  }
  Bound bound(const LoadedSurface & /*surface*/) const override { return {stiffness_, 0.}; }
  std::vector<dealii::Tensor<1, 3>> supports(const dealii::Tensor<1, 3> &normal) const override {
    return direction_.directions(normal);
  }

private:
  double stiffness_;
  ResistedDirection direction_;
};

} // namespace

LoadType spring_type() {
  return {
      "spring",
      "resists displacements of faces or nodes, and supports the body",
      {loaded_faces(),
       loaded_nodes(),
       {"Stiffness", "0", TypeParameter::Kind::number,
        "> 0. Stiffness per undeformed area, or of all 'Nodes' together. [force/length^3, or force/length]"},
       ResistedDirection::parameter()},
      [](const TypeInput &input) {
        return Load{{},
                    std::make_shared<const Spring>(input.positive("Stiffness"), ResistedDirection(input))};
      }};
}

} // namespace billet
