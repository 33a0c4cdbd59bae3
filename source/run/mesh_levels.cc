// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/mesh_levels.h"

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <string>
#include <vector>

namespace billet {

namespace {

using parameters::Mesh;

/// Returns the numbers of elements along the axes of a subdivided box; empty for other primitives.
std::vector<int> counts_of(const Mesh &mesh) {
  if (mesh.source == Mesh::Source::file || mesh.primitive.value != "subdivided_hyper_rectangle")
    return {};
  try {
    return dealii::Utilities::string_to_int(
        dealii::Utilities::split_string_list(mesh.arguments.substr(0, mesh.arguments.find(':')), ','));
  } catch (const std::exception &) { // 'name = value'
    return {};
  }
}

/// Makes the mesh coarser by one level. Returns whether that is possible.
bool coarsen(Mesh &mesh) {
  const bool has_layers = mesh.source == Mesh::Source::extruded && mesh.n_layers > 1;
  if (has_layers && mesh.n_layers % 2 != 0)
    return false;
  if (mesh.refinements > 0)
    --mesh.refinements;
  else {
    std::vector<int> counts = counts_of(mesh);
    const auto may_be_halved = [](const int n) { return n == 1 || n % 2 == 0; };
    if (counts.empty() || *std::max_element(counts.begin(), counts.end()) < 4 ||
        !std::all_of(counts.begin(), counts.end(), may_be_halved))
      return false;
    std::string text;
    for (const int n : counts)
      text += (text.empty() ? "" : ", ") + std::to_string(std::max(1, n / 2));
    mesh.arguments = text + " " + mesh.arguments.substr(mesh.arguments.find(':'));
  }
  if (has_layers)
    mesh.n_layers /= 2;
  return true;
}

void refine(Mesh &mesh) {
  ++mesh.refinements;
  if (mesh.source == Mesh::Source::extruded && mesh.n_layers > 1)
    mesh.n_layers *= 2;
}

} // namespace

unsigned int count_coarser_levels(const parameters::Scene &scene, const unsigned int most) {
  unsigned int levels = most;
  for (const parameters::Body &body : scene.bodies) {
    Mesh mesh = body.mesh;
    unsigned int of_body = 0;
    while (of_body < levels && coarsen(mesh))
      ++of_body;
    levels = of_body;
  }
  return levels;
}

parameters::Scene at_mesh_levels(const parameters::Scene &scene, const std::vector<int> &levels) {
  parameters::Scene result = scene;
  for (std::size_t b = 0; b < levels.size(); ++b) {
    for (int l = 0; l > levels[b]; --l)
      coarsen(result.bodies[b].mesh);
    for (int l = 0; l < levels[b]; ++l)
      refine(result.bodies[b].mesh);
  }
  return result;
}

} // namespace billet
