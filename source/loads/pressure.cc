// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/loads/load.h"

#include "billet/geometry/facet_point.h"

namespace billet {

using dealii::Tensor;

LoadType pressure_type();

namespace {

/// F_a = −∫ p N_a n dA on the deformed faces.
class Pressure final : public FaceLoad {
public:
  void add_forces(const std::vector<LoadedFace> &faces, const LoadValues &values, const NodalMotion &motion,
                  double *forces) const override {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const double *p = values.at(f);
      const auto positions = faces[f].positions(motion);
      for (const auto &point : facet_points()) {
        const Tensor<1, 3> area = point.area_vector([&](const unsigned int a) { return positions[a]; });
        for (unsigned int a = 0; a < 4; ++a)
          add_vector(forces, faces[f].nodes[a], -*p * point.N[a] * area);
        ++p;
      }
    }
  }

  /// The derivative is symmetric only if the pressure is uniform and its edge is fixed or does not
  /// exist.
  LoadTangent tangent() const override { return LoadTangent::unsymmetric; }
  /// Its stiffness, p h at a node of a brick of size h, is small against E h, that of the brick.
  Bound bound(const LoadedSurface & /*surface*/) const override { return {}; }
  std::vector<dealii::Tensor<1, 3>> supports(const dealii::Tensor<1, 3> & /*normal*/) const override {
    return {};
  }

  /// −∂F_a/∂x_b = ∫ p N_a (N_b,ξ [· × x,η] + N_b,η [x,ξ × ·]) dξdη.
  void add_tangent(const LoadedFace &face, const double *values, const NodalMotion &motion,
                   double /*damping_factor*/, dealii::FullMatrix<double> &matrix) const override {
    const auto positions = face.positions(motion);
    for (const auto &point : facet_points()) {
      const double p = *values++;
      const auto [g_1, g_2] = point.tangents([&](const unsigned int a) { return positions[a]; });
      for (unsigned int b = 0; b < 4; ++b)
        for (unsigned int j = 0; j < 3; ++j) {
          Tensor<1, 3> e;
          e[j] = 1.;
          const Tensor<1, 3> change = point.N_xi[b] * dealii::cross_product_3d(e, g_2) +
                                      point.N_eta[b] * dealii::cross_product_3d(g_1, e);
          for (unsigned int a = 0; a < 4; ++a)
            for (unsigned int i = 0; i < 3; ++i)
              matrix(3 * a + i, 3 * b + j) += p * point.N[a] * change[i];
        }
    }
  }
};

} // namespace

LoadType pressure_type() {
  return {
      "pressure",
      "stress on the deformed faces, against their outward normal",
      {loaded_faces(),
       {"Pressure", "0", TypeParameter::Kind::text,
        "Expression of the undeformed position x, y, z, the time t and the names of amplitudes. [stress]"}},
      [](const TypeInput &input) {
        return Load{{{"Pressure", input.text("Pressure"), true}}, std::make_shared<const Pressure>()};
      }};
}

} // namespace billet
