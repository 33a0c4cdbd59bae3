// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_ASSUMED_STRAIN_ELEMENT_H
#define BILLET_MECHANICS_ASSUMED_STRAIN_ELEMENT_H

#include "billet/mechanics/eight_point_elements.h"
#include "billet/mechanics/modal_geometry.h"
#include "billet/mechanics/strain_modes.h"
#include "billet/mechanics/thickness.h"

#include <array>
#include <type_traits>

namespace billet {

/// Computes the constants of (B3) to (B5) for a brick with these edge lengths. `kept_through` is θ
/// of the bending through the thickness.
strain_modes::Constants<double> compute_strain_constants(const ElasticModuli &elastic,
                                                         const std::array<double, 3> &lengths,
                                                         double kept_through = strain_modes::kept_shear);
/// Value of θ for more than two points through the thickness, where the middle point would add the
/// shear stress to the plastic moment.
constexpr double kept_shear_of_layers = 0.2;

// Additional data of bricks with more than two points through the thickness ("layers"):
struct NoLayers {};
struct LayersReference {
  double modulus;      ///< κ' of (B9) [stress]
  double elastic_part; ///< X/E of elastic bricks
};
struct LayersKinematics {
  strain_modes::Strains<double> strains; ///< spatial, without the free thinning
  dealii::Tensor<2, 3> mean_F;           ///< F̄
  double stretch;                        ///< E of (B8)
  double thinning;                       ///< X of (B8), which set_thinning() sets
};

/// Assumed strains, (B1) to (B6) of doc/theory.md: F_q = (det Y_q)^{−1/3} Y_q F̄ with the mean
/// gradient F̄ and strains Y_q − 1 that vary through the brick without parasitic shear. The element
/// bends accurately with one brick through a thickness, at any aspect ratio; all points share det
/// F̄. Laws in rate form receive Y_q F̄.
///
/// `n_through` is 2, the same points in all directions, or 3, 5 or 7 points through the thickness.
/// In the latter case the brick's thinning X is free, (B8) to (B10): the stresses determine it,
/// since plastic flow thins more than elasticity.
template <unsigned int n_through = 2> class AssumedStrainElement {
public:
  static constexpr unsigned int n_points = 4 * n_through;
  static constexpr unsigned int points_through = n_through;
  static constexpr bool is_stabilised = false;
  static constexpr bool is_layered = n_through > 2;
  static constexpr unsigned int n_vectors = 7; ///< a_1, a_2, a_3, b̂_1, b̂_2, b̂_3, ĉ
  using Stresses = std::array<dealii::SymmetricTensor<2, 3>, n_points>;
  template <class Moduli> using ModuliOf = std::array<Moduli, n_points>;

  /// Undeformed brick. With layers its directions are those of turn_corners(), but its nodes keep
  /// their order.
  struct Reference : std::conditional_t<is_layered, LayersReference, NoLayers> {
    /// Coefficients of nodal positions.
    std::array<std::array<double, n_element_nodes>, n_vectors> of_nodes;
    dealii::Tensor<2, 3> jacobian, inverse_jacobian; ///< (a_1 a_2 a_3)_0
    double volume;
    strain_modes::Constants<double> constants;
  };
  struct Kinematics : std::conditional_t<is_layered, LayersKinematics, NoLayers> {
    strain_modes::Frame<double> frame;
    double hourglass[4][3];
    std::array<dealii::SymmetricTensor<2, 3>, n_points> Y, inverse_Y;
    std::array<dealii::Tensor<2, 3>, n_points> F, F_of_rates;
    double J, volume; ///< det F̄, and the current volume
  };
  /// Thinning of a brick with layers, and the in-plane stretch that belongs to it.
  struct History {
    double thinning = 0., stretch = 0.;
  };
  static constexpr unsigned int n_history = 2;
  static void store(const History &history, double *numbers) {
    numbers[0] = history.thinning;
    numbers[1] = history.stretch;
  }
  static History restore(const double *numbers) { return {numbers[0], numbers[1]}; }

  AssumedStrainElement(const ElasticModuli &elastic, const ElementFormulation &) : elastic_(elastic) {}

  /// Returns false if the brick is degenerate or inverted.
  bool initialize(const ElementVectors &positions, Reference &reference,
                  const ThicknessAxis &axis = {}) const;
  /// Returns false if the state is inadmissible. With layers, set_thinning() completes the
  /// kinematics.
  static bool compute(const Reference &reference, const ElementVectors &displacements,
                      Kinematics &kinematics);

  // The following functions exist only with layers.
  /// Completes the kinematics; returns false as compute() does.
  static bool set_thinning(double thinning, Kinematics &kinematics);
  /// Returns X for a step without plastic flow, the initial guess of the iterations.
  static double predict_thinning(const Reference &reference, const Kinematics &kinematics,
                                 const History &history_n) {
    return history_n.thinning + reference.elastic_part * (kinematics.stretch - history_n.stretch);
  }
  /// Returns P of (B9), and W_X.
  static double thinning_force(const Reference &reference, const Kinematics &kinematics) {
    return reference.modulus * reference.volume / 3. * (kinematics.stretch - kinematics.thinning);
  }
  static double thinning_energy(const Reference &reference, const Kinematics &kinematics) {
    return 0.5 * thinning_force(reference, kinematics) * (kinematics.stretch - kinematics.thinning);
  }
  /// Returns the pressure −p(ζ) of (B9) at a point, to be subtracted from its Kirchhoff stress.
  static double varying_pressure(const Reference &reference, const Kinematics &kinematics, unsigned int q);
  /// Returns the residual (B10): the derivative of the power by X, which vanishes in equilibrium.
  static double thinning_residual(const Reference &reference, const Kinematics &kinematics,
                                  const Stresses &tau);
  /// Returns the derivative of the residual for small strains, for an elastic brick; below, without
  /// any stiffness of the law.
  double elastic_thinning_stiffness(const Reference &reference) const {
    return reference.volume / 3. * (4. / 3. * elastic_.shear + reference.modulus);
  }
  static double min_thinning_stiffness(const Reference &reference) {
    return reference.volume / 3. * reference.modulus;
  }

  template <bool is_rate_form>
  static const dealii::Tensor<2, 3> &deformation(const Reference &, const Kinematics &kinematics,
                                                 const unsigned int q) {
    return is_rate_form ? kinematics.F_of_rates[q] : kinematics.F[q];
  }
  static double volume_ratio(const Kinematics &kinematics, unsigned int) { return kinematics.J; }
  static double reference_volume(const Reference &reference, unsigned int q);
  static double current_volume(const Kinematics &kinematics) { return kinematics.volume; }
  template <bool> static double weight(const Reference &reference, const Kinematics &, const unsigned int q) {
    return reference_volume(reference, q);
  }

  template <bool>
  static void add_force(const Reference &reference, const Kinematics &kinematics, const Stresses &tau,
                        ElementVectors &force);

  template <bool is_symmetrised, class Moduli>
  void compute_tangent(const Reference &reference, const Kinematics &kinematics, const Stresses &tau,
                       const ModuliOf<Moduli> &moduli, ElementMatrix &matrix) const {
    compute_unsymmetric_tangent(reference, kinematics, tau, moduli, matrix);
    if constexpr (is_symmetrised)
      symmetrise(matrix);
  }
  /// Computes the tangent from symmetric moduli.
  static void compute_symmetric_tangent(const Reference &reference, const Kinematics &kinematics,
                                        const Stresses &tau, const ModuliOf<SpatialModuli> &moduli,
                                        ElementMatrix &matrix);

private:
  template <class Moduli>
  void compute_unsymmetric_tangent(const Reference &reference, const Kinematics &kinematics,
                                   const Stresses &tau, const ModuliOf<Moduli> &moduli,
                                   ElementMatrix &matrix) const;

  ElasticModuli elastic_;
};

} // namespace billet

#endif
