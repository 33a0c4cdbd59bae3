// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SLAVE_SURFACE_H
#define BILLET_CONTACT_SLAVE_SURFACE_H

#include "billet/contact/hardening_spring.h"
#include "billet/contact/traction.h"
#include "billet/discretization/discretization.h"
#include "billet/discretization/node_keys.h"
#include "billet/scene/scene.h"
#include "billet/state.h"

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace billet {

/// A node of the mesh, or a point inside a divided facet, that may touch a tool.
struct ContactPoint {
  std::array<DofIndex, 3> dofs;
  dealii::Point<3> reference;
  ContactStiffness stiffness, given; ///< now, and at the start
  double size;                       ///< of the facets around it
  /// Acceptable penetration, from the size of these facets and of the elements below [length].
  double reach;
  /// Size of the parts of facets around it; equal to `size` where none is divided.
  double spacing;
  bool is_divided = false; ///< whether a facet around it is divided
  bool is_fixed = false;   ///< supports prescribe all its motion: it cannot leave the tool
  double hardening_penetration = std::numeric_limits<double>::infinity(); ///< of its normal spring
  HardeningSpring spring() const { return {stiffness.normal, hardening_penetration}; }
  double touching_gap; ///< of nodes that start on the tool; far below stiff-penalty penetrations
  double gap_n = 0.;   ///< at the start of the step
  /// Patch of the tool's surface where the search for the next contact point starts.
  unsigned int patch = 0;
  /// λ/k of augmentation, now and at the start of the step [length]
  double multiplier_offset = 0., multiplier_offset_n = 0.;
  /// Allowed initial penetration; < 0: a gap that counts as closed.
  double initial_penetration = 0.;
  /// Whether it had missed the tool's surface at the start of the step.
  bool is_behind = false;
  dealii::Tensor<1, 3> behind_at; ///< its place then, in the tool's coordinates

  /// Returns the displacement of a node of the mesh.
  dealii::Tensor<1, 3> displacement_in(const Vector &displacements) const {
    dealii::Tensor<1, 3> displacement;
    for (unsigned int c = 0; c < 3; ++c)
      displacement[c] = displacements(dofs[c]);
    return displacement;
  }
};

/// A facet of the mesh, or a part of one; nodes ordered so that the area vector points out of the
/// body.
struct ContactFacet {
  std::array<unsigned int, 4> nodes;
  std::uint64_t key;
  std::array<double, 4> friction_areas; ///< of corners that touch, at the start of the step
  /// Only in explicit scenes: each corner's area in the last step in which its node was not deep,
  /// or in its first one. It is SpringEnergy::no_area where the corner does not touch.
  std::array<double, 4> shallow_areas;
};

/// A point inside a facet. Its node index in the SlaveSurface is n_mesh_nodes + its own index.
struct InteriorPoint {
  std::array<unsigned int, 4> corners; ///< of the facet
  std::array<double, 4> weights;       ///< N_a
  std::uint64_t key;                   ///< unique, and the same on any number of ranks
};

/// Divided facet of the mesh.
struct DividedFacet {
  std::array<unsigned int, 4> corners;
  unsigned int first_point, n_points; ///< inside, in `nodes`
  unsigned int first_part, n_parts;   ///< in `facets`
  bool may_touch; ///< whether a point inside touched at the last update(), or its status is unknown
};

/// Boundary faces of a body that may touch a tool. Contains their nodes with sizes and penalties,
/// and the points inside facets between whose nodes the tool could enter (T10).
struct SlaveSurface {
  /// Collects the surface. `touching_gap` is that of nodes that start on the tool [facet sizes].
  /// Collective.
  SlaveSurface(const ContactPair &pair, const Tool &tool, const Discretization &discretization,
               double young_modulus, double touching_gap);

  std::vector<ContactPoint> nodes; ///< of the mesh, then points inside facets
  std::size_t n_mesh_nodes = 0;
  std::vector<InteriorPoint> points;
  std::vector<DividedFacet> divided;
  bool has_divided_facets = false;  ///< on any rank
  std::vector<ContactFacet> facets; ///< those that are not divided, then parts
  std::size_t n_whole_facets = 0;
  bool is_sheet = false;         ///< see may_have_sheet_penalty()
  double unresolved_length = 0.; ///< of the longest facet with too few parts, on any rank [length]
  /// Maximum factors by which the program may raise penalties.
  double max_stiffening = std::numeric_limits<double>::infinity(),
         max_tangential_stiffening = std::numeric_limits<double>::infinity();

  /// Returns the sums of the area vectors of facets around each node or point, at these positions
  /// [length²]. Collective.
  std::vector<dealii::Tensor<1, 3>> sum_normals(const std::vector<dealii::Tensor<1, 3>> &positions,
                                                const Discretization &discretization) const;
  /// Makes springs at divided facets harden with penetration (T11), for a tool of this thickness
  /// [length].
  void harden_springs(double tool_thickness);
  /// Calls add(node of the mesh, weight) for the parents of a node or point.
  template <class Add> void for_each_parent(const std::size_t i, const Add &add) const {
    if (i < n_mesh_nodes) {
      add(static_cast<unsigned int>(i), 1.);
      return;
    }
    const InteriorPoint &point = points[i - n_mesh_nodes];
    for (unsigned int a = 0; a < 4; ++a)
      if (point.weights[a] > 0.)
        add(point.corners[a], point.weights[a]);
  }
  /// Returns Σ w value(node of the mesh).
  template <class Value> dealii::Tensor<1, 3> at(const std::size_t i, const Value &value) const {
    if (i < n_mesh_nodes)
      return value(i);
    dealii::Tensor<1, 3> sum;
    for_each_parent(i,
                    [&](const unsigned int parent, const double weight) { sum += weight * value(parent); });
    return sum;
  }
  /// Adds a value of a node or point to the dofs of its parents.
  void add_to_dofs(std::size_t i, const dealii::Tensor<1, 3> &value, Vector &vector) const;
  /// Nodes or facets whose state is in a checkpoint under names with this prefix.
  struct Range {
    std::string prefix;
    std::size_t begin, end;
    std::vector<std::uint64_t> keys;

    /// Writes rows of `width` numbers, one for each index from `begin` on.
    void write(StateWriter &writer, const std::string &name, const std::size_t width,
               const std::vector<double> &rows) const {
      writer.write_rows(prefix + name, width, keys, rows);
    }
    /// Calls set(index, its row) for the rows that the state contains. With another tool or mesh
    /// before the restart, the points inside facets may have been different.
    template <class Set>
    void read(const StateReader &reader, const std::string &name, const std::size_t width,
              const Set &set) const {
      std::vector<bool> is_known(keys.size(), true);
      const std::vector<double> rows =
          reader.read_rows(prefix + name, width, keys, prefix.empty() ? nullptr : &is_known);
      for (std::size_t i = begin; i < end; ++i)
        if (is_known[i - begin]) {
          RowReader row(&rows[width * (i - begin)], width);
          set(i, row);
        }
    }
  };
  Range mesh_nodes(const NodeKeys &keys) const;
  Range interior_points() const;
  Range facet_range(bool are_parts) const;

private:
  void collect_facets(const ContactPair &pair, const Discretization &discretization, double young_modulus,
                      double touching_gap);
  /// Divides facets where the tool requires it. Collective.
  void divide_facets(const Tool &tool, const Discretization &discretization);
  void divide(const std::array<unsigned int, 4> &corners, const std::array<unsigned int, 2> &n_parts,
              std::uint64_t key);
};

} // namespace billet

#endif
