// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/mesh_builder.h"

#include "billet/errors.h"
#include "billet/scene/expression.h"

#include <deal.II/base/utilities.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/grid_tools.h>

#include <array>
#include <cmath>
#include <sstream>

namespace billet {

using dealii::Triangulation;

namespace {

/// Returns the part of an exception's message that names the problem, on one line; deal.II surrounds its own
/// with rulers, and breaks it into lines.
std::string essence(const std::exception &error) {
  std::istringstream lines(error.what());
  std::string line, result;
  bool after_information = false;
  while (std::getline(lines, line)) {
    if (line.find("Additional information") != std::string::npos) {
      after_information = true;
      continue;
    }
    if (!after_information)
      continue;
    if (!line.empty() && line[0] == '-')
      break;
    std::istringstream words(line);
    for (std::string word; words >> word;)
      result += (result.empty() ? "" : " ") + word;
  }
  return result;
}

template <int dim> std::string describe_refusal(const parameters::Mesh &parameters) {
  return parameters.primitive.origin + " is '" + parameters.primitive.value + "' with arguments '" +
         parameters.arguments + "'; allowed is the name of a " + std::to_string(dim) +
         "-dimensional function of deal.II's GridGenerator with all its arguments without default. ";
}

/// Numbers of elements among the arguments of deal.II's primitives: index of the argument, and how many
/// numbers it has. deal.II checks them in Debug builds only. Without a check, zero, a negative number or a
/// fraction ends the program, or never terminates.
struct Counts {
  const char *primitive;
  unsigned int argument, n;
};

template <int dim> void check_counts(const parameters::Mesh &parameters) {
  constexpr std::array<Counts, 5> all{{{"subdivided_hyper_rectangle", 0, dim},
                                       {"subdivided_hyper_cube", 0, 1},
                                       {"subdivided_cylinder", 0, 1},
                                       {"cheese", 0, dim},
                                       {"moebius", 0, 1}}};
  constexpr double maximum = 1e9;
  for (const Counts &counts : all) {
    if (parameters.primitive.value != counts.primitive)
      continue;
    const auto arguments = dealii::Utilities::split_string_list(parameters.arguments, ':');
    if (arguments.size() <= counts.argument)
      return; // deal.II reports missing arguments
    const std::string &argument = arguments[counts.argument];
    if (argument.find(';') != std::string::npos)
      return; // lists of the elements' sizes
    const auto numbers = dealii::Utilities::split_string_list(argument, ',');
    bool is_sound = numbers.size() == counts.n;
    double product = 1.;
    for (const auto &number : numbers) {
      is_sound = is_sound && !number.empty() && number.find_first_not_of("0123456789") == std::string::npos;
      product *= is_sound ? std::stod(number) : 1.;
    }
    if (!is_sound || product < 1. || product > maximum)
      throw InputError(describe_refusal<dim>(parameters) + "Argument " + std::to_string(counts.argument + 1) +
                       " has to be " + std::to_string(counts.n) + " whole number" +
                       (counts.n > 1 ? "s" : "") + " of elements > 0, not '" + argument + "'");
  }
}

/// Lets deal.II's assertions throw instead of aborting, during its lifetime: the user provides the arguments
/// of meshes.
class AssertionsThrow {
public:
  AssertionsThrow() { dealii::deal_II_exceptions::disable_abort_on_exception(); }
  ~AssertionsThrow() { dealii::deal_II_exceptions::enable_abort_on_exception(); }
  AssertionsThrow(const AssertionsThrow &) = delete;
  AssertionsThrow &operator=(const AssertionsThrow &) = delete;
};

template <int dim> void generate_primitive(const parameters::Mesh &parameters, Triangulation<dim> &mesh) {
  check_counts<dim>(parameters);
  try {
    const AssertionsThrow refusals_are_errors;
    dealii::GridGenerator::generate_from_name_and_arguments(mesh, parameters.primitive.value,
                                                            parameters.arguments);
  } catch (const std::exception &error) {
    throw InputError(describe_refusal<dim>(parameters) + essence(error));
  }
  if (mesh.n_active_cells() == 0)
    throw InputError(parameters.primitive.origin + " is '" + parameters.primitive.value +
                     "' with arguments '" + parameters.arguments +
                     "'; allowed are arguments for which GridGenerator makes a mesh");
}

void generate_extruded(const parameters::Mesh &parameters, const MeshDetail detail, Triangulation<3> &mesh) {
  Triangulation<2> refined, section;
  generate_primitive(parameters, refined);
  if (detail == MeshDetail::full)
    refined.refine_global(parameters.refinements);
  dealii::GridGenerator::flatten_triangulation(refined, section);
  section.reset_all_manifolds();
  if (parameters.section_area.value > 0.)
    dealii::GridTools::scale(std::sqrt(parameters.section_area.value / dealii::GridTools::volume(section)),
                             section);
  const unsigned int n_layers = detail == MeshDetail::full ? parameters.n_layers : 1;
  dealii::GridGenerator::extrude_triangulation(section, n_layers + 1, parameters.height, mesh);
}

void read_file(const parameters::Mesh &parameters, Triangulation<3> &mesh) {
  dealii::GridIn<3> grid_in;
  grid_in.attach_triangulation(mesh);
  try {
    grid_in.read(parameters.file_name.value);
  } catch (const std::exception &error) {
    throw InputError(parameters.file_name.origin + " is '" + parameters.file_name.value +
                     "'; allowed is a hexahedral mesh in one of the formats .msh, .vtk, .ucd, .inp, .vtu. " +
                     essence(error));
  }
  if (!mesh.all_reference_cells_are_hyper_cube())
    throw InputError(parameters.file_name.origin + " is '" + parameters.file_name.value +
                     "', which has cells other than hexahedra; allowed are hexahedra only");
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

void move_vertices(const parameters::Mesh &parameters, Triangulation<3> &mesh) {
  std::vector<Expression> components;
  for (const auto &component : parameters.positions.value)
    components.emplace_back(component, Expression::Variables::time_and_position,
                            std::vector<parameters::Amplitude>(), parameters.positions.origin);
  check_before_start([&] {
    dealii::GridTools::transform(
        [&components](const dealii::Point<3> &x) {
          return dealii::Point<3>(components[0].value(0., x), components[1].value(0., x),
                                  components[2].value(0., x));
        },
        mesh);
  });
}

void rename_boundaries(const parameters::Mesh &parameters, Triangulation<3> &mesh) {
  for (const auto &[id, condition] : parameters.boundary_ids.value) {
    const Expression holds(condition, Expression::Variables::time_and_position, {},
                           parameters.boundary_ids.origin);
    check_before_start([&, id = id] {
      for (const auto &face : mesh.active_face_iterators())
        if (face->at_boundary() && holds.value(0., face->center()) != 0.)
          face->set_boundary_id(id);
    });
  }
}

} // namespace

void build_body_mesh(const parameters::Body &body, const MeshDetail detail, Triangulation<3> &mesh) {
  const parameters::Mesh &parameters = body.mesh;
  switch (parameters.source) {
  case parameters::Mesh::Source::extruded:
    generate_extruded(parameters, detail, mesh);
    break;
  case parameters::Mesh::Source::primitive:
    generate_primitive(parameters, mesh);
    if (detail == MeshDetail::full)
      mesh.refine_global(parameters.refinements);
    break;
  case parameters::Mesh::Source::file:
    read_file(parameters, mesh);
    if (detail == MeshDetail::full)
      mesh.refine_global(parameters.refinements);
    break;
  }
  flatten(mesh);
  if (!parameters.positions.value.empty())
    move_vertices(parameters, mesh);
  if (parameters.scale != 1.)
    dealii::GridTools::scale(parameters.scale, mesh);
  if (parameters.rotation_angle != 0.)
    dealii::GridTools::rotate(parameters.rotation_axis, parameters.rotation_angle, mesh);
  if (parameters.translation.norm() > 0.)
    dealii::GridTools::shift(parameters.translation, mesh);
  rename_boundaries(parameters, mesh);
}

std::size_t count_full_elements(const parameters::Mesh &parameters, const Triangulation<3> &outline) {
  const bool is_extruded = parameters.source == parameters::Mesh::Source::extruded;
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
