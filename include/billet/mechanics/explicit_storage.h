// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_STORAGE_H
#define BILLET_MECHANICS_EXPLICIT_STORAGE_H

#include "billet/mechanics/explicit/kernel.h"
#include "billet/mechanics/explicit_block.h"
#include "billet/mechanics/modal_geometry.h"

#include <deal.II/base/aligned_vector.h>

namespace billet {

/// Index pairs of the six components of a symmetric tensor in kernels.
constexpr unsigned int symmetric_pairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

/// Units of the kernels' numbers. In double they are the user's units. In float they are powers of
/// two close to the elements' size, the modulus and the density. So no product leaves the range of
/// a float, and rounding does not depend on the units.
struct KernelUnits {
  double length = 1., stress = 1., density = 1., time = 1.;

  double force() const { return stress * length * length; }
  double energy() const { return stress * length * length * length; }
};

/// Chooses units for floats. The ratio of density and stress is an even power of two, so that the
/// unit of time is a power of two as well.
KernelUnits choose_units(double length, double stress, double density);

/// Numbers that a point stores beside its tensor. With plasticity these are α, σ_y(α) unless
/// hardening is linear, and the state of the flow stress.
struct PlasticNumbers {
  bool has_alpha = false, has_yield_stress = false;
  std::size_t n_state = 0;
};

/// State at a point of an element, from its history.
struct PointState {
  double reference_volume; ///< share of the element's reference volume
  double volume_ratio;     ///< J̄ with eight points, J of the one-point element
  /// dev τ if the law is hypoelastic, otherwise b_e up to a factor
  dealii::SymmetricTensor<2, 3> tensor;
  double equivalent_plastic_strain;
  dealii::Tensor<2, 3> F = {};   ///< F̄ of eight points with mean dilatation
  FlowStress::State flow = {{}}; ///< state of the flow stress
};

/// Storage of the numbers that kernels read and write, laid out in batches. `Number` is double or
/// float.
template <class Number> class ExplicitStorage {
public:
  ExplicitStorage(unsigned int n_lanes, const ElasticModuli &elastic, LaneLaw law, LaneElement element,
                  const PlasticNumbers &plastic);

  /// Initializes the storage, see ExplicitBlock::initialize(). `yield_stress` is the initial one,
  /// used if it is stored. Numbers are stored in `units`, those of the kernels; all arguments and
  /// results are in the user's units.
  bool initialize(const std::vector<std::array<unsigned int, n_element_nodes>> &elements,
                  const double *reference_positions, const KernelUnits &units, double density,
                  double yield_stress, std::size_t &offender);

  /// Removes round-off, see ExplicitBlock::renew(). With `from_the_start`, this includes strains
  /// that plasticity has not yet changed.
  void renew(const double *displacements, bool from_the_start);

  std::size_t size() const { return n_elements_; }
  /// Returns the count of points of an element that have a history.
  std::size_t n_points() const { return (layout_.n_history - first_point_) / layout_.n_point_history; }
  /// Returns the count of numbers that an element stores for its stabilisation. A one-point element
  /// stores ĥ, the metric, two bounds, and in float the modes b and c; the others have none.
  std::size_t stabilisation_size() const {
    return element_ == LaneElement::one_point ? 12 + 6 + 2 + (is_single ? 12 : 0) : 0;
  }
  const explicit_kernels::Layout &layout() const { return layout_; }
  explicit_kernels::BasicElements<Number> elements();

  /// Batch that holds one element in all lanes.
  struct Copy {
    dealii::AlignedVector<std::uint32_t> nodes;
    dealii::AlignedVector<Number> constants, history;
  };
  /// Copies one element; its numbers are stored in `copy`, which is overwritten.
  explicit_kernels::BasicElements<Number> copy_element(std::size_t element, Copy &copy) const;
  /// Returns the size of a nodal vector over the nodes of the elements, at stride 4.
  std::size_t nodal_size() const { return reference_positions_.size(); }

  /// Multiplies the density of one element. Returns the reference volume that corresponds to the
  /// added mass.
  double scale_mass(std::size_t element, double factor);

  void add_masses(double density, double *masses) const;

  /// Returns the states of the eight points, or of the one; empty if the element is inverted.
  std::vector<PointState> compute_states(std::size_t element, const double *displacements) const;
  /// Sets the states, the inverse of compute_states(): it reads the tensor and plastic data of each
  /// state; b_e has determinant 1. `yield_stress` holds one value per state, used if it is stored.
  /// A one-point element with plasticity also resets the energy of its stabilisation.
  void set_states(std::size_t element, const double *displacements, const std::vector<PointState> &states,
                  const std::vector<double> &yield_stress);

  void get_history(std::size_t element, double *numbers) const;
  void set_history(std::size_t element, const double *numbers);
  /// Sets the history of a part of an element, see ExplicitBlock::set_parent_state().
  void set_parent_history(std::size_t element, const ParentElement &parent, const double *displacements);

private:
  static constexpr bool is_single = sizeof(Number) == sizeof(float);
  static constexpr std::size_t n_parts = is_single ? 2 : 1; ///< of α and of the flow stress' state
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
  /// Fills the lanes beyond the last element with copies of it.
  void repeat_last(std::size_t element);
  /// Calls visit() for each point, for none if the element is inverted. The arguments are the
  /// position of its history, its reference volume, J̄ of eight points or J, ∂x/∂ξ up to a factor,
  /// and ∂ξ/∂X.
  template <class Visit>
  void visit_points(std::size_t element, const double *displacements, const Visit &visit) const;
  ElementVectors gather(std::size_t element, const double *values) const;
  /// Returns ∂ξ/∂X, up to the same factor as in visit_points(), at a point of an undeformed brick.
  dealii::Tensor<2, 3> inverse_reference(const ElementVectors &positions, unsigned int point) const;
  /// Sets the hourglass strains of a part of an element without those that displacements alone
  /// determine.
  void set_parent_hourglass(std::size_t element, const ParentElement &parent);
  void resize(std::size_t n_elements);
  bool initialize_element(std::size_t element, double density, double yield_stress);
  /// Initializes an element with the mean gradient: first the common data, then those of its kind.
  /// `lambda` becomes a bound of stiffness over modulus. Returns false if the element is
  /// degenerate.
  bool initialize_mean_gradient(std::size_t element, const ElementVectors &positions, double min_mass,
                                double yield_stress, double &lambda);
  void initialize_one_point(std::size_t element, const ModalGeometry &geometry,
                            const dealii::Tensor<2, 3> &inverse);
  void initialize_assumed_strain(std::size_t element, const ModalGeometry &geometry,
                                 const dealii::Tensor<2, 3> &inverse);
  void set_modes(std::size_t element, std::size_t first, const ModalGeometry &geometry);
  /// Sets the hourglass strains of a one-point element to those of the displacements, in float; or
  /// to zero if `is_forgotten`.
  void set_hourglass(std::size_t element, const double *displacements, const dealii::Tensor<2, 3> &jacobian,
                     bool is_forgotten);
  /// Set and get a number that floats store in two parts, and advance its place.
  void set_in_parts(std::size_t element, std::size_t &k, double value);
  double get_in_parts(std::size_t element, std::size_t &k) const;
  /// Sets the units of the numbers of an element's history.
  void set_history_units();
  bool is_rate() const { return law_ == LaneLaw::hypoelastic; }
  void initialize_point(std::size_t element, std::size_t first, const dealii::Tensor<2, 3> &inverse_jacobian,
                        double yield_stress);

  unsigned int n_lanes_;
  ElasticModuli elastic_;
  LaneLaw law_;
  LaneElement element_;
  PlasticNumbers plastic_;
  KernelUnits units_;
  explicit_kernels::Layout layout_;
  std::size_t first_point_, n_tensor_; ///< position in the history; size of a point's tensor
  std::vector<double> history_units_;
  std::size_t n_elements_ = 0;
  std::vector<double> density_factors_; ///< one per element
  dealii::AlignedVector<std::uint32_t> nodes_;
  dealii::AlignedVector<double> reference_positions_;
  dealii::AlignedVector<Number> constants_, history_;
};

} // namespace billet

#endif
