// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_VUMAT_LAW_H
#define BILLET_MATERIAL_VUMAT_LAW_H

#include "billet/material/user_law.h"

#include <array>
#include <cstddef>
#include <memory>

namespace billet {

/// Material subroutine VUMAT of Abaqus/Explicit, as Fortran's compilers call it; the last argument
/// is the length of `cmname`. Arrays have one row for each point of the block, stored by columns.
/// Tensors are 11, 22, 33, 12, 23, 31 with the shears of tensors; deformation gradients 11, 22, 33,
/// 12, 23, 31, 21, 32, 13.
using VumatFunction = void(int *nblock, int *ndir, int *nshr, int *nstatev, int *nfieldv, int *nprops,
                           int *lanneal, double *step_time, double *total_time, double *dt, char *cmname,
                           double *coord_mp, double *char_length, double *props, double *density,
                           double *strain_inc, double *rel_spin_inc, double *temp_old, double *stretch_old,
                           double *defgrad_old, double *field_old, double *stress_old, double *state_old,
                           double *ener_intern_old, double *ener_inelas_old, double *temp_new,
                           double *stretch_new, double *defgrad_new, double *field_new, double *stress_new,
                           double *state_new, double *ener_intern_new, double *ener_inelas_new,
                           std::size_t cmname_length);

/// Law of a VUMAT. Stress, stretch and strain are those of the frame that turns with the material,
/// F = R U. It has the rate of Green & Naghdi, (U6) and (U7) of doc/theory.md. The tangent, which
/// implicit schemes and certifications need, is computed by central differences of the stress, in
/// one block of 13 points. Internal less inelastic energy is the stored energy, the inelastic one
/// the dissipated.
class VumatLaw final : public UserLaw {
public:
  /// Calls the VUMAT at the undeformed point, for the elastic moduli: at time 0, as Abaqus does.
  /// Throws std::runtime_error with a clause about the VUMAT if it fails there, or if it has no
  /// stiffness. `density`: of the undeformed body, > 0 [mass/length^3].
  VumatLaw(VumatFunction *function, UserLawSettings settings, double density);
  ~VumatLaw() override;

  bool update(const dealii::Tensor<2, 3> &F, double J, const PointStep &step, const double *state_n,
              double *state, dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli) const override;

  static constexpr const char *law_name = "VUMAT";

protected:
  /// Returns R.
  dealii::Tensor<2, 3> frame(const dealii::Tensor<2, 3> &F) const override;

private:
  class Block;
  /// F, and F with 12 small symmetric changes.
  static constexpr std::size_t n_differences = 13;
  using Stresses = std::array<dealii::SymmetricTensor<2, 3>, n_differences>;

  /// Calls the VUMAT for the first points of `F`; returns false and sets the refusal if there is no
  /// result. Overwrites Kirchhoff's stresses, and the state of the first point.
  bool evaluate(Block &block, const std::array<dealii::Tensor<2, 3>, n_differences> &F, const PointStep &step,
                double time, const double *state_n, double *state, Stresses &tau) const;

  VumatFunction *function_;
  double density_;
  std::unique_ptr<Block> one_, many_; ///< arguments for one point, and for differences
};

} // namespace billet

#endif
