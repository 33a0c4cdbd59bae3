// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_UMAT_LAW_H
#define BILLET_MATERIAL_UMAT_LAW_H

#include "billet/material/law_refusal.h"
#include "billet/material/point_law.h"

#include <cstddef>
#include <string>
#include <vector>

namespace billet {

/// Material subroutine UMAT of Abaqus/Standard, as Fortran's compilers call it; the last argument is the
/// length of `cmname`. Tensors are 11, 22, 33, 12, 13, 23, strains with engineering shears, matrices by
/// columns.
using UmatFunction = void(double *stress, double *statev, double *ddsdde, double *sse, double *spd,
                          double *scd, double *rpl, double *ddsddt, double *drplde, double *drpldt,
                          double *stran, double *dstran, double *time, double *dtime, double *temp,
                          double *dtemp, double *predef, double *dpred, char *cmname, int *ndi, int *nshr,
                          int *ntens, int *nstatv, double *props, int *nprops, double *coords, double *drot,
                          double *pnewdt, double *celent, double *dfgrd0, double *dfgrd1, int *noel, int *npt,
                          int *layer, int *kspt, int *jstep, int *kinc, std::size_t cmname_length);

/// A UMAT and what it is called with.
struct UmatSettings {
  UmatFunction *function = nullptr;
  std::string library;                  ///< for messages
  std::string name;                     ///< CMNAME, at most 80 characters
  std::vector<double> constants;        ///< PROPS
  std::vector<double> initial_state;    ///< STATEV of the undeformed point
  std::vector<std::string> state_names; ///< of STATEV; empty: they have numbers
  bool has_symmetric_tangent = true;    ///< only the symmetric part of DDSDDE counts
  bool reads_temperature = false;
  double element_length = 1.; ///< CELENT [length]
};

/// Law of a UMAT. The step is that of Abaqus/Standard with NLGEOM, (U1) to (U4) of doc/theory.md: stress and
/// strain are turned by the increment of rotation of Hughes & Winget, DSTRAN is the strain increment about
/// the configuration at mid-step, and DDSDDE is the Jaumann rate of Kirchhoff's stress over J. F and J are
/// those of the element, so that elements that modify F (mean dilatation) do so for the UMAT, too.
///
/// A shorter step follows if the UMAT asks for one (PNEWDT < 1) or returns numbers that are not finite. After
/// a crash the law refuses every update: refusal() says so.
class UmatLaw final : public SpatialLaw, public ExplainsRefusals {
public:
  /// Calls the UMAT at the undeformed point, for the elastic moduli. Throws std::runtime_error with a clause
  /// about the UMAT if it fails there, or if its tangent is no stiffness.
  explicit UmatLaw(UmatSettings settings);

  std::string name() const override { return law_name; }
  /// Returns the isotropic part of the tangent of the undeformed point, Voigt's average.
  const ElasticModuli &elastic() const override { return elastic_; }
  double bound_stiffness(const dealii::SymmetricTensor<2, 3> &tau) const override;
  std::shared_ptr<const FlowStress> shared_flow_stress() const override { return nullptr; }
  bool depends_on_temperature() const override { return settings_.reads_temperature; }
  bool has_symmetric_moduli() const override { return settings_.has_symmetric_tangent; }
  bool is_rate_form() const override { return false; }
  bool has_exact_dissipation() const override { return false; }

  std::vector<StateField> fields() const override;
  std::size_t n_state() const override { return n_own_state + settings_.initial_state.size(); }
  void initialize(double *state) const override;

  /// Returns SSE, or ½ τ : C⁻¹ τ with the initial moduli C if the UMAT does not compute it [stress].
  double stored_energy(const dealii::Tensor<2, 3> &F, double J, const double *state) const override;
  /// Returns SPD + SCD if the UMAT computes SSE and one of them, else the work of the stresses less the
  /// stored energy [stress].
  double dissipated_energy(const double *state) const override;
  /// Returns the state variable with the name 'equivalent plastic strain'; 0 without one.
  double equivalent_plastic_strain(const double *state) const override;
  /// The pressure is κ ln J. State variables are initial, except for the equivalent plastic strain.
  void set_stress(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &deviator,
                  double equivalent_plastic_strain, double *state) const override;
  std::optional<double> min_wave_stiffness(const std::array<double, 3> &) const override { return {}; }

  bool update(const dealii::Tensor<2, 3> &F, double J, const PointStep &step, const double *state_n,
              double *state, dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli) const override;

  const LawRefusal &refusal() const override { return refusal_; }
  /// Returns words such as "UMAT 'STEEL' of library 'libsteel.so'".
  std::string title() const override { return title_; }

  static constexpr const char *law_name = "UMAT";
  /// Length of the step at whose end the initial moduli hold: any rate has its instantaneous response [time].
  static constexpr double probe_time = 1e-9;

private:
  struct Call;

  static constexpr std::size_t n_own_state = 28;

  double stored_energy(const double *state) const;
  /// Calls the UMAT. Returns false and sets the refusal if there is no result.
  bool perform(Call &call) const;
  bool refuse(const std::string &what, bool is_final = false) const;
  /// Evaluates a known state, without the UMAT.
  bool update_at_rest(const dealii::Tensor<2, 3> &F, const double *state_n, double *state,
                      dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli) const;
  void find_initial_moduli();

  UmatSettings settings_;
  std::string title_;
  SpatialModuli initial_{}; ///< C
  ElasticModuli elastic_{};
  double stiffness_ = 0.; ///< bound of the eigenvalues of C [stress]
  bool has_stored_energy_ = false;
  std::size_t plastic_strain_; ///< place in the state; n_state(): none
  mutable LawRefusal refusal_;
};

/// Returns the moduli of the Lie derivative for those of the Jaumann rate, c = J C − H, (U4):
///   H_ijkl = ½ (δ_ik τ_jl + δ_il τ_jk + δ_jk τ_il + δ_jl τ_ik).
SpatialModuli moduli_of_jaumann(const SpatialModuli &C, double J, const dealii::SymmetricTensor<2, 3> &tau);

} // namespace billet

#endif
