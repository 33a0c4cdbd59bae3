// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_USER_LAW_H
#define BILLET_MATERIAL_USER_LAW_H

#include "billet/material/guarded_arrays.h"
#include "billet/material/point_law.h"
#include "billet/material/user_subroutine.h"

#include <cstddef>
#include <string>
#include <vector>

namespace billet {

/// A subroutine of a user's library and what it is called with, apart from the subroutine itself.
struct UserLawSettings {
  std::string library;                  ///< for messages
  std::string name;                     ///< of the material, at most 80 characters
  std::vector<double> constants;        ///< PROPS
  std::vector<double> initial_state;    ///< state variables of the undeformed point
  std::vector<std::string> state_names; ///< of the state variables; empty: they have numbers
  bool has_symmetric_tangent = true;    ///< only the symmetric part of the tangent counts
  bool reads_temperature = false;
  double element_length = 1.;   ///< characteristic length of an element [length]
  std::string idle_subroutines; ///< names of subroutines in the library that are not called
};

/// Writes the name of a material as Fortran has it, with spaces behind.
void write_name(const std::string &name, char (&target)[80]);

/// Base of the laws of material subroutines. The state of a point has the deformation gradient, the
/// stress, the strain, energies and the work. The clock of the last step, a bound of the moduli and
/// the state variables follow. Energies are (U5) of doc/theory.md.
///
/// A shorter step follows if the subroutine returns numbers that are not finite. After a crash the
/// law refuses every update: refusal() says so.
class UserLaw : public SpatialLaw, public UserSubroutine {
public:
  std::string name() const override { return kind_; }
  std::string description() const override { return kind_; }
  std::string summary() const override { return kind_; }
  /// Returns the isotropic part of the tangent of the undeformed point, Voigt's average.
  const ElasticModuli &elastic() const override { return elastic_; }
  double bound_stiffness(const dealii::SymmetricTensor<2, 3> &tau) const override;
  double bound_stiffness_at(const double *state, const dealii::SymmetricTensor<2, 3> &tau) const override;
  std::shared_ptr<const FlowStress> shared_flow_stress() const override { return nullptr; }
  bool depends_on_temperature() const override { return settings_.reads_temperature; }
  bool has_symmetric_moduli() const override { return settings_.has_symmetric_tangent; }
  bool is_rate_form() const override { return false; }
  bool has_exact_dissipation() const override { return false; }

  std::vector<StateField> fields() const override;
  std::size_t n_state() const override { return n_own_state + settings_.initial_state.size(); }
  void initialize(double *state) const override;

  /// Returns what the subroutine computes. If it does not, nothing tells which part of the work is
  /// elastic: returns all of it, less the dissipated energy [stress].
  double stored_energy(const dealii::Tensor<2, 3> &F, double J, const double *state) const override;
  /// Returns what the subroutine computes, or the work of the stresses less the stored energy if it
  /// computes that one alone [stress].
  double dissipated_energy(const double *state) const override;
  /// Returns the state variable with the name 'equivalent plastic strain'; 0 without one.
  double equivalent_plastic_strain(const double *state) const override;
  /// The pressure is κ ln J. State variables are initial, except for the equivalent plastic strain.
  void set_stress(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &deviator,
                  double equivalent_plastic_strain, double *state) const override;
  /// Returns energies, clock, bound of moduli and state variables.
  std::vector<double> memory(const dealii::Tensor<2, 3> &F, const double *state) const override;
  void remember(const dealii::Tensor<2, 3> &F, const std::vector<double> &memory,
                double *state) const override;
  std::optional<double> min_wave_stiffness(const std::array<double, 3> &) const override { return {}; }

  const LawRefusal &refusal() const override { return refusal_; }
  std::string title() const override { return title_; }
  bool computes_energies() const override { return has_stored_energy_; }
  double lost_asymmetry() const override { return lost_asymmetry_; }
  std::string idle_subroutines() const override { return settings_.idle_subroutines; }

  /// Length of the step at whose end the initial moduli hold: any rate has its instantaneous
  /// response [time].
  static constexpr double probe_time = 1e-9;
  /// Strain by which the undeformed point is probed.
  static constexpr double probe_strain = 1e-6;

protected:
  /// Places in the state of a point, before those of the state variables.
  enum Place : std::size_t {
    gradient = 0,
    stress = 9,
    strain = 15,
    energies = 21, ///< stored, plastic, creep
    work = 24,
    time = 25,
    temperature = 26,
    increments = 27,
    bound = 28 ///< of the eigenvalues of J times the moduli [stress]
  };
  static constexpr std::size_t n_own_state = 29;

  /// `kind`: name of the law in scenes.
  UserLaw(const char *kind, UserLawSettings settings);

  const UserLawSettings &settings() const { return settings_; }
  const SpatialModuli &initial_moduli() const { return initial_; }
  /// Returns the bound for the state of a point with these moduli: rubber stiffens, and metal has
  /// its initial moduli again when it unloads.
  double bound_moduli(const SpatialModuli &moduli, double J) const;
  /// Sets the moduli of the undeformed point. Throws std::runtime_error if they are no stiffness.
  void set_initial(const SpatialModuli &C, bool has_stored_energy);
  /// Makes C symmetric unless the scene says that it is not; remembers what is lost.
  void symmetrise(SpatialModuli &C) const;
  /// Returns the rotation between the frame of the stress in the state and space at F.
  virtual dealii::Tensor<2, 3> frame(const dealii::Tensor<2, 3> &F) const;

  /// Calls the subroutine, guarded. Returns false and sets the refusal if it does not return.
  bool call(void (*function)(void *), void *data) const;
  bool refuse(const std::string &what, bool is_final = false) const;
  /// Refuses numbers that are not finite, of which `name` is the argument.
  bool check(const double *numbers, std::size_t n, const std::string &what, const std::string &name) const;
  /// Refuses for good if the subroutine has written outside of an array. `names`: one for each
  /// array.
  bool check_guards(GuardedArrays &arrays, const char *const *names) const;
  void accept() const;

private:
  const char *kind_;
  UserLawSettings settings_;
  std::string title_;
  SpatialModuli initial_{}; ///< C
  ElasticModuli elastic_{};
  double stiffness_ = 0.; ///< bound of the eigenvalues of C [stress]
  mutable double lost_asymmetry_ = 0.;
  bool has_stored_energy_ = false;
  std::size_t plastic_strain_; ///< place in the state; n_state(): none
  mutable LawRefusal refusal_;
};

/// Tensors as numbers, in the order 11, 22, 33, 12, 13, 23.
dealii::SymmetricTensor<2, 3> read_tensor(const double *numbers);
void write_tensor(const dealii::SymmetricTensor<2, 3> &tensor, double *numbers);
/// Deformation gradients as numbers, row by row.
dealii::Tensor<2, 3> read_gradient(const double *numbers);
void write_gradient(const dealii::Tensor<2, 3> &F, double *numbers);
/// Returns C : d.
dealii::SymmetricTensor<2, 3> multiply(const SpatialModuli &C, const dealii::SymmetricTensor<2, 3> &d);

} // namespace billet

#endif
