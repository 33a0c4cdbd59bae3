// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/inverted_corners.h"

#include "billet/diagnostic_kinds.h"

#include <array>
#include <sstream>

namespace billet {

using dealii::Tensor;

namespace {

/// The smallest det ∂x/∂ξ of the corners, over that of a cube of the element's volume.
double smallest_corner_jacobian(const CellIterator &cell) {
  double smallest = std::numeric_limits<double>::infinity();
  for (unsigned int v = 0; v < n_element_nodes; ++v) {
    std::array<Tensor<1, 3>, 3> edges;
    for (unsigned int i = 0; i < 3; ++i) { // the corners of an axis' ends differ in one bit
      const unsigned int bit = 1U << i, high = v | bit, low = v & ~bit;
      edges[i] = cell->vertex(high) - cell->vertex(low);
    }
    smallest = std::min(smallest, dealii::cross_product_3d(edges[0], edges[1]) * edges[2]);
  }
  return smallest / cell->measure();
}

} // namespace

DiagnosticList find_inverted_corners(const Scene &scene, const Discretization &discretization) {
  DiagnosticList diagnostics;
  constexpr double rounding = 1e-9;
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    std::array<double, 5> own{}; // how many, the worst, where
    for (const auto &element : discretization.elements(b)) {
      const double jacobian = smallest_corner_jacobian(element.cell);
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
    for (const auto &of_rank : dealii::Utilities::MPI::all_gather(discretization.communicator(), own)) {
      n += of_rank[0];
      if (of_rank[1] < worst[1])
        worst = of_rank;
    }
    if (n == 0.)
      continue;
    std::ostringstream text;
    text << n << (n == 1. ? " element is" : " elements are")
         << " inside out at a corner; the worst has a Jacobian of " << worst[1] << " times its volume there";
    diagnostics.push_back(Diagnostic(diagnostic::inverted_corners, text.str())
                              .body(scene.bodies()[b].name)
                              .at(Tensor<1, 3>({worst[2], worst[3], worst[4]}))
                              .value("elements", n)
                              .measure("Jacobian [volume]", worst[1]));
  }
  return diagnostics;
}

} // namespace billet
