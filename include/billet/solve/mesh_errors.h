// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_MESH_ERRORS_H
#define BILLET_SOLVE_MESH_ERRORS_H

#include "billet/scene/scene.h"
#include "billet/solve/solution.h"
#include "billet/state.h"

#include <array>
#include <vector>

namespace billet {

/// Estimates the error that the size of the elements makes in the forces, (W4) and (W5) of
/// doc/theory.md. On the exact solution tractions pass from element to element without a jump. The
/// jumps, and how easily the elements deform, yield the work that finer elements would save. Over
/// the work of deformation, this is the relative error of the forces that do it, ∫|F − F*| ds over
/// ∫|F| ds.
///
/// It is no bound: elements much larger than what they resolve hide their error. The error of flat
/// facets in place of curved surfaces is apart, (W8).
class MeshErrors {
public:
  /// Collective.
  MeshErrors(const Scene &scene, const Discretization &discretization);

  /// Adds a state; the first one begins. An interval of (W4) reaches over the states until one that
  /// ends it. It has their mean stresses, so that waves in opposite directions in it cancel.
  /// Collective.
  void add(const Solution &solution, bool ends_interval = true);

  /// Whether add() has been called.
  bool has_begun() const { return has_begun_; }
  /// Whether there has been any work of deformation to normalise errors by.
  bool is_known() const { return work_ > 0.; }
  /// Returns the relative error so far; 0 if it is unknown.
  double error() const;
  /// Returns the part of it that each body makes.
  std::vector<double> of_bodies() const;
  /// Whether the jumps can tell the error, (W9). They cannot if much of the strain varies within
  /// elements that have no neighbour on either side. Examples are those of a wall of one element
  /// that bends, or of a bar of two by two that is twisted. Nor can they where supports hold all
  /// nodes of an element, as in a bonded layer of one element.
  bool sees_variation() const;
  /// Returns the relative error of the geometry, (W8). It is the part of the work of deformation
  /// that the space between the facets and the smooth surfaces would do. The space is assumed to
  /// deform as the elements at the facets do.
  double geometry_error() const;
  /// Returns the part of it that each body makes.
  std::vector<double> geometry_of_bodies() const;
  /// Returns an owned element's error so far, per volume, over the work per volume of all bodies.
  /// Its mean over the undeformed volume is the relative error.
  double of_element(std::size_t body, std::size_t element) const;

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  using Stress = dealii::SymmetricTensor<2, 3>;
  /// Owned element, from interval to interval.
  struct OwnedElement {
    Stress stress{};                ///< of the last state [stress]
    Stress stress_sum{};            ///< over the states of the interval, its ends by half [stress]
    ElementVectors displacements{}; ///< at the start of the interval [length]
    double error = 0.;              ///< work that finer elements would save so far [energy]
    /// Volume between its facets and the smooth surface, over its own.
    double outside = 0.;
    /// Whether jumps do not tell what varies in each of its own directions. It has no neighbour on
    /// either side there, or is one of two by two in the section of a bar.
    std::array<bool, 3> is_unseen{};
    bool is_fixed = false; ///< whether supports hold all of its nodes
  };
  /// Element in an interval.
  struct Interval {
    Stress stress{};    ///< mean [stress]
    double volume = 0.; ///< in the middle of the interval [length³]
    double strain = 0.; ///< equivalent strain of the interval
    double work = 0.;   ///< of deformation [energy]
    /// Integral of the squared strain, and its part that no jump can tell, (W9) [length³].
    double squared_strain = 0., unseen = 0.;
  };

  /// Returns one of the eight parts of an element.
  static OwnedElement part_of(const OwnedElement &element, unsigned int child);
  Interval compare(const ElementVectors &positions, const OwnedElement &element,
                   const ElementVectors &displacements) const;
  /// Computes the interval of the owned elements, and gets that of the ghost elements. By active
  /// cell index.
  std::vector<Interval> compare_all(const Solution &solution);
  /// Compares the facets of each element with the smooth surface.
  void measure_facets();
  /// Finds the directions of elements in which variation is unseen.
  void find_unseen(const Scene &scene);
  /// Adds the errors of the interval that ends.
  void add_interval(const Solution &solution);
  /// Returns the work that finer elements would save at an owned element in an interval, (W4).
  static double saved_work(const CellIterator &cell, const ElementVectors &positions,
                           const std::vector<Interval> &intervals);

  const Discretization &discretization_;
  bool has_begun_ = false;
  /// Number in the interval so far, without that at its start.
  unsigned int n_states_ = 0;
  std::vector<std::vector<OwnedElement>> elements_; ///< by body
  std::vector<double> errors_;                      ///< by body, of all ranks [energy]
  double work_ = 0.;                                ///< ∫|dW| of all elements of all ranks [energy]
  /// Work of the space beyond the facets, by body.
  std::vector<double> work_outside_;
  double squared_strain_ = 0., unseen_ = 0.; ///< see Interval, of all elements of all ranks
  double volume_ = 0.;                       ///< of all undeformed bodies [length³]
};

} // namespace billet

#endif
