// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_UMAT_LAW_H
#define BILLET_MATERIAL_UMAT_LAW_H

#include "billet/material/user_law.h"

#include <cstddef>
#include <memory>

namespace billet {

/// Material subroutine UMAT of Abaqus/Standard, as Fortran's compilers call it; the last argument
/// is the length of `cmname`. Tensors are 11, 22, 33, 12, 13, 23, strains with engineering shears,
/// matrices by columns.
using UmatFunction = void(double *stress, double *statev, double *ddsdde, double *sse, double *spd,
                          double *scd, double *rpl, double *ddsddt, double *drplde, double *drpldt,
                          double *stran, double *dstran, double *time, double *dtime, double *temp,
                          double *dtemp, double *predef, double *dpred, char *cmname, int *ndi, int *nshr,
                          int *ntens, int *nstatv, double *props, int *nprops, double *coords, double *drot,
                          double *pnewdt, double *celent, double *dfgrd0, double *dfgrd1, int *noel, int *npt,
                          int *layer, int *kspt, int *jstep, int *kinc, std::size_t cmname_length);

/// Law of a UMAT. The step is that of Abaqus/Standard with NLGEOM, (U1) to (U4) of doc/theory.md.
/// Stress and strain are turned by the increment of rotation of Hughes & Winget. DSTRAN is the
/// strain increment about the configuration at mid-step. DDSDDE is the Jaumann rate of Kirchhoff's
/// stress over J.
///
/// F and J are those of the element, so that elements that modify F (mean dilatation) do so for the
/// UMAT, too.
///
/// A shorter step follows if the UMAT asks for one (PNEWDT < 1). SSE is the stored energy, SPD +
/// SCD the dissipated one.
class UmatLaw final : public UserLaw {
public:
  /// Calls the UMAT at the undeformed point, for the elastic moduli. Throws std::runtime_error with
  /// a clause about the UMAT if it fails there, or if its tangent is no stiffness.
  UmatLaw(UmatFunction *function, UserLawSettings settings);

  bool update(const dealii::Tensor<2, 3> &F, double J, const PointStep &step, const double *state_n,
              double *state, dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli) const override;

  static constexpr const char *law_name = "UMAT";

private:
  struct Call;

  /// Calls the UMAT. Returns false and sets the refusal if there is no result.
  bool perform(Call &call) const;
  /// Evaluates a known state, without the UMAT.
  bool update_at_rest(const dealii::Tensor<2, 3> &F, const double *state_n, double *state,
                      dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli) const;

  UmatFunction *function_;
  std::unique_ptr<GuardedArrays> arrays_; ///< of the call
};

/// Returns the moduli of the Lie derivative for those of the Jaumann rate, c = J C − H, (U4):
///   H_ijkl = ½ (δ_ik τ_jl + δ_il τ_jk + δ_jk τ_il + δ_jl τ_ik).
SpatialModuli moduli_of_jaumann(const SpatialModuli &C, double J, const dealii::SymmetricTensor<2, 3> &tau);

} // namespace billet

#endif
