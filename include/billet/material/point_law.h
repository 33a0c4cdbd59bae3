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

/// Yield condition √(q² + 6 G W) = σ_y that a point shares with the stabilisation of its element,
/// (X7) of doc/theory.md. A yielding point stores W = σ_y²/6G. The return map scales both stresses
/// by the same factor.
struct SharedYield {
  /// W: energy that the stabilisation would store without flow [energy/volume].
  double energy = 0.;
  double share = 1.;         ///< β
  double slope = 0.;         ///< ∂β/∂W
  dealii::Tensor<2, 3> rate; ///< ∂β : L is the rate of β at given W
};

/// Data of the step that an update belongs to.
struct PointStep {
  /// Length of the step [time]. With zero, rate-dependent laws have no time to flow: this evaluates
  /// the stress of a known state.
  double dt = 0.;
  /// Temperature of the body at the end of the step, for laws that depend on it [temperature].
  double temperature = 0.;
  /// A point yields if q > σ_y (1 + `yield_slack`). In a state that has just yielded, round-off
  /// would decide: 1e-9 gives the tangent of unloading, −1e-9 that of further loading.
  double yield_slack = 0.;
  /// If not null: its energy is input and enters q; its other members are output. Null: no shared
  /// yield condition.
  SharedYield *shared = nullptr;
};

/// Named part of a law's state at a point.
struct StateField {
  std::string name;
  std::size_t n_components;
  /// Names of the components in files, such as "xx"; without names they are numbered from 1.
  std::vector<std::string> components = {};
};

/// Material law: the response of a point to a deformation. It is independent of elements, schemes
/// and ranks. The state of a point is an array of n_state() numbers, which fields() names. Stresses
/// are Kirchhoff's. `F` is the deformation gradient of the element; `J` is the volume ratio of the
/// pressure, det F for most elements.
class PointLaw {
public:
  virtual ~PointLaw() = default;

  /// Returns the name of the elasticity in scene files.
  virtual std::string name() const = 0;
  /// Returns a description for messages and checkpoints, such as "elastoplastic with linear
  /// hardening".
  virtual std::string description() const {
    return flow_stress() == nullptr ? "elastic" : "elastoplastic with " + flow_stress()->description();
  }
  /// Returns what the report of a scene says of the law, such as "Hencky plasticity".
  virtual std::string summary() const { return name() + (has_plasticity() ? " plasticity" : " elasticity"); }

  /// Returns the bulk and shear modulus of the undeformed solid. They determine time steps,
  /// penalties and hourglass control.
  virtual const ElasticModuli &elastic() const = 0;
  /// Returns an upper bound of the stiffness of waves at a point, per squared velocity gradient
  /// [stress]. It has terms beyond the moduli, since stresses rotate and stretch with the body.
  virtual double bound_stiffness(const dealii::SymmetricTensor<2, 3> &tau) const;
  /// Returns the bound for a point in this state, to which `tau` belongs.
  virtual double bound_stiffness_at(const double * /*state*/,
                                    const dealii::SymmetricTensor<2, 3> &tau) const {
    return bound_stiffness(tau);
  }
  /// Whether bound_stiffness() holds for all deformations. For a law that stiffens without a bound
  /// by its stress, callers take it from the moduli, bound_by_moduli().
  virtual bool has_bound_of_stiffness() const { return true; }
  /// Returns null for laws without plasticity.
  virtual std::shared_ptr<const FlowStress> shared_flow_stress() const = 0;
  const FlowStress *flow_stress() const { return shared_flow_stress().get(); }
  /// Whether the law flows at a yield stress, which it has by flow_stress().
  bool has_plasticity() const { return shared_flow_stress() != nullptr; }

  /// Whether the law reads PointStep::temperature. Scenes must then give it, and otherwise must
  /// not. Stored and dissipated energy are still the work of the stresses: such a law counts the
  /// energy that heat brings as dissipated, with opposite sign.
  virtual bool depends_on_temperature() const { return false; }
  virtual bool has_symmetric_moduli() const = 0;
  /// Whether the law is in rate form: a stored energy exists only up to the order of the step.
  virtual bool is_rate_form() const = 0;
  /// Whether the dissipation is exact; otherwise its error is of the order of the elastic strains.
  virtual bool has_exact_dissipation() const = 0;

  /// Returns the fields in the order of their numbers. Output and checkpoints find them by their
  /// names.
  virtual std::vector<StateField> fields() const = 0;
  virtual std::size_t n_state() const = 0;
  /// Overwrites `state` with the state of the undeformed point.
  virtual void initialize(double *state) const = 0;
  /// The same for a point of an element with this undeformed centre, on which material axes may
  /// depend.
  virtual void initialize_at(const dealii::Tensor<1, 3> & /*centre*/, double *state) const {
    initialize(state);
  }

  /// Returns the stored energy per reference volume [stress] at a state that belongs to F.
  virtual double stored_energy(const dealii::Tensor<2, 3> &F, double J, const double *state) const = 0;
  /// Returns the dissipated energy per reference volume up to a state [stress].
  virtual double dissipated_energy(const double *state) const = 0;
  virtual double equivalent_plastic_strain(const double *state) const = 0;

  /// Overwrites a `state` from initialize_at() with that for which `F` has a Kirchhoff stress with
  /// this deviator, which is below the yield stress.
  virtual void set_stress(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &deviator,
                          double equivalent_plastic_strain, double *state) const = 0;
  /// Returns what a state at F has beside its stress and its equivalent plastic strain, such as
  /// backstress. The numbers may be averaged over points; remember() takes them.
  virtual std::vector<double> memory(const dealii::Tensor<2, 3> & /*F*/, const double * /*state*/) const {
    return {};
  }
  /// Completes a state from set_stress() at F by a memory() of this law, which may be that of other
  /// points.
  virtual void remember(const dealii::Tensor<2, 3> & /*F*/, const std::vector<double> & /*memory*/,
                        double * /*state*/) const {}

  /// Returns the minimum stiffness of plane waves over the shear modulus at these principal
  /// stretches, (M7) of doc/theory.md; nothing if the law cannot compute it. If it is negative,
  /// ellipticity is lost and results depend on the mesh.
  virtual std::optional<double> min_wave_stiffness(const std::array<double, 3> &stretches) const = 0;
  /// Returns the slope of the flow stress with plastic strain for a point in this state that
  /// yields, (H20) of doc/theory [stress]. It includes the heat of the plastic work. Returns
  /// nothing if the law cannot soften. If the slope is negative, strains localise in one layer of
  /// elements. `temperature`: of the body.
  virtual std::optional<double> flow_slope(const double * /*state*/, double /*temperature*/) const {
    return {};
  }

  /// Returns the form in which the explicit kernels compute the law for several elements at once.
  /// Returns nothing if they do not support it; explicit scenes then compute element by element.
  virtual std::optional<LaneLaw> lane_law() const { return {}; }
};

/// Whether stresses depend on the path, so that errors of steps remain: those of a law without a
/// state do not.
inline bool depends_on_path(const PointLaw &law) { return law.n_state() > 0; }

/// Law whose moduli are those of the Lie derivative, or all derivatives with respect to the
/// velocity gradient. `M`: SpatialModuli or GradientModuli.
template <class M> class LawWithModuli : public PointLaw {
public:
  using Moduli = M;

  /// Overwrites `tau` with the Kirchhoff stress at the end of a step [stress], and `state` with the
  /// state there. Unless `moduli` is null, overwrites it with the consistent tangent. `state_n` and
  /// `state` must not overlap. Returns false if F is inadmissible (not finite, singular): the step
  /// must be cut. In rate form the rows of the moduli are those of dev τ alone.
  virtual bool update(const dealii::Tensor<2, 3> &F, double J, const PointStep &step, const double *state_n,
                      double *state, dealii::SymmetricTensor<2, 3> &tau, Moduli *moduli) const = 0;
};
using SpatialLaw = LawWithModuli<SpatialModuli>;
using RateLaw = LawWithModuli<GradientModuli>;

} // namespace billet

#endif
