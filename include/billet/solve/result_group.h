// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_RESULT_GROUP_H
#define BILLET_SOLVE_RESULT_GROUP_H

#include "billet/state.h"

#include <deal.II/base/tensor.h>

#include <string>
#include <vector>

namespace billet {

/// Results that share an error estimate, such as the forces of all tools and pairs of bodies.
using ResultGroup = std::vector<dealii::Tensor<1, 3>>;

/// Returns Σ|F|.
double size_of(const ResultGroup &forces);
/// Returns Σ|F − F'|; both have the same size.
double distance_of(const ResultGroup &a, const ResultGroup &b);

void save(StateWriter &writer, const std::string &name, const ResultGroup &forces);
ResultGroup load_result_group(const StateReader &reader, const std::string &name);

} // namespace billet

#endif
