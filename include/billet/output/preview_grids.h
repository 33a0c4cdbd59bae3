// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_PREVIEW_GRIDS_H
#define BILLET_OUTPUT_PREVIEW_GRIDS_H

#include "billet/discretization/discretization.h"
#include "billet/output/grid.h"

#include <string>
#include <vector>

namespace billet {

/// Groups of blocks that a preview has beside those of a snapshot.
namespace preview_group {
const std::string tools_at_end = "Tools at end", supports = "Supports", loads = "Loads";
const std::vector<std::string> all{tools_at_end, supports, loads};
} // namespace preview_group

/// Arrow from one point to another, with the vector that it shows.
struct Arrow {
  dealii::Tensor<1, 3> from, to, value;
};

/// Returns a surface of the arrows of all ranks, which the first rank has. Each cell has the value
/// of its arrow under this name. `radius`: half the diagonal of the scene, to which the width of
/// long arrows is relative [length]. Collective.
Grid make_arrow_grid(const std::string &group, const std::string &name, const std::string &value_name,
                     const std::vector<Arrow> &arrows, double radius, MPI_Comm communicator);

/// Arrows of the supports of a body, one for each constraint of each node. Where a support moves,
/// the arrow is the displacement at the end time; else it points at the node, with the value 0.
/// Those of this rank.
std::vector<Arrow> find_support_arrows(const Scene &scene, const Discretization &discretization,
                                       std::size_t body);

/// Forces of a load at the nodes, on this rank. The longest arrows of all loads have the same
/// length.
struct LoadArrows {
  std::string name; ///< "LOAD of BODY"
  double time = 0.; ///< at which the load is largest, of those that were looked at
  std::vector<Arrow> arrows;
};

/// Returns the forces of each load, undeformed and at rest, body by body. Collective.
std::vector<LoadArrows> find_load_arrows(const Scene &scene, const Discretization &discretization);

/// Returns the blocks of a preview beside those of a snapshot: tools at the end of their prescribed
/// motions, supports and loads. Collective.
std::vector<Grid> make_preview_grids(const Scene &scene, const Discretization &discretization);

} // namespace billet

#endif
