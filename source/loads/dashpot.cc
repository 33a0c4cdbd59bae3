// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/loads/node_site.h"
#include "billet/loads/resisted_direction.h"

namespace billet {

LoadType dashpot_type();

namespace {

/// F_a = −A_a c P v.
class Dashpot final : public NodalLoad {
public:
  Dashpot(const double damping, const ResistedDirection &direction)
      : damping_(damping), direction_(direction) {}

  void add_forces(const std::vector<LoadedNode> &nodes, const LoadValues & /*values*/,
                  const NodalMotion &motion, double *forces) const override {
    for (const LoadedNode &at : nodes)
      add_vector(forces, at.node,
                 direction_.project(-(damping_ * at.area) * get_vector(motion.velocities, at.node), at));
  }
  LoadTangent tangent() const override { return LoadTangent::symmetric; }
  void add_tangent(const LoadedNode &node, const double * /*values*/, const NodalMotion & /*motion*/,
                   const double damping_factor, dealii::FullMatrix<double> &matrix) const override {
    direction_.add(damping_factor * (damping_ * node.area), node, matrix);
  }
  Bound bound(const LoadedSurface & /*surface*/) const override { return {0., damping_}; }
  std::vector<dealii::Tensor<1, 3>> supports(const dealii::Tensor<1, 3> & /*normal*/) const override {
    return {};
  }

private:
  double damping_;
  ResistedDirection direction_;
};

} // namespace

LoadType dashpot_type() {
  return {
      "dashpot",
      "resists velocities of faces or nodes",
      {loaded_faces(),
       loaded_nodes(),
       {"Damping", "0", TypeParameter::Kind::number,
        "> 0. Viscosity per undeformed area, or of all 'Nodes' together. [force time/length^3, or force "
        "time/length]"},
       ResistedDirection::parameter()},
      [](const TypeInput &input) {
        return Load{{}, std::make_shared<const Dashpot>(input.positive("Damping"), ResistedDirection(input))};
      }};
}

} // namespace billet
