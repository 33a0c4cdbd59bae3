// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_STATE_FIELDS_H
#define BILLET_MATERIAL_STATE_FIELDS_H

#include "billet/material/point_law.h"

#include <string>
#include <vector>

namespace billet {

/// Name of the field of a flow stress' state.
inline constexpr const char *flow_state_name = "flow stress history";

/// Returns a field of 6 numbers in the order of SymmetricTensor::access_raw_entry().
StateField symmetric_field(std::string name);
/// Returns a field of 9 numbers, row by row.
StateField tensor_field(std::string name);

/// Returns the fields of a law that have components.
std::vector<StateField> stored_fields(const PointLaw &law);

/// Returns names and numbers of components, such as "'deviator' (6), 'damage' (1)", for messages.
std::string describe(const std::vector<StateField> &fields);

/// Returns the place of the first number of a field; the count of all numbers if the law has no
/// such field.
std::size_t place_of_field(const PointLaw &law, const std::string &name);

/// Averages of the states of several points.
struct StateAverage {
  std::vector<StateField> fields; ///< of the law
  std::vector<double> numbers;    ///< in their order

  /// Returns the components of the field of this name; none if the law has no such field.
  std::vector<double> find(const std::string &name) const;
};

} // namespace billet

#endif
