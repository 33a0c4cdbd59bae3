// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/mesh_levels.h"

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
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

std::string with_counts(const Mesh &mesh, const std::vector<int> &counts) {
  std::string text;
  for (const int n : counts)
    text += (text.empty() ? "" : ", ") + std::to_string(n);
  return text + " " + mesh.arguments.substr(mesh.arguments.find(':'));
}

/// Returns in how many directions nothing can vary, since two symmetry planes hold both sides.
std::size_t count_uniform_directions(const std::vector<parameters::SymmetryPlane> &planes) {
  constexpr double parallel = 1. - 1e-9;
  std::size_t n = 0;
  for (std::size_t i = 0; i < planes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (std::abs(planes[i].normal * planes[j].normal) > parallel)
        ++n;
  return n;
}

/// Changes of the mesh of a body from level to level.
class MeshFamily {
public:
  explicit MeshFamily(const parameters::Body &body)
      : is_section_(body.mesh.section.value != Mesh::Section::solid),
        is_extruded_(body.mesh.source == Mesh::Source::extruded) {
    const std::vector<int> counts = counts_of(body.mesh);
    n_single_ = body.mesh.refinements > 0 ? 0 : std::count(counts.begin(), counts.end(), 1);
    if (is_extruded_ && !is_section_ && body.mesh.n_layers == 1)
      ++n_single_;
    const auto n_uniform = static_cast<std::ptrdiff_t>(count_uniform_directions(body.symmetry_planes.value));
    keeps_single_ = n_single_ <= (is_section_ ? 0 : n_uniform);
  }

  /// Makes the mesh coarser by one level. Returns whether that is possible.
  bool coarsen(Mesh &mesh) const {
    if (n_single_ > 0 && !keeps_single_)
      return false; // one element cannot become half an element
    if (has_layers(mesh) && mesh.n_layers % 2 != 0)
      return false;
    if (mesh.refinements > 0)
      --mesh.refinements;
    else {
      std::vector<int> counts = counts_of(mesh);
      const auto may_be_halved = [](const int n) { return n == 1 || n % 2 == 0; };
      if (counts.empty() || *std::max_element(counts.begin(), counts.end()) < 4 ||
          !std::all_of(counts.begin(), counts.end(), may_be_halved))
        return false;
      for (int &n : counts)
        n = std::max(1, n / 2);
      mesh.arguments = with_counts(mesh, counts);
    }
    if (has_layers(mesh))
      mesh.n_layers /= 2;
    return true;
  }

  void refine(Mesh &mesh) const {
    std::vector<int> counts = counts_of(mesh);
    if (keeps_single_ && mesh.refinements == 0 && std::count(counts.begin(), counts.end(), 1) > 0) {
      for (int &n : counts)
        n *= n == 1 ? 1 : 2;
      mesh.arguments = with_counts(mesh, counts);
    } else
      ++mesh.refinements;
    if (has_layers(mesh))
      mesh.n_layers *= 2;
  }

private:
  /// Whether the layers of an extruded section change with the level.
  bool has_layers(const Mesh &mesh) const {
    return is_extruded_ && !is_section_ && !(mesh.n_layers == 1 && keeps_single_);
  }

  bool is_section_, is_extruded_;
  std::ptrdiff_t n_single_; ///< directions with one element
  bool keeps_single_;       ///< they have one on all levels, since nothing varies there
};

} // namespace

unsigned int count_coarser_levels(const parameters::Scene &scene, const unsigned int most) {
  unsigned int levels = most;
  for (const parameters::Body &body : scene.bodies) {
    const MeshFamily family(body);
    Mesh mesh = body.mesh;
    unsigned int of_body = 0;
    while (of_body < levels && family.coarsen(mesh))
      ++of_body;
    levels = of_body;
  }
  return levels;
}

parameters::Scene at_mesh_levels(const parameters::Scene &scene, const std::vector<int> &levels) {
  parameters::Scene result = scene;
  for (std::size_t b = 0; b < levels.size(); ++b) {
    const MeshFamily family(scene.bodies[b]);
    for (int l = 0; l > levels[b]; --l)
      family.coarsen(result.bodies[b].mesh);
    for (int l = 0; l < levels[b]; ++l)
      family.refine(result.bodies[b].mesh);
  }
  return result;
}

} // namespace billet
