// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/missed_edge.h"

#include "billet/contact/edge_fading.h"

#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

constexpr std::size_t missed_row_width = 4; // of a node that may be behind a tool

} // namespace

bool MissedEdge::is_missed_by(const ContactPoint &node, const Tensor<1, 3> &position,
                              const Tensor<1, 3> &on_tool, const RigidSurface::Projection &projection) const {
  if (projection.exists) // and it has not come through from the front of the surface before it
    return node.is_behind && projection.gap - step_.gap_offset(node) < 0. &&
           projection.gap - projection.normal * (on_tool - node.behind_at) < 0.;
  if (!projection.is_behind)
    return false;
  if (node.is_behind)
    return true;
  constexpr double far = 2.; // facet sizes: a node farther away passes this zone first
  const double width = fading_width * node.size;
  const double along_squared = projection.gap * projection.gap - projection.beyond * projection.beyond;
  return projection.beyond >= width && projection.beyond < far * node.size &&
         std::sqrt(std::max(0., along_squared)) + step_.gap_offset(node) > width &&
         !neighbours_.is_near(position, node.size);
}

void MissedEdge::commit(std::vector<ContactPoint> &nodes, const std::vector<ToolContactState> &states) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].is_behind = states[i].is_behind;
    if (states[i].is_behind)
      nodes[i].behind_at = step_.placement.to_tool(states[i].position);
    has_nodes_behind_ = has_nodes_behind_ || states[i].is_passed;
  }
}

void MissedEdge::save(StateWriter &writer, const std::vector<ContactPoint> &nodes,
                      const SlaveSurface::Range &range) {
  std::vector<double> rows;
  RowWriter row(rows);
  for (std::size_t i = range.begin; i < range.end; ++i)
    row.number(nodes[i].is_behind ? 1. : 0.).vector(nodes[i].behind_at);
  range.write(writer, "behind", missed_row_width, rows);
}

void MissedEdge::load(const StateReader &reader, std::vector<ContactPoint> &nodes,
                      const SlaveSurface::Range &range) {
  if (!reader.has(range.prefix + "behind"))
    return;
  range.read(reader, "behind", missed_row_width, [&](const std::size_t i, RowReader &row) {
    nodes[i].is_behind = row.flag();
    row.vector(nodes[i].behind_at);
  });
}

} // namespace billet
