// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_BLOCK_H
#define BILLET_MECHANICS_EXPLICIT_BLOCK_H

#include "billet/mechanics/element_block.h"

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace billet {

/// What a kernel is compiled for: 1, 2, 4 or 8 elements at once, in float 1, 4, 8 or 16. `automatic` is the
/// widest that the processor knows.
enum class InstructionSet { automatic, scalar, sse2, avx2, avx512 };

/// The widest instruction set that was compiled and that this processor has.
InstructionSet best_instruction_set();

/// Whether it was compiled and this processor has it.
bool is_available(InstructionSet instructions);

/// How the elements of a body are computed in explicit dynamics.
struct ExplicitFormulation {
  using Element = ElementFormulation::Element;
  /// What elements are computed with; nodal vectors and all sums are double.
  enum class NumberType { double_precision, float_precision };

  Element element = Element::assumed_strain;
  double linear_viscosity = 0.06;   ///< c_1 of the bulk viscosity ρ L (c_1 c |d| + c_2² L d²); ≥ 0
  double quadratic_viscosity = 1.2; ///< c_2 of it, acts in compression only; ≥ 0
  InstructionSet instructions = InstructionSet::automatic;
  NumberType number_type = NumberType::double_precision; ///< in float twice as many elements at once
};

/// All elements of one body on one rank, for central differences. An explicit step is never taken back:
/// history advances in place, one beat only. Internally elements stand in batches as wide as the instruction
/// set; sums over the nodes are made in the order of the elements.
class ExplicitBlock {
public:
  static constexpr unsigned int renewal_interval = 1000; ///< of steps, see renew()

  virtual ~ExplicitBlock() = default;

  /// `elements` holds local node indices in lexicographic order (ξ fastest), `reference_positions` three
  /// coordinates of each node at stride 4 [length]. False, with the index of the first offender, if an
  /// element is degenerate or inverted.
  virtual bool initialize(const std::vector<std::array<unsigned int, n_element_nodes>> &elements,
                          const double *reference_positions, std::size_t &offender) = 0;

  virtual std::size_t size() const = 0;

  /// Multiplies the density of each element whose stable step, undeformed and at rest, is shorter than
  /// `smallest_step` [time], so that it is not. After initialize(), before advance(). Returns the mass that
  /// it adds [mass].
  virtual double scale_mass(double smallest_step) = 0;

  /// Nodal vectors, x, y, z and an unused number for each node, 32-byte aligned.
  struct Nodes {
    const double *displacements; ///< [length]
    const double *velocities;    ///< mean of the step: (displacements − those of the last call)/dt
    double *forces;              ///< [force]
  };

  struct StepResult {
    double stable_step;    ///< safe for every element, viscosity counted [time]
    double elastic_energy; ///< now, but for the stabilisation's [energy]
    double plastic_work; ///< in this step: mean of both ends' yield stress times the plastic strain [energy]
    /// Dissipated by bulk viscosity in this step [energy]: ½ (q_{n−1} + q_n) ΔV, as the trapezoidal rule
    /// books all works. Where the rate has just changed its sign it can be negative for a step; the sum over
    /// equal steps from rest is not, if viscosity is linear.
    double viscous_work;
    double hourglass_energy; ///< stored by the stabilisation now [energy]
    std::size_t inverted;    ///< an element with det F ≤ 0 or not finite, or size()
  };

  /// Subtracts internal and viscous forces at these displacements from `forces` and advances the history by
  /// dt, the time since the last call (0 in the first). After an inverted element was found forces and
  /// history are of no more use.
  virtual StepResult advance(const Nodes &nodes, double dt) = 0;

  /// Kernels in float add up strains step by step. Of those that follow from the displacements alone (of
  /// elastic elements, of the volume) this takes away what the steps have rounded: it computes them in
  /// double. After advance(), at the same displacements, every `renewal_interval` steps. In double without
  /// effect.
  virtual void renew(const double *displacements) = 0;

  /// Adds the lumped masses ρ ∫ N_a, all positive, one number for each node. With those added by
  /// scale_mass().
  virtual void add_masses(double *masses) const = 0;

  /// At the displacements of the last call.
  virtual ElementSummary summarize(std::size_t element, const double *displacements) const = 0;

  /// Numbers of history kept per element.
  virtual std::size_t history_size() const = 0;
  /// What they take for all elements, and what of them and of the constants one-point elements have for their
  /// stabilisation [bytes].
  virtual std::size_t history_memory() const = 0;
  virtual std::size_t stabilisation_memory() const = 0;

  // For checkpoints: an element's history_size() numbers, after advance().
  virtual void get_state(std::size_t element, double *state) const = 0;
  virtual void set_state(std::size_t element, const double *state) = 0;

  // To go on with what another formulation has computed:
  /// At the displacements of the last call; of a one-point element eight times the same.
  virtual ElementStress compute_stress(std::size_t element, const double *displacements) const = 0;
  /// After initialize(). Makes the history the one which, at these displacements, has this stress, or its
  /// mean where there is one point; without plasticity it follows from the displacements alone, unless the
  /// law is hypoelastic.
  virtual void set_stress(std::size_t element, const double *displacements, const ElementStress &stress) = 0;
};

/// What a history means: element, elasticity and type of number in words.
std::string describe(const ExplicitFormulation &formulation, const PointLaw &law);

/// `density` is per reference volume. Throws std::invalid_argument, with the reason, for an instruction set
/// that is not available and for numbers out of range. Every element goes with every law: where the kernels
/// do not have the law, elements are computed one by one, by ElementwiseBlock, which is in double alone.
std::unique_ptr<ExplicitBlock> make_explicit_block(const std::shared_ptr<const PointLaw> &law, double density,
                                                   const ExplicitFormulation &formulation);

} // namespace billet

#endif
