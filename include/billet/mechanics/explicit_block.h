// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_BLOCK_H
#define BILLET_MECHANICS_EXPLICIT_BLOCK_H

#include "billet/mechanics/element_block.h"
#include "billet/mechanics/kernel_choice.h"

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace billet {

/// Returns the widest instruction set that was compiled and that this processor supports.
InstructionSet best_instruction_set();

/// Whether it was compiled and this processor supports it.
bool is_available(InstructionSet instructions);

/// Element formulation of a body in explicit dynamics.
struct ExplicitFormulation {
  using Element = ElementFormulation::Element;

  Element element = Element::assumed_strain;
  double linear_viscosity = 0.06;   ///< c_1 of the bulk viscosity ρ L (c_1 c |d| + c_2² L d²); ≥ 0
  double quadratic_viscosity = 1.2; ///< c_2, acts in compression only; ≥ 0
  InstructionSet instructions = InstructionSet::automatic;
  /// Float computes twice as many elements at once.
  NumberType number_type = NumberType::double_precision;
  std::vector<double> constants; ///< ElementChoice::constants
};

/// Element that was divided into eight, of which `child` is one.
struct ParentElement {
  ElementVectors positions; ///< of its undeformed nodes [length]
  const double *state;      ///< from ExplicitBlock::get_state()
  unsigned int child;       ///< number of the child, in deal.II's order
};

/// All elements of one body on one rank, for central differences. An explicit step is never
/// repeated: history advances in place, in one stage. Elements are stored in batches as wide as the
/// instruction set; nodal sums are accumulated in the order of the elements.
class ExplicitBlock {
public:
  static constexpr unsigned int renewal_interval = 1000; ///< number of steps, see renew()

  virtual ~ExplicitBlock() = default;

  /// Sets the elements. `elements` holds local node indices in lexicographic order (ξ fastest),
  /// `reference_positions` three coordinates of each node at stride 4 [length]. Returns false, with
  /// the index of the first such element, if one is degenerate or inverted.
  virtual bool initialize(const std::vector<std::array<unsigned int, n_element_nodes>> &elements,
                          const double *reference_positions, std::size_t &offender) = 0;

  virtual std::size_t size() const = 0;

  /// Scales the density of each element whose stable step, undeformed and at rest, is shorter than
  /// `min_step` [time], so that it is not shorter. Call it after initialize() and before advance().
  /// Returns the added mass [mass].
  virtual double scale_mass(double min_step) = 0;

  /// Nodal vectors, x, y, z and an unused number for each node, 32-byte aligned.
  struct Nodes {
    const double *displacements; ///< [length]
    const double *velocities;    ///< mean of the step: (displacements − those of the last call)/dt
    double *forces;              ///< [force]
  };

  struct StepResult {
    double stable_step;    ///< stable for every element, including viscosity [time]
    double elastic_energy; ///< current, without the stabilisation's [energy]
    /// In this step [energy]: mean of both ends' yield stress times the plastic strain. If the flow
    /// stress has a state, as with a rate factor, it is what that says.
    double plastic_work;
    /// Dissipated by bulk viscosity in this step [energy]: ½ (q_{n−1} + q_n) ΔV, by the trapezoidal
    /// rule, as for all works. It can be negative for a step in which the rate changes sign. The
    /// sum over equal steps from rest is non-negative if viscosity is linear.
    double viscous_work;
    double hourglass_energy; ///< currently stored by the stabilisation [energy]
    std::size_t inverted;    ///< index of an element with det F ≤ 0 or not finite, or size()
  };

  /// Sets the temperature of the next call, see PointStep. Laws of the kernels do not depend on it.
  virtual void set_temperature(double /*temperature*/) {}

  /// Subtracts internal and viscous forces at these displacements from `forces`. Advances the
  /// history by dt, the time since the last call (0 in the first). After an inverted element,
  /// forces and history are invalid.
  virtual StepResult advance(const Nodes &nodes, double dt) = 0;

  /// Removes the round-off that float kernels accumulate by adding strains step by step. It
  /// recomputes in double the strains that follow from the displacements alone (of elastic
  /// elements, and of the volume). Call it after advance(), at the same displacements, every
  /// `renewal_interval` steps. It has no effect in double.
  virtual void renew(const double *displacements) = 0;

  /// Adds the lumped masses ρ ∫ N_a, all positive, one number for each node, including the mass
  /// added by scale_mass().
  virtual void add_masses(double *masses) const = 0;

  /// Returns averages and integrals at the displacements of the last call.
  virtual ElementSummary summarize(std::size_t element, const double *displacements) const = 0;

  /// Returns the number of history values per element.
  virtual std::size_t history_size() const = 0;
  /// Return the memory of the history of all elements, and the part of history and constants used
  /// by the stabilisation of one-point elements [bytes].
  virtual std::size_t history_memory() const = 0;
  virtual std::size_t stabilisation_memory() const = 0;

  // For checkpoints: an element's history_size() numbers, after advance().
  virtual void get_state(std::size_t element, double *state) const = 0;
  virtual void set_state(std::size_t element, const double *state) = 0;

  // To continue from the results of another formulation:
  /// Returns the stress at the displacements of the last call; for a one-point element, eight equal
  /// values.
  virtual ElementStress compute_stress(std::size_t element, const double *displacements) const = 0;
  /// Sets the history for which these displacements have this stress, or its mean if there is one
  /// point. Call it after initialize(). Without plasticity the stress follows from the
  /// displacements alone, unless the law is hypoelastic.
  virtual void set_stress(std::size_t element, const double *displacements, const ElementStress &stress) = 0;

  // To find the law's state by the names of its fields:
  /// Returns where the numbers of get_state() have it; no points for kernels, which store what they
  /// need.
  virtual PointStates point_states() const = 0;
  /// Returns averages over the reference volume at the displacements of the last call. Kernels find
  /// the state by PointLaw::set_stress().
  virtual StateAverages average_states(std::size_t element, const double *displacements) const = 0;

  // To continue on a finer mesh:
  /// Sets the history of one of the eight elements into which `parent` was divided, (R4) and (R5)
  /// of doc/theory. `displacements`: those of the last call. Call it after initialize().
  virtual void set_parent_state(std::size_t element, const ParentElement &parent,
                                const double *displacements) = 0;
};

/// Whether the kernels compute this element with this law; other ones are computed one by one, in
/// double only.
bool has_kernel(const BrickElement &element, const PointLaw &law);

/// Makes the block; `density` is per reference volume. Throws std::invalid_argument, with the
/// reason, for an unavailable instruction set and for numbers out of range. Every element supports
/// every law: if the kernels do not have the law, ElementwiseBlock computes the elements one by
/// one, in double only.
std::unique_ptr<ExplicitBlock> make_explicit_block(const std::shared_ptr<const PointLaw> &law, double density,
                                                   const ExplicitFormulation &formulation);

} // namespace billet

#endif
