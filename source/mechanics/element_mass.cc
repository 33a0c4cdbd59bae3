// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/element_mass.h"

#include "billet/mechanics/modal_geometry.h"

#include <cmath>

namespace billet {

namespace {

using NodalValues = std::array<double, n_element_nodes>;

/// Returns N_a at the points of ReferenceElement.
std::array<NodalValues, n_element_points> make_shape_values() {
  std::array<NodalValues, n_element_points> values{};
  const double g = 1. / std::sqrt(3.);
  for (unsigned int q = 0; q < n_element_points; ++q)
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      values[q][a] = 1.;
      for (unsigned int i = 0; i < 3; ++i)
        values[q][a] *= ((a ^ q) >> i & 1U) == 0U ? 0.5 * (1. + g) : 0.5 * (1. - g);
    }
  return values;
}

const std::array<NodalValues, n_element_points> shape_values = make_shape_values();

} // namespace

std::array<double, n_element_nodes> compute_nodal_volumes(const ReferenceElement &reference) {
  std::array<double, n_element_nodes> volumes{};
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int q = 0; q < n_element_points; ++q) {
      double value = reference.volumes[q];
      for (unsigned int i = 0; i < 3; ++i)
        value *= 0.5 * (1. + corner(a, i) * corner(q, i) / std::sqrt(3.));
      volumes[a] += value;
    }
  return volumes;
}

ElementMass compute_element_mass(const ReferenceElement &element, const double density) {
  ElementMass mass{};
  for (unsigned int q = 0; q < n_element_points; ++q)
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      for (unsigned int b = 0; b < n_element_nodes; ++b)
        mass[a * n_element_nodes + b] +=
            density * element.volumes[q] * shape_values[q][a] * shape_values[q][b];
  return mass;
}

void lump(ElementMass &mass) {
  for (unsigned int a = 0; a < n_element_nodes; ++a) {
    double sum = 0.;
    for (unsigned int b = 0; b < n_element_nodes; ++b) {
      sum += mass[a * n_element_nodes + b];
      mass[a * n_element_nodes + b] = 0.;
    }
    mass[a * n_element_nodes + a] = sum;
  }
}

} // namespace billet
