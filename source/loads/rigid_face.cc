// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/cross_matrix.h"
#include "billet/loads/load.h"

namespace billet {

LoadType rigid_face_type();

namespace {

using dealii::Tensor;

/// Springs from each point of a surface to its place in the rigid motion that fits best:
/// F_a = −k (p_a − R q_a), (F6) of the theory. They have neither a resultant nor a moment.
class RigidFace final : public SurfaceLoad {
public:
  explicit RigidFace(const double factor) : factor_(factor) {}

  Tensor<1, 3> force(const SurfaceNode &node, const double * /*values*/,
                     const LoadedSurface &surface) const override {
    return -stiffness(surface) * (node.arm - surface.motion.rotation * node.undeformed_arm);
  }
  LoadTangent tangent() const override { return LoadTangent::symmetric; }

  Tensor<2, 3> local_tangent(const double * /*values*/, const LoadedSurface &surface) const override {
    return stiffness(surface) * dealii::unit_symmetric_tensor<3>();
  }
  /// (F7).
  Coupling coupling(const SurfaceNode &node, const double * /*values*/,
                    const LoadedSurface &surface) const override {
    const double k = stiffness(surface);
    const Tensor<2, 3> arm = cross_matrix(surface.motion.rotation * node.undeformed_arm);
    Coupling result;
    for (unsigned int i = 0; i < 3; ++i) {
      result.left[0][i][i] = -k * node.area;
      result.right[0][i][i] = node.area / surface.area;
    }
    result.left[1] = k * arm;
    result.right[1] = invert(surface.motion.turning) * arm;
    return result;
  }
  Bound bound(const LoadedSurface &surface) const override { return {stiffness(surface), 0.}; }
  std::vector<dealii::Tensor<1, 3>> supports(const dealii::Tensor<1, 3> & /*normal*/) const override {
    return {};
  }

private:
  double stiffness(const LoadedSurface &surface) const { return factor_ * surface.stiffness; }

  double factor_;
};

} // namespace

LoadType rigid_face_type() {
  return {"rigid face",
          "keeps the shape of the faces, which may move and turn as one rigid body. Other loads on them act "
          "as on it",
          {loaded_faces(),
           {"Stiffness factor", "100", TypeParameter::Kind::number,
            "> 0. Stiffness of the springs to the rigid motion, per undeformed area, in units of Young's "
            "modulus over the mean size of a face. The faces deform by about its reciprocal of what they "
            "would."}},
          [](const TypeInput &input) {
            return Load{{}, std::make_shared<const RigidFace>(input.positive("Stiffness factor"))};
          }};
}

} // namespace billet
