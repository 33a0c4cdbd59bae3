// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/mesh_builder.h"

#include "billet/errors.h"
#include "billet/scene/boundary_names.h"
#include "billet/scene/expression.h"
#include "billet/scene/plane_fit.h"

#include <deal.II/base/utilities.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace billet {

using dealii::Triangulation;

namespace {

/// Returns the words of a deal.II message between two of its headings, on one line; it breaks lines
/// anywhere and ends with a ruler.
std::string words_between(const std::string &message, const std::string &heading, const std::string &next) {
  const std::size_t begin = message.find(heading);
  if (begin == std::string::npos)
    return "";
  const std::size_t end = message.find(next, begin);
  std::istringstream words(
      message.substr(begin + heading.size(), end == std::string::npos ? end : end - begin - heading.size()));
  std::string result;
  for (std::string word; words >> word;)
    result += (result.empty() ? "" : " ") + word;
  return result;
}

/// Returns the part of an exception's message that names the problem, on one line: deal.II's
/// explanation, or the condition that it requires. Its list of all elements that a point may be in
/// becomes one sentence.
std::string essence(const std::exception &error) {
  const std::string message = error.what(),
                    information = "Additional information:", condition = "The violated condition was:";
  const std::string text = words_between(message, information, "\n---");
  if (text.find("Transformation to chart coordinates") != std::string::npos)
    return "Its curved elements overlap or turn inside out";
  if (!text.empty())
    return text;
  const std::string required = words_between(message, condition, information);
  return required.empty() || required == "false" ? "deal.II gives no reason; check sizes and their order"
                                                 : "deal.II requires " + required;
}

std::string describe_refusal(const parameters::Mesh &parameters) {
  return parameters.primitive.origin + " is '" + parameters.primitive.value + "' with arguments '" +
         parameters.arguments + "'; allowed are arguments for which GridGenerator makes a mesh";
}

/// Lets deal.II's assertions throw instead of aborting, during its lifetime: the user provides the
/// arguments of meshes.
class AssertionsThrow {
public:
  AssertionsThrow() { dealii::deal_II_exceptions::disable_abort_on_exception(); }
  ~AssertionsThrow() { dealii::deal_II_exceptions::enable_abort_on_exception(); }
  AssertionsThrow(const AssertionsThrow &) = delete;
  AssertionsThrow &operator=(const AssertionsThrow &) = delete;
};

/// Returns "x" if the mesh has no extent along x, beyond round-off; empty if it has a volume.
template <int dim> std::string missing_extent(const Triangulation<dim> &mesh) {
  constexpr double rounding = 1e-12;
  const auto corners = dealii::GridTools::compute_bounding_box(mesh).get_boundary_points();
  const dealii::Tensor<1, dim> extents = corners.second - corners.first;
  for (unsigned int i = 0; i < dim; ++i)
    if (!(extents[i] > rounding * extents.norm()))
      return {"xyz"[i]};
  return "";
}

/// Refuses a primitive without a volume.
template <int dim> void check_primitive(const parameters::Mesh &parameters, const Triangulation<dim> &mesh) {
  if (mesh.n_active_cells() == 0)
    throw InputError(describe_refusal(parameters) + ". It has no elements");
  if (const std::string axis = missing_extent(mesh); !axis.empty())
    throw InputError(describe_refusal(parameters) + ". It has no extent along " + axis);
  for (const auto &cell : mesh.active_cell_iterators())
    if (!(cell->measure() > 0.)) {
      std::ostringstream message;
      message << describe_refusal(parameters) << ". Its element with the centre at (" << cell->center()
              << ") is inverted. Check the order of sizes and corners";
      throw InputError(message.str());
    }
}

/// Calls `make`, which makes or refines a primitive, and refuses arguments that deal.II refuses.
template <class Make> void make_primitive(const parameters::Mesh &parameters, const Make &make) {
  try {
    const AssertionsThrow refusals_are_errors;
    make();
  } catch (const std::exception &error) {
    throw InputError(describe_refusal(parameters) + ". " + essence(error));
  }
}

template <int dim> void generate_primitive(const parameters::Mesh &parameters, Triangulation<dim> &mesh) {
  make_primitive(parameters, [&] {
    dealii::GridGenerator::generate_from_name_and_arguments(mesh, parameters.primitive.value,
                                                            parameters.arguments);
  });
  check_primitive(parameters, mesh);
}

template <int dim> void refine_primitive(const parameters::Mesh &parameters, Triangulation<dim> &mesh) {
  make_primitive(parameters, [&] { mesh.refine_global(parameters.refinements); });
}

/// Turns the section, x the radius and y the height, about the axis of z. Bricks on the axis become
/// prisms: the sides of the wedge hold the two nodes at one place there, and Gauss points see no
/// zero.
void turn_section(const parameters::Mesh &parameters, const Triangulation<2> &section,
                  Triangulation<3> &mesh) {
  constexpr double rounding = 1e-9;
  double largest = 0., least = std::numeric_limits<double>::max();
  for (const auto &cell : section.active_cell_iterators())
    for (const unsigned int v : cell->vertex_indices()) {
      least = std::min(least, cell->vertex(v)[0]);
      largest = std::max(largest, cell->vertex(v).norm());
    }
  if (!(least >= -rounding * largest)) {
    std::ostringstream message;
    message << parameters.section.origin
            << " is 'axisymmetric', but the section begins at the radius x = " << least
            << "; allowed are sections with x >= 0, on one side of the axis x = 0. Move it along x";
    throw InputError(message.str());
  }
  dealii::GridGenerator::extrude_triangulation(section, 2, 1., mesh);
  dealii::GridTools::transform(
      [&](const dealii::Point<3> &x) {
        // This way corners keep their order.
        const double angle = (1. - x[2]) * parameters.wedge_angle;
        const double radius = x[0] > rounding * largest ? x[0] : 0.;
        return dealii::Point<3>(radius * std::cos(angle), radius * std::sin(angle), x[1]);
      },
      mesh);
}

/// Returns the message for a file with cells that do not fit each other.
InputError misfit(const parameters::Mesh &parameters, const char *const cells, const std::exception &error) {
  return InputError(parameters.file_name.origin + " is '" + parameters.file_name.value +
                    "'; allowed is a mesh of " + cells + " that fit each other. " + essence(error));
}

/// Makes the section of a file, which has been checked as a layer of hexahedra.
void make_section(const parameters::Mesh &parameters, const LoadedMesh &loaded, Triangulation<2> &section) {
  constexpr auto unknown = static_cast<unsigned int>(-1);
  const std::size_t n_nodes = loaded.mesh.positions.size();
  std::vector<unsigned int> vertex_of(n_nodes, unknown), node_of;
  std::vector<unsigned int> above(n_nodes, unknown);
  std::vector<dealii::Point<2>> vertices;
  std::vector<dealii::CellData<2>> cells;
  constexpr std::array<unsigned int, 4> corners{0, 1, 3, 2}; // deal.II's places of corners in turn
  for (const FileHexahedron &hexahedron : loaded.mesh.hexahedra) {
    cells.emplace_back();
    for (unsigned int i = 0; i < 4; ++i) {
      const unsigned int node = hexahedron.nodes[i];
      if (vertex_of[node] == unknown) {
        vertex_of[node] = static_cast<unsigned int>(vertices.size());
        vertices.emplace_back(loaded.mesh.positions[node][0], loaded.mesh.positions[node][1]);
        node_of.push_back(node);
      }
      above[node] = hexahedron.nodes[i + 4];
      cells.back().vertices[corners[i]] = vertex_of[node];
    }
  }
  try {
    const AssertionsThrow refusals_are_errors;
    dealii::GridTools::consistently_order_cells(cells);
    section.create_triangulation(vertices, cells, dealii::SubCellData());
  } catch (const std::exception &error) {
    throw misfit(parameters, "quadrilaterals", error);
  }
  for (const auto &cell : section.active_cell_iterators())
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary()) {
        const unsigned int a = node_of[cell->face(f)->vertex_index(0)],
                           b = node_of[cell->face(f)->vertex_index(1)];
        BoundaryGroups::Face nodes{a, b, above[a], above[b]};
        std::sort(nodes.begin(), nodes.end());
        cell->face(f)->set_boundary_id(loaded.groups.id(nodes));
      }
}

/// Gives both sides of a section from a file ids above those of its groups, as load_mesh_file()
/// announces.
void name_sides(const LoadedMesh &loaded, const Triangulation<2> &section, Triangulation<3> &mesh) {
  unsigned int largest = 0;
  for (const unsigned int id : section.get_boundary_ids())
    largest = std::max(largest, id);
  // deal.II has given them the next two ids.
  for (const auto &face : mesh.active_face_iterators())
    if (face->at_boundary() && face->boundary_id() > largest)
      face->set_boundary_id(loaded.groups.new_id() + face->boundary_id() - largest - 1);
}

/// Moves the vertices by the mesh's 'Positions': x, y and z of a body, x and y of a section.
template <int dim> void move_vertices(const parameters::Mesh &parameters, Triangulation<dim> &mesh) {
  std::vector<Expression> components;
  for (const auto &component : parameters.positions.value)
    components.emplace_back(component, Expression::Variables::time_and_position,
                            std::vector<parameters::Amplitude>(), parameters.positions.origin);
  if (components.empty())
    return;
  check_before_start([&] {
    dealii::GridTools::transform(
        [&components](const dealii::Point<dim> &x) {
          dealii::Point<3> before;
          dealii::Point<dim> moved;
          for (unsigned int i = 0; i < dim; ++i)
            before[i] = x[i];
          for (unsigned int i = 0; i < dim; ++i)
            moved[i] = components[i].value(0., before);
          return moved;
        },
        mesh);
  });
}

void generate_extruded(const parameters::Mesh &parameters, const MeshDetail detail, Triangulation<3> &mesh) {
  Triangulation<2> refined, section;
  std::unique_ptr<const LoadedMesh> loaded;
  if (parameters.source == parameters::Mesh::Source::file) {
    loaded = std::make_unique<const LoadedMesh>(load_mesh_file(parameters));
    make_section(parameters, *loaded, refined);
  } else
    generate_primitive(parameters, refined);
  if (detail == MeshDetail::full && loaded)
    refined.refine_global(parameters.refinements);
  else if (detail == MeshDetail::full)
    refine_primitive(parameters, refined);
  dealii::GridGenerator::flatten_triangulation(refined, section);
  section.reset_all_manifolds();
  if (parameters.section_area.value > 0.)
    dealii::GridTools::scale(std::sqrt(parameters.section_area.value / dealii::GridTools::volume(section)),
                             section);
  if (parameters.section.value == parameters::Mesh::Section::axisymmetric) {
    move_vertices(parameters, section);
    turn_section(parameters, section, mesh);
  } else {
    const unsigned int n_layers = detail == MeshDetail::full ? parameters.n_layers : 1;
    dealii::GridGenerator::extrude_triangulation(section, n_layers + 1, parameters.height, mesh);
  }
  if (loaded)
    name_sides(*loaded, section, mesh);
}

void read_file(const parameters::Mesh &parameters, Triangulation<3> &mesh, NodeSets &sets) {
  const LoadedMesh loaded = load_mesh_file(parameters);
  sets.take(loaded.mesh);
  std::vector<dealii::Point<3>> vertices;
  for (const auto &x : loaded.mesh.positions)
    vertices.emplace_back(x[0], x[1], x[2]);
  std::vector<dealii::CellData<3>> cells;
  for (const FileHexahedron &hexahedron : loaded.mesh.hexahedra) {
    cells.emplace_back();
    for (unsigned int i = 0; i < 8; ++i)
      cells.back().vertices[loaded.mesh.corners[i]] = hexahedron.nodes[i];
  }
  try {
    const AssertionsThrow refusals_are_errors;
    // As deal.II does with the files that it reads itself.
    dealii::GridTools::invert_all_negative_measure_cells(vertices, cells);
    dealii::GridTools::consistently_order_cells(cells);
    mesh.create_triangulation(vertices, cells, dealii::SubCellData());
  } catch (const std::exception &error) {
    throw misfit(parameters, "hexahedra", error);
  }
  for (const auto &cell : mesh.active_cell_iterators())
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary()) {
        BoundaryGroups::Face nodes{};
        for (unsigned int v = 0; v < nodes.size(); ++v)
          nodes[v] = cell->face(f)->vertex_index(v);
        std::sort(nodes.begin(), nodes.end());
        cell->face(f)->set_boundary_id(loaded.groups.id(nodes));
      }
}

/// Replaces `mesh` by a copy of its active cells, without manifolds.
void flatten(Triangulation<3> &mesh) {
  if (mesh.n_levels() > 1) {
    Triangulation<3> copy;
    dealii::GridGenerator::flatten_triangulation(mesh, copy);
    mesh.clear();
    mesh.copy_triangulation(copy);
  }
  mesh.reset_all_manifolds();
}

void rename_boundaries(const parameters::Mesh &parameters, Triangulation<3> &mesh) {
  for (const auto &[id, condition] : parameters.boundary_ids.value) {
    const Expression is_inside(condition, Expression::Variables::time_and_position, {},
                               parameters.boundary_ids.origin);
    check_before_start([&, id = id] {
      for (const auto &face : mesh.active_face_iterators())
        if (face->at_boundary() && is_inside.value(0., face->center()) != 0.)
          face->set_boundary_id(id);
    });
  }
}

/// Keeps the volumes of a mesh file that the body takes.
VolumeChoice take_volumes(const parameters::Mesh &parameters, MeshFile &mesh) {
  try {
    return choose_volumes(mesh, parameters.volumes.value);
  } catch (const std::invalid_argument &error) {
    throw InputError(parameters.volumes.origin + " " + error.what());
  }
}

} // namespace

LoadedMesh load_mesh_file(const parameters::Mesh &parameters) {
  const bool is_plane = parameters.section.value != parameters::Mesh::Section::solid;
  try {
    MeshFile mesh = is_plane ? read_plane_mesh_file(parameters.file_name.value)
                             : read_mesh_file(parameters.file_name.value);
    VolumeChoice volumes = take_volumes(parameters, mesh);
    const auto &distance = parameters.merged_distance.value;
    NearNodes near_nodes = mend_and_check(mesh,
                                          !distance        ? DoubledNodes::refused
                                          : *distance > 0. ? DoubledNodes::merged
                                                           : DoubledNodes::kept,
                                          distance.value_or(0.));
    BoundaryGroups groups(mesh, min_new_id(parameters));
    return {std::move(mesh), std::move(groups), std::move(volumes), std::move(near_nodes)};
  } catch (const std::invalid_argument &error) {
    throw InputError(parameters.file_name.origin + " is '" + parameters.file_name.value +
                     "'; allowed is a mesh of " + (is_plane ? "quadrilaterals" : "hexahedra") +
                     " in one of the formats .msh, .vtk, .inp, .ucd: " + error.what());
  }
}

namespace {

/// Refuses 'Positions' that leave no volume. An outline may have none where the full mesh has one,
/// such as a bar that is rolled to a ring. Then the full mesh decides.
void check_positions(const parameters::Body &body, const MeshDetail detail, const Triangulation<3> &mesh) {
  const std::string axis = missing_extent(mesh);
  if (body.mesh.positions.value.empty() || axis.empty())
    return;
  if (detail == MeshDetail::full)
    throw InputError(body.mesh.positions.origin + " leave the body no extent along " + axis +
                     "; allowed are expressions that keep its volume");
  Triangulation<3> full;
  build_body_mesh(body, MeshDetail::full, full);
}

} // namespace

void build_body_mesh(const parameters::Body &body, const MeshDetail detail, Triangulation<3> &mesh,
                     NodeSets *const sets) {
  const parameters::Mesh &parameters = body.mesh;
  NodeSets unused, &of_file = sets != nullptr ? *sets : unused;
  switch (parameters.source) {
  case parameters::Mesh::Source::extruded:
    generate_extruded(parameters, detail, mesh);
    break;
  case parameters::Mesh::Source::primitive:
    generate_primitive(parameters, mesh);
    if (detail == MeshDetail::full)
      refine_primitive(parameters, mesh);
    break;
  case parameters::Mesh::Source::file:
    if (parameters.section.value != parameters::Mesh::Section::solid) {
      generate_extruded(parameters, detail, mesh);
      break;
    }
    read_file(parameters, mesh, of_file);
    for (unsigned int i = 0; detail == MeshDetail::full && i < parameters.refinements; ++i) {
      mesh.refine_global(1);
      of_file.refine(mesh);
    }
    break;
  }
  flatten(mesh);
  if (parameters.section.value != parameters::Mesh::Section::axisymmetric)
    move_vertices(parameters, mesh);
  check_positions(body, detail, mesh);
  if (parameters.scale != 1.)
    dealii::GridTools::scale(parameters.scale, mesh);
  if (parameters.rotation_angle != 0.)
    dealii::GridTools::rotate(parameters.rotation_axis, parameters.rotation_angle, mesh);
  if (parameters.translation.norm() > 0.)
    dealii::GridTools::shift(parameters.translation, mesh);
  fit_to_planes(body, mesh);
  rename_boundaries(parameters, mesh);
}

namespace {

template <int dim> bool has_curves_in(const parameters::Mesh &parameters) {
  Triangulation<dim> mesh;
  generate_primitive(parameters, mesh);
  const auto ids = mesh.get_manifold_ids();
  return std::any_of(ids.begin(), ids.end(),
                     [](const auto id) { return id != dealii::numbers::flat_manifold_id; });
}

} // namespace

bool has_curves(const parameters::Mesh &parameters) {
  const bool is_section = parameters.source == parameters::Mesh::Source::extruded ||
                          parameters.section.value != parameters::Mesh::Section::solid;
  return is_section ? has_curves_in<2>(parameters) : has_curves_in<3>(parameters);
}

std::size_t count_full_elements(const parameters::Mesh &parameters, const Triangulation<3> &outline) {
  const bool is_extruded = parameters.source == parameters::Mesh::Source::extruded ||
                           parameters.section.value != parameters::Mesh::Section::solid;
  const unsigned int per_refinement = is_extruded ? 4 : 8;
  std::size_t count = outline.n_active_cells();
  count *= is_extruded ? parameters.n_layers : 1;
  for (unsigned int i = 0; i < parameters.refinements; ++i)
    count *= per_refinement;
  return count;
}

void merge_bodies(const std::vector<const Triangulation<3> *> &meshes, Triangulation<3> &merged) {
  std::vector<dealii::Point<3>> vertices;
  std::vector<dealii::CellData<3>> cells;
  std::vector<dealii::types::boundary_id> face_ids;
  for (std::size_t body = 0; body < meshes.size(); ++body) {
    const auto offset = static_cast<unsigned int>(vertices.size());
    const auto &body_vertices = meshes[body]->get_vertices();
    vertices.insert(vertices.end(), body_vertices.begin(), body_vertices.end());
    for (const auto &cell : meshes[body]->active_cell_iterators()) {
      dealii::CellData<3> data;
      for (const unsigned int v : cell->vertex_indices())
        data.vertices[v] = offset + cell->vertex_index(v);
      data.material_id = static_cast<dealii::types::material_id>(body);
      cells.push_back(data);
      for (const unsigned int f : cell->face_indices())
        face_ids.push_back(cell->face(f)->at_boundary() ? cell->face(f)->boundary_id()
                                                        : dealii::numbers::internal_face_boundary_id);
    }
  }
  merged.create_triangulation(vertices, cells, dealii::SubCellData());
  // Cells and their faces keep the order of their creation.
  std::size_t next = 0;
  for (const auto &cell : merged.active_cell_iterators())
    for (const unsigned int f : cell->face_indices()) {
      if (cell->face(f)->at_boundary())
        cell->face(f)->set_boundary_id(face_ids[next]);
      ++next;
    }
}

} // namespace billet
