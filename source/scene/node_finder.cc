// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/node_finder.h"

#include "billet/errors.h"
#include "billet/mesh/mesh_cursor.h"
#include "billet/nearest_name.h"
#include "billet/scene/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace billet {

using dealii::Point;
using dealii::Tensor;

namespace {

// Maximum distance of a node from a point or line [shortest edge at the node].
constexpr double near = 0.01;

/// Adds the nodes at the same points of the section: on the other side of its layer or wedge.
/// `nodes`: all nodes of the section, those of one side after those of the other.
void add_columns(const std::vector<Point<3>> &nodes, std::vector<Point<3>> &found) {
  const NodePlaces chosen(found);
  const std::size_t n = nodes.size() / 2;
  for (std::size_t i = 0; i < n; ++i)
    if (chosen.contains(nodes[i]) || chosen.contains(nodes[n + i]))
      found.insert(found.end(), {nodes[i], nodes[n + i]});
}

} // namespace

void NodeFinder::build() {
  if (is_built_)
    return;
  is_built_ = true;
  dealii::Triangulation<3> mesh;
  NodeSets sets;
  build_body_mesh(body_, MeshDetail::full, mesh, &sets);
  std::vector<double> sizes(mesh.n_vertices(), std::numeric_limits<double>::infinity());
  for (const auto &cell : mesh.active_cell_iterators())
    for (const unsigned int l : cell->line_indices())
      for (const unsigned int v : {0U, 1U}) {
        double &size = sizes[cell->line(l)->vertex_index(v)];
        size = std::min(size, cell->line(l)->diameter());
      }
  for (unsigned int v = 0; v < mesh.n_vertices(); ++v)
    if (std::isfinite(sizes[v])) {
      positions_.push_back(mesh.get_vertices()[v]);
      sizes_.push_back(sizes[v]);
    }
  for (const auto &[name, marks] : sets.marks) {
    auto &places = sets_[name];
    for (unsigned int v = 0; v < mesh.n_vertices(); ++v)
      if (marks[v])
        places.push_back(mesh.get_vertices()[v]);
  }
}

Point<3> NodeFinder::find_at(const Point<3> &position, const std::string &origin) const {
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < positions_.size(); ++i)
    if (positions_[i].distance(position) < positions_[nearest].distance(position))
      nearest = i;
  const double distance = positions_[nearest].distance(position);
  if (distance > near * sizes_[nearest]) {
    std::ostringstream message;
    message << origin << ": no node of body '" << body_.name << "' is at (" << position
            << "); allowed are undeformed positions of nodes, such as the nearest one, 'at "
            << positions_[nearest][0] << ", " << positions_[nearest][1] << ", " << positions_[nearest][2]
            << "', at a distance of " << distance;
    throw InputError(message.str());
  }
  return positions_[nearest];
}

void NodeFinder::add_line(const std::array<Tensor<1, 3>, 2> &ends, const std::string &origin,
                          std::vector<Point<3>> &found) const {
  const Tensor<1, 3> along = ends[1] - ends[0];
  double nearest = std::numeric_limits<double>::infinity();
  bool any = false;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const Tensor<1, 3> arm = positions_[i] - ends[0];
    const double part = std::clamp((arm * along) / (along * along), 0., 1.);
    const double distance = (arm - part * along).norm();
    nearest = std::min(nearest, distance);
    if (distance > near * sizes_[i])
      continue;
    found.push_back(positions_[i]);
    any = true;
  }
  if (any)
    return;
  std::ostringstream message;
  message << origin << ": no node of body '" << body_.name << "' is on the line from (" << ends[0] << ") to ("
          << ends[1] << "), and the nearest one is at a distance of " << nearest
          << "; allowed are lines through undeformed nodes";
  throw InputError(message.str());
}

const std::vector<Point<3>> &NodeFinder::find_set(const std::string &name, const std::string &origin) const {
  const std::vector<Point<3>> *found = nullptr;
  std::vector<std::string> names;
  std::string list;
  for (const auto &[known, places] : sets_) {
    names.push_back(known);
    list += (list.empty() ? "" : ", ") + known;
    if (known == name || (found == nullptr && lower_case(known) == lower_case(name)))
      found = &places;
  }
  if (found != nullptr && found->empty())
    throw InputError(origin + " names node set '" + name + "', which has no node of body '" + body_.name +
                     "'; allowed are sets of nodes of its hexahedra");
  if (found != nullptr)
    return *found;
  const bool is_section = body_.mesh.section.value != parameters::Mesh::Section::solid;
  throw InputError(origin + " names node set '" + name + "'" +
                   (!names.empty() ? "; allowed are those of the mesh file of body '" + body_.name +
                                         "': " + list + did_you_mean(name, names)
                    : is_section ? ", but 'Section' makes the nodes of body '" + body_.name +
                                       "'; allowed are 'at x, y, z' and 'on line x, y, z : x, y, z'"
                                 : ", but the mesh of body '" + body_.name +
                                       "' has no node sets; allowed are 'at x, y, z' and 'on line x, y, z : "
                                       "x, y, z'"));
}

std::shared_ptr<const NodePlaces> NodeFinder::find(const NodeSelection &selection) {
  if (selection.is_empty())
    return nullptr;
  build();
  std::vector<Point<3>> found;
  for (const auto &point : selection.points)
    found.push_back(find_at(Point<3>(point), selection.origin));
  for (const auto &line : selection.lines)
    add_line(line, selection.origin, found);
  for (const std::string &name : selection.sets) {
    const auto &of_set = find_set(name, selection.origin);
    found.insert(found.end(), of_set.begin(), of_set.end());
  }
  if (body_.mesh.section.value != parameters::Mesh::Section::solid)
    add_columns(positions_, found);
  return std::make_shared<const NodePlaces>(found);
}

} // namespace billet
