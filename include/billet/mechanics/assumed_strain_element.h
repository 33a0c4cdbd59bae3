// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_ASSUMED_STRAIN_ELEMENT_H
#define BILLET_MECHANICS_ASSUMED_STRAIN_ELEMENT_H

#include "billet/mechanics/eight_point_elements.h"
#include "billet/mechanics/modal_geometry.h"
#include "billet/mechanics/strain_modes.h"

namespace billet {

/// Constants of (B3) to (B5) for a brick with edges of these lengths.
strain_modes::Constants<double> compute_strain_constants(const ElasticModuli &elastic,
                                                         const std::array<double, 3> &lengths);

/// Eight points under assumed strains, (B1) to (B6) of doc/theory.md: F_q = (det Y_q)^{−1/3} Y_q F̄ with the
/// mean gradient F̄ and strains Y_q − 1 that vary through the brick without parasitic shear. Bends as it
/// should with one brick through a thickness, at any aspect ratio; all points share det F̄. Laws in rate form
/// see Y_q F̄.
class AssumedStrainElement {
public:
  static constexpr unsigned int n_points = n_element_points;
  static constexpr bool is_stabilised = false;
  static constexpr unsigned int n_vectors = 7; ///< a_1, a_2, a_3, b̂_1, b̂_2, b̂_3, ĉ

  struct Reference {
    std::array<std::array<double, n_element_nodes>, n_vectors> of_nodes; ///< these from the nodes' positions
    dealii::Tensor<2, 3> jacobian, inverse_jacobian;                     ///< (a_1 a_2 a_3)_0
    double volume;
    strain_modes::Constants<double> constants;
  };
  struct Kinematics {
    strain_modes::Frame<double> frame;
    double hourglass[4][3];
    std::array<dealii::SymmetricTensor<2, 3>, n_points> Y, inverse_Y;
    std::array<dealii::Tensor<2, 3>, n_points> F, F_of_rates;
    double J, volume; ///< det F̄, and the volume that it makes
  };

  AssumedStrainElement(const ElasticModuli &elastic, const ElementFormulation &) : elastic_(elastic) {}

  bool initialize(const ElementVectors &positions, Reference &reference) const;
  static bool compute(const Reference &reference, const ElementVectors &displacements,
                      Kinematics &kinematics);

  template <bool is_rate_form>
  static const dealii::Tensor<2, 3> &deformation(const Reference &, const Kinematics &kinematics,
                                                 const unsigned int q) {
    return is_rate_form ? kinematics.F_of_rates[q] : kinematics.F[q];
  }
  static double volume_ratio(const Kinematics &kinematics, unsigned int) { return kinematics.J; }
  static double reference_volume(const Reference &reference, unsigned int) {
    return reference.volume / n_points;
  }
  static double current_volume(const Kinematics &kinematics) { return kinematics.volume; }
  template <bool> static double weight(const Reference &reference, const Kinematics &, unsigned int) {
    return reference.volume / n_points;
  }

  template <bool>
  static void add_force(const Reference &reference, const Kinematics &kinematics, const PointStresses &tau,
                        ElementVectors &force);

  template <bool is_symmetrised, class Moduli>
  void compute_tangent(const Reference &reference, const Kinematics &kinematics, const PointStresses &tau,
                       const PointModuli<Moduli> &moduli, ElementMatrix &matrix) const {
    compute_unsymmetric_tangent(reference, kinematics, tau, moduli, matrix);
    if constexpr (is_symmetrised)
      symmetrise(matrix);
  }
  /// Of symmetric moduli.
  static void compute_symmetric_tangent(const Reference &reference, const Kinematics &kinematics,
                                        const PointStresses &tau, const PointModuli<SpatialModuli> &moduli,
                                        ElementMatrix &matrix);

private:
  template <class Moduli>
  void compute_unsymmetric_tangent(const Reference &reference, const Kinematics &kinematics,
                                   const PointStresses &tau, const PointModuli<Moduli> &moduli,
                                   ElementMatrix &matrix) const;

  ElasticModuli elastic_;
};

} // namespace billet

#endif
