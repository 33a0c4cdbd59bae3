// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_SNAPSHOT_GRIDS_H
#define BILLET_OUTPUT_SNAPSHOT_GRIDS_H

#include "billet/output/grid.h"
#include "billet/solve/solution.h"

#include <string>
#include <vector>

namespace billet {

/// Groups of blocks, the same in each scene; a group may be empty.
namespace block_group {
const std::string bodies = "Bodies", boundaries = "Boundaries", contact_surfaces = "Contact surfaces",
                  tools = "Tools";
const std::vector<std::string> all{bodies, boundaries, contact_surfaces, tools};
} // namespace block_group

/// Returns the blocks of a snapshot, all at their deformed positions. They are each body; its
/// outside, with boundary ids; the surfaces of each contact pair; each tool. The nodes of a block
/// are shared by its cells, also across ranks. Collective.
std::vector<Grid> make_snapshot_grids(const Scene &scene, const Solution &solution);

/// Returns the block of a tool, the scene's tool `t`, at a placement. The first rank has its points
/// and facets.
Grid make_tool_grid(const Discretization &discretization, const Tool &tool, std::size_t t,
                    const Placement &now, const std::string &group);

} // namespace billet

#endif
