// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_FIELD_QUANTITY_H
#define BILLET_OUTPUT_FIELD_QUANTITY_H

#include "billet/material/state_fields.h"
#include "billet/mechanics/sheet_strains.h"
#include "billet/solve/solution.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace billet {

/// Averages over the integration points of an element, or of one of its layers.
struct ElementAverage {
  std::size_t body;
  dealii::SymmetricTensor<2, 3> cauchy_stress; ///< [stress]
  double equivalent_plastic_strain;
  /// Averages of the law's state; without numbers unless a quantity reads it.
  StateAverage state;
  dealii::Tensor<2, 3> deformation_gradient = {}; ///< mean over the undeformed element
  std::size_t material = 0;                       ///< number of the body's material
  double mesh_error = 0.;                         ///< from MeshErrors::of_element()
  SheetStrains sheet = {};                        ///< 0 unless the scene writes them
  /// Major strain at its minor one; 0: the material has none.
  double forming_limit = 0.;
};

/// Quantity that is constant in an element: a scalar, or the components of a vector or tensor. Six
/// components whose names end with _xx, _yy, _zz, _xy, _xz and _yz become one tensor in the files,
/// see join_components().
struct ElementQuantity {
  std::string name;                    ///< name in the manual
  std::string unit;                    ///< of all components; empty if they have none
  std::vector<std::string> components; ///< their names in files
  bool has_layers; ///< whether it follows from integration points, so that layers have it, too
  std::function<bool(const Scene &)> is_written;
  /// Returns one value for each component.
  std::function<std::vector<double>(const ElementAverage &)> evaluate;
  bool reads_state = false; ///< whether it follows from ElementAverage::state
  /// Whether it numbers things: written as an integer, and never averaged.
  bool is_number = false;
};

/// Vector, or three scalars, at the nodes.
struct NodalField {
  std::array<std::string, 3> components; ///< their names in files; those of a vector are the same
  bool is_vector;
  Vector values; ///< ghosted, three at each node
};

/// Quantity at the nodes.
struct NodalQuantity {
  std::string name; ///< name in the manual
  std::string unit; ///< empty if there is none, or if its components have different ones
  /// Returns its fields; none if the scene does not have it or does not request it. Collective.
  std::function<std::vector<NodalField>(const Scene &, const Discretization &, const Solution &)> evaluate;
};

/// Quantities of field output, in the order of the files. A new one is a file in
/// source/output/fields/ with a function that returns it, and its name in the table of
/// field_quantity.cc. Outside the library, it is one call of add() before fields are written.
class FieldQuantities {
public:
  FieldQuantities(const std::vector<NodalQuantity> &nodal, const std::vector<ElementQuantity> &of_elements);

  /// Adds a quantity. Throws std::logic_error if its name, or the name of a component, is taken.
  void add(const NodalQuantity &quantity);
  void add(const ElementQuantity &quantity);

  const std::vector<NodalQuantity> &nodal() const { return nodal_; }
  const std::vector<ElementQuantity> &of_elements() const { return of_elements_; }

private:
  void check_new(const std::string &name) const;

  std::vector<NodalQuantity> nodal_;
  std::vector<ElementQuantity> of_elements_;
};

FieldQuantities &field_quantities();

/// Returns one quantity for each of the laws' state fields that the scene requests.
std::vector<ElementQuantity> state_quantities(const Scene &scene);

} // namespace billet

#endif
