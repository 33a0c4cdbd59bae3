// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_ONE_POINT_H
#define BILLET_MECHANICS_ONE_POINT_H

#include "billet/material/plastic.h"
#include "billet/mechanics/element_block.h"
#include "billet/mechanics/hourglass_energy.h"
#include "billet/mechanics/modal_geometry.h"
#include "billet/mechanics/point_tangent.h"

namespace billet {

/// One-point brick of the explicit kernels, with its tangent. It stores the energy V ψ(F̄) of the
/// mean gradient F̄, and that of the hourglass strains ĥ, (X4), (X6) of doc/theory.md. ĥ does not
/// affect F̄. In plastic bodies both yield together, (X7), and flow changes ĥ_0.
class OnePointElement {
public:
  static constexpr unsigned int n_points = 1;
  static constexpr bool is_stabilised = true;
  static constexpr bool is_layered = false;

  /// Components of b_1, b_2, b_3, c in the element's own directions.
  using HourglassVector = std::array<std::array<double, 3>, 4>;

  struct Reference {
    std::array<std::array<double, 3>, n_linear_modes> beta;
    double volume;
    dealii::Tensor<2, 3> jacobian, inverse_jacobian; ///< (a_1 a_2 a_3)_0
    HourglassVector strain;                          ///< ĥ_0 of the undeformed element
    hourglass::Metric<double> metric;                ///< metric of the undeformed columns
  };
  struct Kinematics {
    dealii::Tensor<2, 3> F;                ///< F̄
    double J;                              ///< det F̄
    dealii::Tensor<2, 3> inverse_jacobian; ///< J̄⁻¹
    Gradients<n_linear_modes> gradients;   ///< J̄⁻ᵀ β: gradients of the modes, as ∂N_a/∂x of nodes
    HourglassVector strain;                ///< ĉ = J̄⁻¹ (b_1, b_2, b_3, c)
    double volume;                         ///< V J
  };
  /// History of the stabilisation: the change of ĥ_0 by plastic flow.
  struct History {
    HourglassVector shift{};
  };
  static constexpr unsigned int n_history = 12;
  static constexpr std::size_t stabilisation_size =
      sizeof(HourglassVector) + sizeof(hourglass::Metric<double>); ///< size in Reference [bytes]
  static void store(const History &history, double *numbers);
  static History restore(const double *numbers);

  /// Response of the stabilisation.
  struct Stabilisation {
    HourglassVector strain, stress; ///< ĥ and V ∂W/∂ĥ without flow
    double energy = 0.;             ///< stored energy
    SharedYield yield;              ///< factor of both after plastic flow
  };

  OnePointElement(const ElasticModuli &elastic, const ElementFormulation &)
      : moduli_(elastic.bulk, elastic.shear) {}

  static bool initialize(const ElementVectors &positions, Reference &reference);
  static bool compute(const Reference &reference, const ElementVectors &displacements,
                      Kinematics &kinematics);

  template <bool>
  static const dealii::Tensor<2, 3> &deformation(const Reference &, const Kinematics &kinematics,
                                                 unsigned int) {
    return kinematics.F;
  }
  static double volume_ratio(const Kinematics &kinematics, unsigned int) { return kinematics.J; }
  static double reference_volume(const Reference &reference, unsigned int) { return reference.volume; }
  static double current_volume(const Kinematics &kinematics) { return kinematics.volume; }
  template <bool> static double weight(const Reference &reference, const Kinematics &, unsigned int) {
    return reference.volume;
  }

  /// Returns the response without flow.
  Stabilisation stabilise(const Reference &reference, const Kinematics &kinematics,
                          const History &history_n) const;
  /// Returns the history at the end of the step.
  static History flow(const Stabilisation &stabilisation, const History &history_n);
  /// Returns the history with which the hourglass strains store no energy.
  static History find_history(const Reference &reference, const Kinematics &kinematics);

  static void add_force(const Reference &reference, const Kinematics &kinematics,
                        const dealii::SymmetricTensor<2, 3> &tau, const Stabilisation &stabilisation,
                        ElementVectors &force);

  /// Computes the tangent. It is symmetric if the moduli are and the rate of the share is
  /// consistent with them, as for Hencky's law.
  template <class Moduli>
  void compute_tangent(const Reference &reference, const Kinematics &kinematics,
                       const dealii::SymmetricTensor<2, 3> &tau, const Moduli &moduli,
                       const Stabilisation &stabilisation, ElementMatrix &matrix) const;

private:
  hourglass::Moduli<double> moduli_;
};

} // namespace billet

#endif
