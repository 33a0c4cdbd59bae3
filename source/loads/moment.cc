// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/derivative.h"
#include "billet/geometry/facet_point.h"
#include "billet/geometry/facet_rotation.h"
#include "billet/loads/load.h"

namespace billet {

using dealii::Tensor;

LoadType moment_type();

namespace {

/// F_a = R ∫ N_a J⁻¹M × (X − C) dA on undeformed faces with the centroid C and the second moment J. The
/// tractions have no resultant and the moment M. R is the rotation of the face, or I for a dead load: where
/// all faces turn alike, the tractions and M turn with them. Where they do not, a resultant is left, which
/// has a long arm in a slender body: a strip of a fiftieth of its length, with two faces at its end, rolled
/// to a half circle, stores 3 % too much energy.
class Moment final : public FaceLoad {
public:
  explicit Moment(const bool follows) : follows_(follows) {}

  void add_forces(const std::vector<LoadedFace> &faces, const LoadValues &values, const NodalMotion &motion,
                  double *forces) const override {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const FacetCorners undeformed = undeformed_corners(faces[f], motion);
      const FacetCorners dead = dead_forces(faces[f], undeformed, values.at(f));
      Tensor<2, 3> rotation = dealii::unit_symmetric_tensor<3>();
      if (follows_)
        rotation = facet_rotation<double>(undeformed, faces[f].positions(motion));
      for (unsigned int a = 0; a < 4; ++a)
        add_vector(forces, faces[f].nodes[a], rotation * dead[a]);
    }
  }

  LoadTangent tangent() const override { return follows_ ? LoadTangent::unsymmetric : LoadTangent::none; }

  void add_tangent(const LoadedFace &face, const double *values, const NodalMotion &motion,
                   double /*damping_factor*/, dealii::FullMatrix<double> &matrix) const override {
    constexpr int n_dofs = 12;
    const FacetCorners undeformed = undeformed_corners(face, motion), positions = face.positions(motion);
    const FacetCorners dead = dead_forces(face, undeformed, values);
    FacetCornersOf<Derivative> x;
    for (unsigned int b = 0; b < 4; ++b)
      for (unsigned int j = 0; j < 3; ++j)
        x[b][j] = Derivative(n_dofs, static_cast<int>(3 * b + j), positions[b][j]);
    const Tensor<2, 3, Derivative> rotation = facet_rotation<Derivative>(undeformed, x);
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int i = 0; i < 3; ++i) {
        Derivative force = 0.;
        for (unsigned int k = 0; k < 3; ++k)
          force += rotation[i][k] * dead[a][k];
        for (int j = 0; j < force.size(); ++j)
          matrix(3 * a + i, static_cast<unsigned int>(j)) -= force.dx(j);
      }
  }

private:
  static FacetCorners undeformed_corners(const LoadedFace &face, const NodalMotion &motion) {
    FacetCorners corners;
    for (unsigned int a = 0; a < 4; ++a)
      corners[a] = get_vector(motion.positions, face.nodes[a]);
    return corners;
  }
  static FacetCorners dead_forces(const LoadedFace &face, const FacetCorners &corners, const double *values) {
    const Tensor<1, 3> turn =
        dealii::invert(face.surface->second_moment) * Tensor<1, 3>({values[0], values[1], values[2]});
    FacetCorners forces;
    for (const auto &point : facet_points()) {
      Tensor<1, 3> arm = -face.surface->centre;
      for (unsigned int a = 0; a < 4; ++a)
        arm += point.N[a] * corners[a];
      const double area = point.area_vector([&](const unsigned int a) { return corners[a]; }).norm();
      for (unsigned int a = 0; a < 4; ++a)
        forces[a] += point.N[a] * area * dealii::cross_product_3d(turn, arm);
    }
    return forces;
  }

  bool follows_;
};

} // namespace

LoadType moment_type() {
  return {"moment",
          "total moment on the faces, by tractions in proportion to the distance from their centroid",
          {loaded_faces(),
           {"Moment", "0 ; 0 ; 0", TypeParameter::Kind::text,
            "Vector along the axis: three muParser expressions of the time t and the names of amplitudes. "
            "[force length]"},
           {"Follow", "true", TypeParameter::Kind::flag,
            "Whether the tractions, and with them the moment, turn with each face. Otherwise they keep their "
            "directions, and the moment changes as the arms turn. Faces that turn unequally leave a small "
            "resultant: on slender bodies, compare with one face across the thickness."}},
          [](const TypeInput &input) {
            Load load{{}, std::make_shared<const Moment>(input.flag("Follow"))};
            add_vector_expressions(input, "Moment", false, load);
            return load;
          }};
}

} // namespace billet
