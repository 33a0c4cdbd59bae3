// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/smooth_volume.h"

#include "billet/scene/mesh_builder.h"

#include <deal.II/grid/grid_tools.h>

namespace billet {

namespace {

/// Number of elements of the finer mesh that takes about a second.
constexpr std::size_t max_elements = 30000;

double measure(const parameters::Body &body) {
  dealii::Triangulation<3> mesh;
  build_body_mesh(body, MeshDetail::full, mesh);
  return dealii::GridTools::volume(mesh);
}

} // namespace

std::optional<double> find_smooth_volume(const parameters::Body &body) {
  if (body.mesh.source == parameters::Mesh::Source::file ||
      (body.mesh.positions.value.empty() && !has_curves(body.mesh)))
    return {};
  parameters::Body other = body;
  dealii::Triangulation<3> outline;
  build_body_mesh(body, MeshDetail::outline, outline);
  other.mesh.n_layers = 1;
  other.mesh.refinements = 1;
  if (count_full_elements(other.mesh, outline) > max_elements)
    return {};
  while (count_full_elements(other.mesh, outline) <= max_elements)
    ++other.mesh.refinements;
  --other.mesh.refinements;
  const double fine = measure(other);
  --other.mesh.refinements;
  const double coarse = measure(other);
  return fine + (fine - coarse) / 3.; // errors are of second order
}

} // namespace billet
