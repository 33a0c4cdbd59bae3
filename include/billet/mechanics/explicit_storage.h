// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_STORAGE_H
#define BILLET_MECHANICS_EXPLICIT_STORAGE_H

#include "billet/mechanics/explicit/kernel.h"
#include "billet/mechanics/explicit_block.h"

#include <deal.II/base/aligned_vector.h>

namespace billet {

/// The order of the six numbers of a symmetric tensor in kernels.
constexpr unsigned int symmetric_pairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

/// State at a point of an element, from its history.
struct PointState {
  double reference_volume; ///< its share of the element's
  double volume_ratio;     ///< J̄ of mean dilatation, J of the one-point element
  /// dev τ where the law is hypoelastic, else b_e up to a factor
  dealii::SymmetricTensor<2, 3> tensor;
  double equivalent_plastic_strain;
};

/// The numbers that kernels read and write: laid out in batches, filled in the beginning, read for output.
class ExplicitStorage {
public:
  ExplicitStorage(unsigned int n_lanes, const ExplicitFormulation &formulation, bool has_plasticity,
                  bool keeps_yield_stress);

  /// See ExplicitBlock::initialize(). `yield_stress`: the initial one, used if it is kept.
  bool initialize(const std::vector<std::array<unsigned int, n_element_nodes>> &elements,
                  const double *reference_positions, const explicit_kernels::Material &material,
                  double yield_stress, std::size_t &offender);

  std::size_t size() const { return n_elements_; }
  const explicit_kernels::Layout &layout() const { return layout_; }
  explicit_kernels::Elements elements();

  /// One element in all lanes of a batch of its own.
  struct Copy {
    dealii::AlignedVector<std::uint32_t> nodes;
    dealii::AlignedVector<double> constants, history;
  };
  /// The numbers stand in `copy`, made anew.
  explicit_kernels::Elements copy_element(std::size_t element, Copy &copy) const;
  /// Numbers at the nodes that the elements name: their count, at stride 4.
  std::size_t nodal_size() const { return reference_positions_.size(); }

  /// Multiplies the density of one element. Returns the reference volume that the mass added would have had.
  double scale_mass(std::size_t element, double factor);

  void add_masses(double density, double *masses) const;

  /// Of the eight points, or of the one; empty where an element is inverted.
  std::vector<PointState> compute_states(std::size_t element, const double *displacements) const;
  /// The other way about: one state for each of those, of which tensor and plastic strain are read; b_e is
  /// that of determinant 1. `yield_stress`: of each, used if it is kept. A one-point element with plasticity
  /// also forgets what its stabilisation holds.
  void set_states(std::size_t element, const double *displacements, const std::vector<PointState> &states,
                  const std::vector<double> &yield_stress);

  void get_history(std::size_t element, double *numbers) const;
  void set_history(std::size_t element, const double *numbers);

private:
  using NodalMasses = std::array<double, n_element_nodes>;

  std::size_t index(const std::size_t element, const std::size_t k, const std::size_t n) const {
    return (element / n_lanes_ * n + k) * n_lanes_ + element % n_lanes_;
  }
  double &constant(const std::size_t element, const std::size_t k) {
    return constants_[index(element, k, layout_.n_constants)];
  }
  double &history(const std::size_t element, const std::size_t k) {
    return history_[index(element, k, layout_.n_history)];
  }
  double constant(const std::size_t element, const std::size_t k) const {
    return constants_[index(element, k, layout_.n_constants)];
  }
  double history(const std::size_t element, const std::size_t k) const {
    return history_[index(element, k, layout_.n_history)];
  }
  /// The lanes beyond the last element repeat it.
  void repeat_last(std::size_t element);
  /// Calls visit(place of its history, its reference volume, J̄ of mean dilatation or J, ∂x/∂ξ up to a factor)
  /// for each point; for none where the element is inverted.
  template <class Visit>
  void visit_points(std::size_t element, const double *displacements, const Visit &visit) const;
  ElementVectors gather(std::size_t element, const double *values) const;
  void resize(std::size_t n_elements);
  bool initialize_element(std::size_t element, const explicit_kernels::Material &material,
                          double yield_stress);
  void initialize_point(std::size_t element, std::size_t first, const dealii::Tensor<2, 3> &inverse_jacobian,
                        double yield_stress);

  unsigned int n_lanes_;
  ExplicitFormulation formulation_;
  bool has_plasticity_, keeps_yield_stress_;
  explicit_kernels::Layout layout_;
  std::size_t n_elements_ = 0;
  std::vector<double> density_factors_; ///< of the elements
  dealii::AlignedVector<std::uint32_t> nodes_;
  dealii::AlignedVector<double> reference_positions_, constants_, history_;
};

} // namespace billet

#endif
