// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_MESH_ERRORS_H
#define BILLET_SOLVE_MESH_ERRORS_H

#include "billet/solve/solution.h"
#include "billet/state.h"

#include <vector>

namespace billet {

/// Estimates the error that the size of the elements makes in the forces, (W4) and (W5) of doc/theory.md. On
/// the exact solution tractions pass from element to element without a jump. The jumps, and how easily the
/// elements deform, yield the work that finer elements would save; over the work of deformation, this is the
/// relative error of the forces that do it, ∫|F − F*| ds over ∫|F| ds. It is no bound: elements much larger
/// than what they resolve hide their error, and the error of curved boundaries is not in it.
class MeshErrors {
public:
  explicit MeshErrors(const Discretization &discretization);

  /// Adds the deformation since the last call; the first one begins. Collective.
  void add(const Solution &solution);

  /// Whether add() has been called.
  bool has_begun() const { return has_begun_; }
  /// Whether there has been any work of deformation to normalise errors by.
  bool is_known() const { return work_ > 0.; }
  /// Returns the relative error so far; 0 if it is unknown.
  double error() const;
  /// Returns the part of it that each body makes.
  std::vector<double> of_bodies() const;
  /// Returns an owned element's error so far, per volume, over the work per volume of all bodies: its mean
  /// over the undeformed volume is the relative error.
  double of_element(std::size_t body, std::size_t element) const;

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  using Stress = dealii::SymmetricTensor<2, 3>;
  /// Owned element, from interval to interval.
  struct OwnedElement {
    Stress stress{};                ///< at the end of the last interval [stress]
    ElementVectors displacements{}; ///< at that time [length]
    double error = 0.;              ///< work that finer elements would save so far [energy]
  };
  /// Element in an interval.
  struct Interval {
    Stress stress{};    ///< mean [stress]
    double volume = 0.; ///< in the middle of the interval [length³]
    double strain = 0.; ///< equivalent strain of the interval
    double work = 0.;   ///< of deformation [energy]
  };

  /// Returns one of the eight parts of an element.
  static OwnedElement part_of(const OwnedElement &element, unsigned int child);
  static Interval compare(const ElementVectors &positions, const OwnedElement &before, const Stress &stress,
                          const ElementVectors &displacements);
  /// Computes the interval of the owned elements, and gets that of the ghost elements. By active cell index.
  std::vector<Interval> compare_all(const Solution &solution,
                                    const std::vector<std::vector<Stress>> &stresses);
  /// Returns the work that finer elements would save at an owned element in an interval, (W4).
  static double saved_work(const CellIterator &cell, const ElementVectors &positions,
                           const std::vector<Interval> &intervals);

  const Discretization &discretization_;
  bool has_begun_ = false;
  std::vector<std::vector<OwnedElement>> elements_; ///< by body
  std::vector<double> errors_;                      ///< by body, of all ranks [energy]
  double work_ = 0.;                                ///< ∫|dW| of all elements of all ranks [energy]
  double volume_ = 0.;                              ///< of all undeformed bodies [length³]
};

} // namespace billet

#endif
