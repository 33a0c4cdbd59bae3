// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/vumat_law.h"

#include "billet/material/hypoelastic.h"
#include "billet/material/umat_law.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

namespace {

constexpr double difference = 1e-6; // of strains, for the tangent
/// Places of a VUMAT's components among ours.
constexpr unsigned int place_of[6] = {0, 1, 2, 3, 5, 4};
/// Rows and columns of a VUMAT's deformation gradient.
constexpr unsigned int vumat_rows[9] = {0, 1, 2, 0, 1, 2, 1, 2, 0},
                       vumat_columns[9] = {0, 1, 2, 1, 2, 0, 0, 1, 2};

/// F = R U, by Newton's method for the orthogonal factor (Higham 1986).
struct Polar {
  Tensor<2, 3> R;
  SymmetricTensor<2, 3> U;

  /// Returns false if F is singular or not finite.
  bool compute(const Tensor<2, 3> &F) {
    constexpr unsigned int max_iterations = 100;
    constexpr double round_off = 1e-15;
    R = F;
    for (unsigned int i = 0; i < max_iterations; ++i) {
      const double det = dealii::determinant(R);
      if (!(det > 0.) || !std::isfinite(det))
        return false;
      const Tensor<2, 3> next = 0.5 * (R + dealii::transpose(dealii::invert(R)));
      const double change = (next - R).norm();
      R = next;
      if (change * change <= round_off) // it converges quadratically: the next change is round-off
        break;
    }
    U = dealii::symmetrize(dealii::transpose(R) * F);
    return true;
  }
};

/// F and, if they are wanted, its changes by small symmetric velocity gradients, forwards and
/// backwards.
std::array<Tensor<2, 3>, 13> change(const Tensor<2, 3> &F, const bool has_changes) {
  std::array<Tensor<2, 3>, 13> result;
  result[0] = F;
  for (unsigned int k = 0; k < 6 && has_changes; ++k) {
    SymmetricTensor<2, 3> d;
    d.access_raw_entry(k) = k < 3 ? difference : 0.5 * difference;
    const Tensor<2, 3> increment = static_cast<Tensor<2, 3>>(d) * F;
    result[1 + 2 * k] = F + increment;
    result[2 + 2 * k] = F - increment;
  }
  return result;
}

/// Returns the derivatives of the stress by these changes.
SpatialModuli differentiate(const std::array<SymmetricTensor<2, 3>, 13> &tau) {
  SpatialModuli M;
  for (unsigned int k = 0; k < 6; ++k)
    for (unsigned int i = 0; i < 6; ++i)
      M[i][k] = (tau[1 + 2 * k].access_raw_entry(i) - tau[2 + 2 * k].access_raw_entry(i)) / (2. * difference);
  return M;
}

} // namespace

/// Arguments of a VUMAT for a block of points.
class VumatLaw::Block {
public:
  Block(const VumatLaw &law, const std::size_t n)
      : law_(law), n_(n), n_variables_(law.settings().initial_state.size()),
        arrays_(sizes(law, n), n * n_guards_behind) {
    for (auto *numbers : {&density_, &length_, &temperature_n_, &temperature_, &intern_n_, &inelastic_n_,
                          &intern_, &inelastic_, &field_})
      numbers->assign(n, 0.);
    coordinates_.assign(3 * n, 0.);
    std::fill(length_.begin(), length_.end(), law.settings().element_length);
    // Newer versions of Abaqus have the number of the point and others behind nblock.
    points_.assign(4 + n, 1);
    points_[0] = static_cast<int>(n);
    write_name(law.settings().name, name_);
  }

  std::size_t size() const { return n_; }

  /// Sets times, temperatures and energies at the start; the same for all points.
  void begin(const PointStep &step, const double time, const double *state_n) {
    time_ = time;
    dt_ = step.dt;
    std::copy(law_.settings().constants.begin(), law_.settings().constants.end(), arrays_[constants]);
    const double at_start = state_n[increments] > 0. ? state_n[Place::temperature] : step.temperature;
    const double inelastic = state_n[energies + 1] / law_.density_,
                 intern = state_n[energies] / law_.density_ + inelastic;
    std::fill(temperature_n_.begin(), temperature_n_.end(), at_start);
    std::fill(temperature_.begin(), temperature_.end(), step.temperature);
    std::fill(inelastic_n_.begin(), inelastic_n_.end(), inelastic);
    std::fill(intern_n_.begin(), intern_n_.end(), intern);
    inelastic_ = inelastic_n_;
    intern_ = intern_n_;
    for (std::size_t p = 0; p < n_; ++p)
      for (std::size_t i = 0; i < n_variables_; ++i)
        arrays_[state_old][i * n_ + p] = arrays_[state_new][i * n_ + p] = state_n[n_own_state + i];
  }

  /// Sets the motion of point p from F_n = R_n U_n to F = R U, and its stress at the start.
  void set(const std::size_t p, const Tensor<2, 3> &F_n, const Polar &polar_n, const Tensor<2, 3> &F,
           const Polar &polar, const SymmetricTensor<2, 3> &stress) {
    const Tensor<2, 3> L = static_cast<Tensor<2, 3>>(polar.U - polar_n.U) *
                           static_cast<Tensor<2, 3>>(dealii::invert(0.5 * (polar.U + polar_n.U)));
    write(strain_increment, p, dealii::symmetrize(L));
    const double spins[3] = {0.5 * (L[1][0] - L[0][1]), 0.5 * (L[2][1] - L[1][2]), 0.5 * (L[0][2] - L[2][0])};
    for (unsigned int i = 0; i < 3; ++i)
      arrays_[spin_increment][i * n_ + p] = spins[i];
    write(stretch_old, p, polar_n.U);
    write(stretch_new, p, polar.U);
    write(stress_old, p, stress);
    write(stress_new, p, stress);
    for (unsigned int i = 0; i < 9; ++i) {
      arrays_[gradient_old][i * n_ + p] = F_n[vumat_rows[i]][vumat_columns[i]];
      arrays_[gradient_new][i * n_ + p] = F[vumat_rows[i]][vumat_columns[i]];
    }
    density_[p] = law_.density_ / dealii::determinant(F);
  }

  /// Performs the call, for call_guarded().
  static void perform(void *const data) {
    Block &b = *static_cast<Block *>(data);
    int ndir = 3, nshr = 3, n_variables = static_cast<int>(b.n_variables_), n_fields = 0,
        n_constants = static_cast<int>(b.law_.settings().constants.size()), annealing = 0;
    const auto at = [&b](const Array array) { return b.arrays_[array]; };
    b.law_.function_(b.points_.data(), &ndir, &nshr, &n_variables, &n_fields, &n_constants, &annealing,
                     &b.time_, &b.time_, &b.dt_, b.name_, b.coordinates_.data(), b.length_.data(),
                     at(constants), b.density_.data(), at(strain_increment), at(spin_increment),
                     b.temperature_n_.data(), at(stretch_old), at(gradient_old), b.field_.data(),
                     at(stress_old), at(state_old), b.intern_n_.data(), b.inelastic_n_.data(),
                     b.temperature_.data(), at(stretch_new), at(gradient_new), b.field_.data(),
                     at(stress_new), at(state_new), b.intern_.data(), b.inelastic_.data(), sizeof b.name_);
  }

  SymmetricTensor<2, 3> stress(const std::size_t p) const { return read(stress_new, p); }
  SymmetricTensor<2, 3> strain(const std::size_t p) const { return read(strain_increment, p); }
  double variable(const std::size_t p, const std::size_t i) const { return arrays_[state_new][i * n_ + p]; }
  const double *stresses() const { return arrays_[stress_new]; }
  const double *variables() const { return arrays_[state_new]; }
  std::size_t n_variables() const { return arrays_.size(state_new); }
  GuardedArrays &arrays() { return arrays_; }
  /// Names of the arrays, for messages.
  static constexpr const char *names[] = {"strainInc",
                                          "relSpinInc",
                                          "stretchOld",
                                          "defgradOld",
                                          "stressOld",
                                          "stateOld",
                                          "stretchNew",
                                          "defgradNew",
                                          "stressNew",
                                          "props (nprops)",
                                          "stateNew (nblock by nstatev, 'State variables')"};
  double inelastic_energy() const { return law_.density_ * inelastic_[0]; }
  double stored_energy() const { return law_.density_ * (intern_[0] - inelastic_[0]); }

private:
  enum Array {
    strain_increment,
    spin_increment,
    stretch_old,
    gradient_old,
    stress_old,
    state_old,
    stretch_new,
    gradient_new,
    stress_new,
    constants,
    state_new
  };
  static std::vector<std::size_t> sizes(const VumatLaw &law, const std::size_t n) {
    const std::size_t n_variables = n * law.settings().initial_state.size();
    return {6 * n,       3 * n, 6 * n, 9 * n, 6 * n,
            n_variables, 6 * n, 9 * n, 6 * n, law.settings().constants.size(),
            n_variables};
  }
  /// For a point: indices of wrong variables stride over all points.
  static constexpr std::size_t n_guards_behind = 512;

  void write(const Array array, const std::size_t p, const SymmetricTensor<2, 3> &tensor) {
    for (unsigned int i = 0; i < 6; ++i)
      arrays_[array][i * n_ + p] = tensor.access_raw_entry(place_of[i]);
  }
  SymmetricTensor<2, 3> read(const Array array, const std::size_t p) const {
    SymmetricTensor<2, 3> tensor;
    for (unsigned int i = 0; i < 6; ++i)
      tensor.access_raw_entry(place_of[i]) = arrays_[array][i * n_ + p];
    return tensor;
  }

  const VumatLaw &law_;
  std::size_t n_, n_variables_;
  GuardedArrays arrays_; // by Array
  std::vector<double> density_, length_, temperature_n_, temperature_, intern_n_, inelastic_n_, intern_,
      inelastic_, field_, coordinates_;
  std::vector<int> points_;
  double time_ = 0., dt_ = 0.;
  char name_[80];
};

VumatLaw::VumatLaw(VumatFunction *const function, UserLawSettings settings, const double density)
    : UserLaw(law_name, std::move(settings)), function_(function), density_(density),
      one_(std::make_unique<Block>(*this, 1)), many_(std::make_unique<Block>(*this, n_differences)) {
  std::vector<double> state_n(n_state()), state(n_state());
  initialize(state_n.data());
  PointStep step;
  step.dt = probe_time;
  Stresses tau;
  const auto probe = [&](Block &block, const Tensor<2, 3> &F) {
    if (!evaluate(block, change(F, block.size() > 1), step, 0., state_n.data(), state.data(), tau))
      throw std::runtime_error(refusal().what + " at the undeformed point");
  };
  const Tensor<2, 3> unit = dealii::unit_symmetric_tensor<3>();
  probe(*many_, unit);
  SpatialModuli C = differentiate(tau);
  symmetrise(C);
  Tensor<2, 3> F = unit;
  F[0][0] += probe_strain;
  probe(*one_, F);
  set_initial(C, state[energies] != 0.);
}

VumatLaw::~VumatLaw() = default;

Tensor<2, 3> VumatLaw::frame(const Tensor<2, 3> &F) const {
  Polar polar;
  return polar.compute(F) ? polar.R : dealii::unit_symmetric_tensor<3>();
}

bool VumatLaw::evaluate(Block &block, const std::array<Tensor<2, 3>, n_differences> &F, const PointStep &step,
                        const double time, const double *state_n, double *state, Stresses &tau) const {
  const Tensor<2, 3> F_n = read_gradient(state_n);
  Polar polar_n, polar;
  std::array<Tensor<2, 3>, n_differences> R;
  if (!polar_n.compute(F_n))
    return false;
  block.begin(step, time, state_n);
  const SymmetricTensor<2, 3> stress_n = read_tensor(state_n + Place::stress);
  for (std::size_t p = 0; p < block.size(); ++p) {
    if (!polar.compute(F[p]))
      return false;
    R[p] = polar.R;
    block.set(p, F_n, polar_n, F[p], polar, stress_n);
  }
  if (!call(&Block::perform, &block) || !check_guards(block.arrays(), Block::names) ||
      !check(block.stresses(), 6 * block.size(), "a stress", "stressNew") ||
      !check(block.variables(), block.n_variables(), "a state variable", "stateNew"))
    return false;
  accept();
  for (std::size_t p = 0; p < block.size(); ++p)
    tau[p] = dealii::determinant(F[p]) * turn(R[p], block.stress(p));
  const SymmetricTensor<2, 3> stress = block.stress(0), change = block.strain(0);
  write_gradient(F[0], state);
  write_tensor(stress, state + Place::stress);
  write_tensor(read_tensor(state_n + Place::strain) + change, state + Place::strain);
  state[energies] = block.stored_energy();
  state[energies + 1] = block.inelastic_energy();
  state[energies + 2] = 0.;
  state[work] = state_n[work] +
                0.5 * ((dealii::determinant(F_n) * stress_n + dealii::determinant(F[0]) * stress) * change);
  state[Place::time] = time;
  state[Place::temperature] = step.temperature;
  state[increments] = state_n[increments] + 1.;
  state[bound] = state_n[bound]; // nobody knows later moduli
  for (std::size_t i = 0; i < settings().initial_state.size(); ++i)
    state[n_own_state + i] = block.variable(0, i);
  return true;
}

bool VumatLaw::update(const Tensor<2, 3> &F, double, const PointStep &step, const double *state_n,
                      double *state, SymmetricTensor<2, 3> &tau, SpatialModuli *moduli) const {
  const double J = dealii::determinant(F);
  if (!(J > 0.) || !std::isfinite(F.norm()))
    return false;
  if (step.dt == 0.) { // a known state, up to an elastic change
    const Tensor<2, 3> F_n = read_gradient(state_n);
    Polar polar_n, polar;
    if (!polar.compute(F))
      return false;
    SymmetricTensor<2, 3> stress = read_tensor(state_n + Place::stress);
    if (F != F_n) {
      if (!polar_n.compute(F_n))
        return false;
      stress += multiply(initial_moduli(), polar.U - polar_n.U);
    }
    std::copy_n(state_n, n_state(), state);
    write_gradient(F, state);
    write_tensor(stress, state + Place::stress);
    tau = J * turn(polar.R, stress);
    if (moduli != nullptr)
      *moduli = moduli_of_jaumann(initial_moduli(), J, tau);
    return true;
  }
  Stresses stresses;
  if (!evaluate(moduli != nullptr ? *many_ : *one_, change(F, moduli != nullptr), step,
                state_n[Place::time] + step.dt, state_n, state, stresses))
    return false;
  tau = stresses[0];
  if (moduli != nullptr) {
    *moduli = moduli_of_jaumann(differentiate(stresses), 1., tau);
    symmetrise(*moduli);
  }
  return true;
}

} // namespace billet
