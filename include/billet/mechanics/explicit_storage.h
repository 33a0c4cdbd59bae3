// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_STORAGE_H
#define BILLET_MECHANICS_EXPLICIT_STORAGE_H

#include "billet/mechanics/explicit/kernel.h"
#include "billet/mechanics/explicit_block.h"
#include "billet/mechanics/modal_geometry.h"

#include <deal.II/base/aligned_vector.h>

namespace billet {

/// The order of the six numbers of a symmetric tensor in kernels.
constexpr unsigned int symmetric_pairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

/// What kernels count in. In double that is what the user counts in; in float powers of two next to the
/// elements' size, the modulus and the density, so that no product leaves the range of a float, and that no
/// rounding depends on them.
struct KernelUnits {
  double length = 1., stress = 1., density = 1., time = 1.;

  double force() const { return stress * length * length; }
  double energy() const { return stress * length * length * length; }
};

/// For floats: density and stress have an even power of two between them, so that the time is one, too.
KernelUnits choose_units(double length, double stress, double density);

/// State at a point of an element, from its history.
struct PointState {
  double reference_volume; ///< its share of the element's
  double volume_ratio;     ///< J̄ of eight points, J of the one-point element
  /// dev τ where the law is hypoelastic, else b_e up to a factor
  dealii::SymmetricTensor<2, 3> tensor;
  double equivalent_plastic_strain;
};

/// The numbers that kernels read and write: laid out in batches, filled in the beginning, read for output.
/// `Number`: double or float.
template <class Number> class ExplicitStorage {
public:
  ExplicitStorage(unsigned int n_lanes, const ElasticModuli &elastic, LaneLaw law, LaneElement element,
                  bool has_plasticity, bool keeps_yield_stress);

  /// See ExplicitBlock::initialize(). `yield_stress`: the initial one, used if it is kept.
  /// Numbers are stored in `units`, in which kernels count; all arguments and results are in the user's.
  bool initialize(const std::vector<std::array<unsigned int, n_element_nodes>> &elements,
                  const double *reference_positions, const KernelUnits &units, double density,
                  double yield_stress, std::size_t &offender);

  /// See ExplicitBlock::renew(); from the start, what plasticity has not yet changed too.
  void renew(const double *displacements, bool from_the_start);

  std::size_t size() const { return n_elements_; }
  /// Numbers that a one-point element has for its stabilisation: ĥ, the metric, two bounds, and in float
  /// the modes b and c.
  std::size_t stabilisation_size() const { return 12 + 6 + 2 + (is_single ? 12 : 0); }
  const explicit_kernels::Layout &layout() const { return layout_; }
  explicit_kernels::BasicElements<Number> elements();

  /// One element in all lanes of a batch of its own.
  struct Copy {
    dealii::AlignedVector<std::uint32_t> nodes;
    dealii::AlignedVector<Number> constants, history;
  };
  /// The numbers stand in `copy`, made anew.
  explicit_kernels::BasicElements<Number> copy_element(std::size_t element, Copy &copy) const;
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
  static constexpr bool is_single = sizeof(Number) == sizeof(float);
  using NodalMasses = std::array<double, n_element_nodes>;

  std::size_t index(const std::size_t element, const std::size_t k, const std::size_t n) const {
    return (element / n_lanes_ * n + k) * n_lanes_ + element % n_lanes_;
  }
  double constant(const std::size_t element, const std::size_t k) const {
    return constants_[index(element, k, layout_.n_constants)];
  }
  double history(const std::size_t element, const std::size_t k) const {
    return history_units_[k] * history_[index(element, k, layout_.n_history)];
  }
  void set_constant(const std::size_t element, const std::size_t k, const double value) {
    constants_[index(element, k, layout_.n_constants)] = static_cast<Number>(value);
  }
  void set_history(const std::size_t element, const std::size_t k, const double value) {
    history_[index(element, k, layout_.n_history)] = static_cast<Number>(value / history_units_[k]);
  }
  /// The lanes beyond the last element repeat it.
  void repeat_last(std::size_t element);
  /// Calls visit(place of its history, its reference volume, J̄ of eight points or J, ∂x/∂ξ up to a factor,
  /// ∂ξ/∂X) for each point; for none where the element is inverted.
  template <class Visit>
  void visit_points(std::size_t element, const double *displacements, const Visit &visit) const;
  ElementVectors gather(std::size_t element, const double *values) const;
  void resize(std::size_t n_elements);
  bool initialize_element(std::size_t element, double density, double yield_stress);
  /// Of elements with the mean gradient: what they have in common, then their own. `lambda`: a bound of
  /// stiffness over modulus. False if the element is degenerate.
  bool initialize_mean_gradient(std::size_t element, const ElementVectors &positions, double smallest_mass,
                                double yield_stress, double &lambda);
  void initialize_one_point(std::size_t element, const ModalGeometry &geometry,
                            const dealii::Tensor<2, 3> &inverse);
  void initialize_assumed_strain(std::size_t element, const ModalGeometry &geometry,
                                 const dealii::Tensor<2, 3> &inverse);
  void set_modes(std::size_t element, std::size_t first, const ModalGeometry &geometry);
  /// What the stabilisation of a one-point element holds becomes that of the displacements, in float; or
  /// nothing.
  void set_hourglass(std::size_t element, const double *displacements, const dealii::Tensor<2, 3> &jacobian,
                     bool is_forgotten);
  void set_alpha(std::size_t element, std::size_t &k, double alpha);
  /// Units of the numbers of an element's history.
  void set_history_units();
  bool is_rate() const { return law_ == LaneLaw::hypoelastic; }
  void initialize_point(std::size_t element, std::size_t first, const dealii::Tensor<2, 3> &inverse_jacobian,
                        double yield_stress);

  unsigned int n_lanes_;
  ElasticModuli elastic_;
  LaneLaw law_;
  LaneElement element_;
  bool has_plasticity_, keeps_yield_stress_;
  KernelUnits units_;
  explicit_kernels::Layout layout_;
  std::size_t first_point_, n_tensor_; ///< in the history; of a point's numbers
  std::vector<double> history_units_;
  std::size_t n_elements_ = 0;
  std::vector<double> density_factors_; ///< of the elements
  dealii::AlignedVector<std::uint32_t> nodes_;
  dealii::AlignedVector<double> reference_positions_;
  dealii::AlignedVector<Number> constants_, history_;
};

} // namespace billet

#endif
