// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_TENSOR_COLUMNS_H
#define BILLET_MATERIAL_TENSOR_COLUMNS_H

#include <string>
#include <vector>

namespace billet {

/// Returns the names of the components of the Cauchy stress, von Mises' stress and the pressure, in
/// the order of list_stress(), for fields and probes.
std::vector<std::string> stress_columns();
/// Returns the names of the components of the logarithmic strain, in the order of
/// list_components().
std::vector<std::string> strain_columns();

} // namespace billet

#endif
