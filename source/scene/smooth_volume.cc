// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/smooth_volume.h"

#include "billet/scene/mesh_builder.h"

#include <deal.II/grid/grid_tools.h>

#include <algorithm>

namespace billet {

namespace {

/// Number of elements of the finer mesh that takes about a second.
constexpr std::size_t max_elements = 30000;

/// Most layers of a coarse mesh that replaces more; fewer may leave a bar that is bent to a ring no
/// volume.
constexpr unsigned int max_coarse_layers = 8;

double measure(const parameters::Body &body) {
  dealii::Triangulation<3> mesh;
  build_body_mesh(body, MeshDetail::full, mesh);
  return dealii::GridTools::volume(mesh);
}

/// Returns the body with another number of refinements. Layers stay straight unless 'Positions'
/// bend them.
parameters::Body at_refinements(const parameters::Body &body, const unsigned int n) {
  parameters::Body other = body;
  other.mesh.refinements = n;
  const bool bends =
      body.mesh.source == parameters::Mesh::Source::extruded && !body.mesh.positions.value.empty();
  other.mesh.n_layers = bends ? std::min(body.mesh.n_layers, max_coarse_layers) << n : 1;
  return other;
}

} // namespace

std::optional<double> find_smooth_volume(const parameters::Body &body) {
  if (body.mesh.source == parameters::Mesh::Source::file ||
      (body.mesh.positions.value.empty() && !has_curves(body.mesh)))
    return {};
  dealii::Triangulation<3> outline;
  build_body_mesh(body, MeshDetail::outline, outline);
  unsigned int n = 0;
  while (count_full_elements(at_refinements(body, n + 1).mesh, outline) <= max_elements)
    ++n;
  if (n == 0)
    return {};
  const double fine = measure(at_refinements(body, n)), coarse = measure(at_refinements(body, n - 1));
  return fine + (fine - coarse) / 3.; // errors are of second order
}

} // namespace billet
