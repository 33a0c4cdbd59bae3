// SPDX-License-Identifier: LGPL-2.1-or-later
// Every primitive of the table makes a mesh from its necessary arguments alone, in a scene; its faces have
// the boundary ids that the table says, at the places that it says.
#include "billet/parameters/primitives.h"
#include "billet/errors.h"
#include "billet/parameters/scene.h"
#include "billet/scene/mesh_builder.h"

#include "../testing.h"

#include <deal.II/base/mpi.h>
#include <deal.II/grid/grid_tools.h>

#include <fstream>
#include <map>
#include <set>

namespace primitives_test {

using namespace billet;
using parameters::Primitive;

namespace {

/// Necessary arguments of primitives that have some, for two and three dimensions.
const std::map<std::string, std::array<std::string, 2>> necessary = {
    {"subdivided_hyper_rectangle", {"2, 3", "2, 3, 1"}},
    {"subdivided_hyper_cube", {"2", "2"}},
    {"general_cell", {"0,0; 2,0; 0,1; 2,1", "0,0,0; 2,0,0; 0,1,0; 2,1,0; 0,0,1; 2,0,1; 0,1,1; 2,1,1"}},
    {"simplex", {"0,0; 1,0; 0,1", "0,0,0; 1,0,0; 0,1,0; 0,0,1"}},
    {"hyper_cross", {"1, 0, 1, 2", "1, 0, 0, 0, 1, 1"}},
    {"cheese", {"1, 2", "1, 1, 2"}},
    {"hyper_shell", {": 1 : 2", ": 1 : 2"}},
    {"half_hyper_shell", {": 1 : 2", ": 1 : 2"}},
    {"quarter_hyper_shell", {": 1 : 2", ": 1 : 2"}},
    {"eccentric_hyper_shell", {"0, 0 : 0.1, 0 : 1 : 2 : 8", "0, 0, 0 : 0.1, 0, 0 : 1 : 2 : 6"}},
    {"subdivided_cylinder", {"", "3"}},
    {"cylinder_shell", {"", "3 : 1 : 2"}},
    {"torus", {"", "3 : 1"}},
    {"moebius", {"", "8 : 1 : 3 : 1"}}};

parameters::Scene read_scene(const Primitive &primitive, const std::string &arguments) {
  std::ofstream("scene.prm") << "subsection Bodies\nsubsection body\nsubsection Mesh\nset Source = "
                             << (primitive.dimension == 2 ? "extruded primitive" : "primitive")
                             << "\nset Primitive = " << primitive.name << "\nset Arguments = " << arguments
                             << "\nend\nsubsection Material\nset Law = elastic\nset Young modulus = 1\nend\n"
                             << "end\nend\n";
  return parameters::Scene::read("scene.prm", "");
}

/// Centre of the faces with each boundary id, and of the mesh's box.
struct Faces {
  std::map<unsigned int, dealii::Tensor<1, 3>> centres;
  dealii::Point<3> low, high;
};

Faces make_faces(const Primitive &primitive, const std::string &arguments) {
  dealii::Triangulation<3> mesh;
  build_body_mesh(read_scene(primitive, arguments).bodies[0], MeshDetail::full, mesh);
  Faces faces;
  std::map<unsigned int, double> areas;
  for (const auto &face : mesh.active_face_iterators())
    if (face->at_boundary()) {
      faces.centres[face->boundary_id()] += face->measure() * face->center();
      areas[face->boundary_id()] += face->measure();
    }
  for (auto &[id, sum] : faces.centres)
    sum /= areas[id];
  const auto box = dealii::GridTools::compute_bounding_box(mesh).get_boundary_points();
  faces.low = box.first;
  faces.high = box.second;
  return faces;
}

/// Whether the faces are where "least x" and its like say, which are planes.
bool is_there(const std::string &meaning, const dealii::Tensor<1, 3> &centre, const Faces &faces) {
  if (meaning.size() < 2 || meaning[meaning.size() - 2] != ' ')
    return true;
  const auto axis = static_cast<unsigned int>(meaning.back() - 'x');
  if (axis > 2)
    return true;
  const double size = (faces.high - faces.low).norm();
  if (meaning.rfind("least ", 0) == 0)
    return std::abs(centre[axis] - faces.low[axis]) < 1e-9 * size;
  if (meaning.rfind("largest ", 0) == 0)
    return std::abs(centre[axis] - faces.high[axis]) < 1e-9 * size;
  return true;
}

void test(const Primitive &primitive) {
  const auto given = necessary.find(primitive.name);
  const std::string name = primitive.name + " " + std::to_string(primitive.dimension);
  const Faces faces =
      make_faces(primitive, given == necessary.end() ? "" : given->second[primitive.dimension - 2]);
  std::set<unsigned int> found, expected;
  bool are_there = true;
  unsigned int largest = 0;
  for (const auto &boundary : primitive.boundaries) {
    expected.insert(boundary.id);
    largest = std::max(largest, boundary.id);
    const auto face = faces.centres.find(boundary.id);
    are_there = are_there && face != faces.centres.end() && is_there(boundary.meaning, face->second, faces);
  }
  if (primitive.dimension == 2) // the bottom and the top of the extrusion
    expected.insert({largest + 1, largest + 2});
  for (const auto &face : faces.centres)
    found.insert(face.first);
  testing::check(name + ": ids", found == expected);
  testing::check(name + ": places", are_there);
  if (primitive.dimension == 2)
    testing::check(name + ": bottom and top", std::abs(faces.centres.at(largest + 1)[2]) < 1e-12 &&
                                                  std::abs(faces.centres.at(largest + 2)[2] - 1.) < 1e-12);
}

std::string refusal(const std::string &name, const unsigned int dimension, const std::string &arguments) {
  try {
    complete_arguments(*parameters::find_primitive(name, dimension), arguments);
  } catch (const std::invalid_argument &error) {
    return error.what();
  }
  return "";
}

bool ends_with(const std::string &text, const std::string &end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

void test_arguments() {
  const auto complete = [](const std::string &name, const std::string &arguments) {
    return parameters::complete_arguments(*parameters::find_primitive(name, 3), arguments);
  };
  testing::check("defaults", complete("hyper_rectangle", "") == "0, 0, 0 : 1, 1, 1 : true");
  testing::check("some defaults",
                 complete("hyper_rectangle", "0,0,0 : 10,10,10") == "0,0,0 : 10,10,10 : true");
  testing::check("all arguments are kept",
                 complete("hyper_rectangle", "0,0,0 : 2, 1,1 : false") == "0,0,0 : 2, 1,1 : false");
  testing::check("an empty argument", complete("hyper_ball", ": 3") == "0, 0, 0 : 3 : false");
  testing::check("names", complete("hyper_ball", "radius = 3 : centre = 1, 2, 3") == "1, 2, 3 : 3 : false");
  testing::check("names after values", complete("subdivided_cylinder", "4 : half length = 2") == "4 : 1 : 2");
  testing::check("sizes", complete("subdivided_hyper_rectangle", "1,1;2;1 : 0,0,0 : 2,2,1") ==
                              "1,1;2;1 : 0,0,0 : 2,2,1 : true");

  testing::check("a missing argument",
                 ends_with(refusal("torus", 3, "3"), "with a value for 'section radius'"));
  testing::check("one too many", ends_with(refusal("cylinder", 3, "1 : 2 : 3"),
                                           "2 arguments, separated by colons; '3' is one too many"));
  testing::check("twice", ends_with(refusal("cylinder", 3, "1 : radius = 2"), "with one value for 'radius'"));
  testing::check("a typo", ends_with(refusal("cylinder", 3, "raduis = 2"),
                                     "no argument 'raduis'; did you mean 'radius'?"));
  testing::check("a value after a name", ends_with(refusal("cylinder", 3, "half length = 2 : 1"),
                                                   "names for all arguments after a named one"));
  testing::check("a separator of thousands",
                 ends_with(refusal("cylinder", 3, "200,000"),
                           "not '200,000'; write 200000, without separators of thousands"));
  testing::check("a decimal comma",
                 ends_with(refusal("cylinder", 3, "0,25"), "not '0,25'; write 0.25, with a decimal point"));
  testing::check("a unit",
                 refusal("cylinder", 3, "5 mm").find("; write 5, without 'mm'") != std::string::npos);
  testing::check("a point of two numbers",
                 ends_with(refusal("hyper_rectangle", 3, "0, 0 : 1, 1, 1"),
                           "where 'first corner' is 3 numbers, separated by commas, not '0, 0'"));
  testing::check("no radius",
                 ends_with(refusal("hyper_ball", 3, ": 0"), "where 'radius' is a number > 0, not '0'"));
  for (const std::string counts : {"0, 1, 1", "1, 1", "1, 1, 1.0", "1, 1, -1", "99999, 99999, 1"})
    testing::check("not elements: " + counts, !refusal("subdivided_hyper_rectangle", 3, counts).empty());
}

} // namespace

BILLET_MPI_TEST(primitives) {
  for (const Primitive &primitive : parameters::primitives())
    test(primitive);
  test_arguments();
}

} // namespace primitives_test
