// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/inverted_corners.h"

#include "billet/algebra/gather.h"
#include "billet/diagnostic_kinds.h"

#include <array>
#include <sstream>

namespace billet {

using dealii::Tensor;

namespace {

/// Returns the minimum of det ∂x/∂ξ over the corners, relative to a cube of the undeformed element's volume.
double min_corner_jacobian(const Element &element, const Vector *displacements) {
  const CellIterator &cell = element.cell;
  std::array<Tensor<1, 3>, n_element_nodes> x;
  for (unsigned int v = 0; v < n_element_nodes; ++v) {
    x[v] = cell->vertex(v);
    for (unsigned int i = 0; displacements != nullptr && i < 3; ++i)
      x[v][i] += (*displacements)(element.dofs[std::size_t{3} * v + i]);
  }
  double minimum = std::numeric_limits<double>::infinity();
  for (unsigned int v = 0; v < n_element_nodes; ++v) {
    std::array<Tensor<1, 3>, 3> edges;
    for (unsigned int i = 0; i < 3; ++i) { // the two corners of an edge differ in one bit
      const unsigned int bit = 1U << i, high = v | bit, low = v & ~bit;
      edges[i] = x[high] - x[low];
    }
    minimum = std::min(minimum, dealii::cross_product_3d(edges[0], edges[1]) * edges[2]);
  }
  return minimum / cell->measure();
}

/// Returns a message for each body with more than this fraction of inverted elements.
DiagnosticList find(const Scene &scene, const Discretization &discretization, const Vector *displacements,
                    const DiagnosticKind &kind, const double part) {
  DiagnosticList diagnostics;
  constexpr double rounding = 1e-9;
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    std::array<double, 5> own{}; // number, minimum, its position
    for (const auto &element : discretization.elements(b)) {
      const double jacobian = min_corner_jacobian(element, displacements);
      if (!(jacobian < -rounding))
        continue;
      own[0] += 1.;
      if (jacobian < own[1]) {
        own[1] = jacobian;
        for (unsigned int i = 0; i < 3; ++i)
          own[2 + i] = element.cell->center()[i];
      }
    }
    std::array<double, 5> worst{};
    double n = 0.;
    for (const auto &of_rank : all_gather(discretization.communicator(), own)) {
      n += of_rank[0];
      if (of_rank[1] < worst[1])
        worst = of_rank;
    }
    const std::size_t all =
        dealii::Utilities::MPI::sum(discretization.elements(b).size(), discretization.communicator());
    if (!(n > part * static_cast<double>(all)))
      continue;
    std::ostringstream text;
    text << n << (n == 1. ? " element is" : " elements are")
         << " inverted at a corner; the worst has a Jacobian of " << worst[1] << " times its "
         << (displacements != nullptr ? "undeformed volume" : "volume") << " there";
    diagnostics.push_back(Diagnostic(kind, text.str())
                              .body(scene.bodies()[b].name)
                              .at(Tensor<1, 3>({worst[2], worst[3], worst[4]}))
                              .value("elements", n)
                              .measure("Jacobian [volume]", worst[1]));
  }
  return diagnostics;
}

} // namespace

DiagnosticList find_inverted_corners(const Scene &scene, const Discretization &discretization) {
  return find(scene, discretization, nullptr, diagnostic::inverted_corners, 0.);
}

DiagnosticList find_inverted_corners(const Scene &scene, const Discretization &discretization,
                                     const Vector &displacements) {
  constexpr double few = 0.05; // as in folds: these affect only themselves
  return find(scene, discretization, &displacements, diagnostic::inverted_at_end, few);
}

} // namespace billet
