// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_POINT_LAW_H
#define BILLET_MATERIAL_POINT_LAW_H

#include "billet/material/flow_stress.h"
#include "billet/material/moduli.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace billet {

/// The yield condition that a point shares with the stabilisation of its element, (X7) of doc/theory.md:
/// √(q² + 6 G W) = σ_y, as W = σ_y²/6G is what a yielding point stores. The return leaves the same share of
/// both stresses.
struct SharedYield {
  double energy = 0.;        ///< W: what the stabilisation would store without flow [energy/volume]
  double share = 1.;         ///< β
  double slope = 0.;         ///< ∂β/∂W
  dealii::Tensor<2, 3> rate; ///< ∂β : L is the rate of β at given W
};

/// The step that an update belongs to.
struct PointStep {
  /// Length of the step [time]. Zero gives rate-dependent laws no time to flow: the stress of a state that is
  /// known.
  double dt = 0.;
  /// A point yields where q > σ_y (1 + `yield_slack`): in a state that has just yielded, where round-off
  /// would decide, 1e-9 gives the tangent of unloading, −1e-9 that of further loading.
  double yield_slack = 0.;
  /// With its energy given, q is that of both; its other numbers are answers. Null: none.
  SharedYield *shared = nullptr;
};

/// A named part of a law's state at a point.
struct StateField {
  std::string name;
  std::size_t n_components;
};

/// A material law: what a point answers to a deformation. It knows nothing of elements, schemes or ranks. The
/// state of a point is an array of n_state() numbers, which fields() names. Stresses are Kirchhoff's. `F` is
/// the deformation gradient as the element has it; `J` the volume ratio of the pressure, det F of most
/// elements.
class PointLaw {
public:
  virtual ~PointLaw() = default;

  /// Name of the elasticity, as scenes call it.
  virtual std::string name() const = 0;
  /// Words for messages and checkpoints, such as "elastoplastic with linear hardening".
  std::string description() const {
    return flow_stress() == nullptr ? "elastic" : "elastoplastic with " + flow_stress()->description();
  }

  /// Bulk and shear modulus of the undeformed solid. They bound what steps, penalties and hourglass control
  /// need.
  virtual const ElasticModuli &elastic() const = 0;
  /// Returns an upper bound of the stiffness of waves at a point, per squared velocity gradient [stress]:
  /// stresses turn and stretch with the body, hence the terms beyond the moduli.
  virtual double bound_stiffness(const dealii::SymmetricTensor<2, 3> &tau) const;
  /// Null of laws without plasticity.
  virtual std::shared_ptr<const FlowStress> shared_flow_stress() const = 0;
  const FlowStress *flow_stress() const { return shared_flow_stress().get(); }
  bool has_plasticity() const { return shared_flow_stress() != nullptr; }

  virtual bool has_symmetric_moduli() const = 0;
  /// Whether energies follow from the law but for the order of the step: a stored energy exists.
  virtual bool is_rate_form() const = 0;
  /// Whether the dissipation is exact, or of the order of the elastic strains.
  virtual bool has_exact_dissipation() const = 0;

  virtual std::vector<StateField> fields() const = 0;
  virtual std::size_t n_state() const = 0;
  /// Overwrites `state` with that of the undeformed point.
  virtual void initialize(double *state) const = 0;

  /// Stored energy per reference volume [stress], at a state that belongs to F.
  virtual double stored_energy(const dealii::Tensor<2, 3> &F, double J, const double *state) const = 0;
  /// Dissipated energy per reference volume up to a state [stress].
  virtual double dissipated_energy(const double *state) const = 0;
  virtual double equivalent_plastic_strain(const double *state) const = 0;

  /// Overwrites `state` with that for which `F` has a Kirchhoff stress of this deviator, where that is below
  /// the yield stress.
  virtual void set_stress(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &deviator,
                          double equivalent_plastic_strain, double *state) const = 0;

  /// Least stiffness of plane waves over the shear modulus at these principal stretches, (M2) of
  /// doc/theory.md; nothing where the law does not know it. Where it is negative, results depend on the mesh.
  virtual std::optional<double> least_wave_stiffness(const std::array<double, 3> &stretches) const = 0;

  /// How the explicit kernels compute the law for several elements at once; nothing where they do not, so
  /// that explicit scenes go element by element.
  virtual std::optional<LaneLaw> lane_law() const { return {}; }
};

/// A law whose moduli are those of the Lie derivative, or all derivatives by the velocity gradient. `M`:
/// SpatialModuli or GradientModuli.
template <class M> class LawWithModuli : public PointLaw {
public:
  using Moduli = M;

  /// Overwrites `tau` with the Kirchhoff stress at the end of a step [stress], `state` with the state there
  /// and, unless it is null, `moduli` with the consistent tangent. `state_n` and `state` must not overlap.
  /// Returns false where F is not admissible (not finite, singular): the step has to be cut. In rate form the
  /// moduli are those of dev τ alone.
  virtual bool update(const dealii::Tensor<2, 3> &F, double J, const PointStep &step, const double *state_n,
                      double *state, dealii::SymmetricTensor<2, 3> &tau, Moduli *moduli) const = 0;
};
using SpatialLaw = LawWithModuli<SpatialModuli>;
using RateLaw = LawWithModuli<GradientModuli>;

} // namespace billet

#endif
