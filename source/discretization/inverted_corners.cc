// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/inverted_corners.h"

#include "billet/algebra/gather.h"
#include "billet/diagnostic_kinds.h"
#include "billet/discretization/element_key.h"

#include <array>
#include <iomanip>
#include <limits>
#include <sstream>

namespace billet {

using dealii::Tensor;

namespace {

using Corners = std::array<Tensor<1, 3>, n_element_nodes>;

Corners corners_of(const Element &element, const Vector *displacements) {
  Corners x;
  for (unsigned int v = 0; v < n_element_nodes; ++v) {
    x[v] = element.cell->vertex(v);
    for (unsigned int i = 0; displacements != nullptr && i < 3; ++i)
      x[v][i] += (*displacements)(element.dofs[std::size_t{3} * v + i]);
  }
  return x;
}

/// Returns the minimum of det ∂x/∂ξ over the corners.
double min_corner_jacobian(const Corners &x) {
  double minimum = std::numeric_limits<double>::infinity();
  for (unsigned int v = 0; v < n_element_nodes; ++v) {
    std::array<Tensor<1, 3>, 3> edges;
    for (unsigned int i = 0; i < 3; ++i) { // the two corners of an edge differ in one bit
      const unsigned int bit = 1U << i, high = v | bit, low = v & ~bit;
      edges[i] = x[high] - x[low];
    }
    minimum = std::min(minimum, dealii::cross_product_3d(edges[0], edges[1]) * edges[2]);
  }
  return minimum;
}

/// Inverted elements of a body, over all ranks.
struct Inverted {
  double number = 0.;
  std::size_t of = 0;    ///< elements of the body
  double jacobian = 0.;  ///< minimum, relative to a cube of the undeformed element's volume
  double element = 0.;   ///< the key of that element
  Tensor<1, 3> position; ///< its centre
  bool is_deformed = false;

  Diagnostic describe(const DiagnosticKind &kind, const std::string &body) const {
    std::ostringstream text;
    text << number << (number == 1. ? " element is" : " elements are")
         << " inverted at a corner; the worst, element " << std::setprecision(15) << element
         << std::setprecision(6) << ", has a Jacobian of " << jacobian << " times its "
         << (is_deformed ? "undeformed volume" : "volume") << " there";
    return Diagnostic(kind, text.str())
        .body(body)
        .at(position)
        .measure("elements", number)
        .value("element", element)
        .value("Jacobian [volume]", jacobian);
  }
};

/// Collective.
Inverted find(const Discretization &discretization, const std::size_t body, const Vector *displacements) {
  constexpr double rounding = 1e-9;
  std::array<double, 6> own{}; // number, minimum, key, position
  for (const auto &element : discretization.elements(body)) {
    const Corners x = corners_of(element, displacements);
    const double jacobian = min_corner_jacobian(x) / element.cell->measure();
    if (!(jacobian < -rounding))
      continue;
    own[0] += 1.;
    if (jacobian < own[1]) {
      Tensor<1, 3> centre;
      for (const auto &corner : x)
        centre += corner / double{n_element_nodes};
      own = {own[0],    jacobian,  static_cast<double>(element_key(element.cell->id())),
             centre[0], centre[1], centre[2]};
    }
  }
  Inverted inverted;
  inverted.is_deformed = displacements != nullptr;
  inverted.of =
      dealii::Utilities::MPI::sum(discretization.elements(body).size(), discretization.communicator());
  for (const auto &of_rank : all_gather(discretization.communicator(), own)) {
    inverted.number += of_rank[0];
    if (of_rank[1] < inverted.jacobian) {
      inverted.jacobian = of_rank[1];
      inverted.element = of_rank[2];
      inverted.position = Tensor<1, 3>({of_rank[3], of_rank[4], of_rank[5]});
    }
  }
  return inverted;
}

} // namespace

DiagnosticList find_inverted_corners(const Scene &scene, const Discretization &discretization) {
  DiagnosticList diagnostics;
  for (std::size_t b = 0; b < scene.bodies().size(); ++b)
    if (const Inverted inverted = find(discretization, b, nullptr); inverted.number > 0.)
      diagnostics.push_back(inverted.describe(diagnostic::inverted_corners, scene.bodies()[b].name));
  return diagnostics;
}

DiagnosticList find_inverted_corners(const Scene &scene, const Discretization &discretization,
                                     const Vector &displacements, const bool is_last) {
  constexpr double few = 0.05; // as in folds: these affect only themselves
  DiagnosticList diagnostics;
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    const Inverted inverted = find(discretization, b, &displacements);
    if (!(inverted.number > 0.))
      continue;
    const bool are_many = is_last && inverted.number > few * static_cast<double>(inverted.of);
    diagnostics.push_back(inverted.describe(
        are_many ? diagnostic::inverted_at_end : diagnostic::inverted_elements, scene.bodies()[b].name));
  }
  return diagnostics;
}

} // namespace billet
