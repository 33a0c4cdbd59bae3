// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/cross_matrix.h"
#include "billet/loads/node_site.h"

namespace billet {

LoadType moment_type();

namespace {

using dealii::Tensor;

/// F_a = ω × p_a with ω = J⁻¹ m, (F4) of the theory: no resultant, and the moment m about any
/// point, however the surface deforms. m = R M if the moment follows, else M.
class Moment final : public SurfaceLoad {
public:
  explicit Moment(const bool follows) : follows_(follows) {}

  Tensor<1, 3> force(const SurfaceNode &node, const double *values,
                     const LoadedSurface &surface) const override {
    return dealii::cross_product_3d(turn(values, surface.motion), node.arm);
  }
  LoadTangent tangent() const override { return LoadTangent::unsymmetric; }
  /// As for pressures, the stiffness of the bricks exceeds its own.
  Bound bound(const LoadedSurface & /*surface*/) const override { return {}; }
  std::vector<dealii::Tensor<1, 3>> supports(const dealii::Tensor<1, 3> & /*normal*/) const override {
    return {};
  }

  Tensor<2, 3> local_tangent(const double *values, const LoadedSurface &surface) const override {
    return -cross_matrix(turn(values, surface.motion));
  }
  /// (F5).
  Coupling coupling(const SurfaceNode &node, const double *values,
                    const LoadedSurface &surface) const override {
    const SurfaceMotion &motion = surface.motion;
    const Tensor<1, 3> omega = turn(values, motion);
    Tensor<2, 3> change = outer_product(node.arm, omega) - 2. * outer_product(omega, node.arm);
    for (unsigned int i = 0; i < 3; ++i)
      change[i][i] += node.arm * omega;
    if (follows_)
      change -= cross_matrix(moment(values, motion)) * invert(motion.turning) *
                cross_matrix(motion.rotation * node.undeformed_arm);
    Coupling result;
    result.left[0] = node.area * cross_matrix(omega);
    result.left[1] = cross_matrix(node.arm);
    for (unsigned int i = 0; i < 3; ++i)
      result.right[0][i][i] = node.area / surface.area;
    result.right[1] = invert(motion.second_moment) * change;
    return result;
  }

private:
  /// m
  Tensor<1, 3> moment(const double *values, const SurfaceMotion &motion) const {
    const Tensor<1, 3> M({values[0], values[1], values[2]});
    return follows_ ? motion.rotation * M : M;
  }
  /// ω
  Tensor<1, 3> turn(const double *values, const SurfaceMotion &motion) const {
    return invert(motion.second_moment) * moment(values, motion);
  }

  bool follows_;
};

} // namespace

LoadType moment_type() {
  return {
      "moment",
      "total moment on faces or nodes, by forces in proportion to the distance from their centroid",
      {loaded_faces(),
       loaded_nodes(),
       {"Moment", "0 ; 0 ; 0", TypeParameter::Kind::text,
        "Vector along the axis: three muParser expressions of the time t and the names of amplitudes. "
        "[force length]"},
       {"Follow", "true", TypeParameter::Kind::flag,
        "Whether the vector turns with the faces or nodes as a whole; otherwise it keeps its direction."}},
      [](const TypeInput &input) {
        Load load{{}, std::make_shared<const Moment>(input.flag("Follow"))};
        add_vector_expressions(input, "Moment", false, load);
        return load;
      }};
}

} // namespace billet
