// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_LOADS_NODE_SITE_H
#define BILLET_LOADS_NODE_SITE_H

#include "billet/loads/load.h"

namespace billet {

/// Returns a selected node as a site of a load on a surface. All of its corners are this node. Its
/// area is that of the first corner, the part of the node in the load.
inline LoadedFace make_node_site(const unsigned int node, const dealii::Point<3> &position,
                                 const LoadedSurface *surface, const double part) {
  return {{node, node, node, node}, position, surface, {part, 0., 0., 0.}};
}

/// Whether a site of a load on a surface is a selected node.
inline bool is_node_site(const LoadedFace &site) { return site.nodes[0] == site.nodes[3]; }

/// Returns the parameter that selects nodes in place of faces; the scene reads it.
TypeParameter loaded_nodes();

} // namespace billet

#endif
