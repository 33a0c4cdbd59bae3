// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EIGHT_POINT_ELEMENTS_H
#define BILLET_MECHANICS_EIGHT_POINT_ELEMENTS_H

#include "billet/mechanics/element_block.h"
#include "billet/mechanics/point_tangent.h"

namespace billet {

// Elements in the form that LawBlock requires: the input of the law at each point, and the forces
// of its stress.

/// Stresses at the eight points, and their moduli.
using PointStresses = std::array<dealii::SymmetricTensor<2, 3>, n_element_points>;
template <class Moduli> using PointModuli = std::array<Moduli, n_element_points>;

/// Q1/P0 element, see MeanDilatationKinematics. Laws in rate form receive F, not F̄, and their dev
/// τ is weighted with current volumes, J w/J̄, so that σ = τ/J̄ is Cauchy's stress. The explicit
/// kernels have the same element.
class MeanDilatationElement {
public:
  static constexpr unsigned int n_points = n_element_points;
  static constexpr bool is_stabilised = false;
  static constexpr bool is_layered = false;
  using Reference = ReferenceElement;
  using Kinematics = MeanDilatationKinematics;

  MeanDilatationElement(const ElasticModuli &, const ElementFormulation &) {}

  static bool initialize(const ElementVectors &positions, Reference &reference) {
    return compute_reference_element(positions, reference);
  }
  static bool compute(const Reference &reference, const ElementVectors &displacements,
                      Kinematics &kinematics) {
    return compute_kinematics(reference, displacements, kinematics);
  }

  /// Returns F̄, or F for a law in rate form.
  template <bool is_rate_form>
  static dealii::Tensor<2, 3> deformation(const Reference &reference, const Kinematics &kinematics,
                                          const unsigned int q) {
    if constexpr (is_rate_form)
      return std::cbrt(kinematics.current_volumes[q] / reference.volumes[q] / kinematics.volume_ratio) *
             kinematics.F_bar[q];
    return kinematics.F_bar[q];
  }
  static double volume_ratio(const Kinematics &kinematics, unsigned int) { return kinematics.volume_ratio; }
  static double reference_volume(const Reference &reference, const unsigned int q) {
    return reference.volumes[q];
  }
  static double current_volume(const Kinematics &kinematics) { return kinematics.current_volume; }
  /// Returns the weight of dev τ.
  template <bool is_rate_form>
  static double weight(const Reference &reference, const Kinematics &kinematics, const unsigned int q) {
    return is_rate_form ? kinematics.current_volumes[q] / kinematics.volume_ratio : reference.volumes[q];
  }

  template <bool is_rate_form>
  static void add_force(const Reference &reference, const Kinematics &kinematics, const PointStresses &tau,
                        ElementVectors &force) {
    if constexpr (is_rate_form)
      add_internal_force(reference, kinematics, weigh(reference, kinematics, tau), force);
    else
      add_internal_force(reference, kinematics, tau, force);
  }

  template <bool is_symmetrised>
  void compute_tangent(const Reference &reference, const Kinematics &kinematics, const PointStresses &tau,
                       const PointModuli<SpatialModuli> &moduli, ElementMatrix &matrix) const {
    if constexpr (is_symmetrised) {
      PointModuli<SpatialModuli> symmetric;
      for (unsigned int q = 0; q < n_points; ++q)
        symmetric[q] = symmetrise(moduli[q]);
      compute_internal_tangent(reference, kinematics, tau, symmetric, matrix);
    } else
      compute_unsymmetric_internal_tangent(reference, kinematics, tau, moduli, matrix);
  }
  template <bool is_symmetrised>
  void compute_tangent(const Reference &reference, const Kinematics &kinematics, const PointStresses &tau,
                       const PointModuli<GradientModuli> &moduli, ElementMatrix &matrix) const {
    compute_rate_tangent(reference, kinematics, tau, moduli, matrix);
    if constexpr (is_symmetrised)
      symmetrise(matrix);
  }
  /// Computes the tangent from symmetric moduli.
  static void compute_symmetric_tangent(const Reference &reference, const Kinematics &kinematics,
                                        const PointStresses &tau, const PointModuli<SpatialModuli> &moduli,
                                        ElementMatrix &matrix) {
    compute_internal_tangent(reference, kinematics, tau, moduli, matrix);
  }

private:
  /// Returns the stresses with dev τ multiplied by J/J̄.
  static PointStresses weigh(const Reference &reference, const Kinematics &kinematics,
                             const PointStresses &tau);

  /// Computes the tangent of a law in rate form. With s = (J/J̄) dev τ, δs = (J/J̄) (A : L + dev τ
  /// (tr L − div̄)), Π = Σ w p, and κ = dp/d ln J̄:
  ///   K = Σ_q w {δs g_a − s Lᵀ g_a} + V κ δdiv̄ div̄
  ///       + Π {(1/v) Σ_q J w [tr δL tr L − tr(δL L)] − δdiv̄ div̄}.
  void compute_rate_tangent(const Reference &reference, const Kinematics &kinematics,
                            const PointStresses &tau, const PointModuli<GradientModuli> &moduli,
                            ElementMatrix &matrix) const;
};

} // namespace billet

#endif
