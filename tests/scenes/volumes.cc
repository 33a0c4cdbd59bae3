// SPDX-License-Identifier: LGPL-2.1-or-later
// Two bodies from the volumes of one mesh file, which share the nodes between them, are pressed against each
// other as two bodies with meshes of their own: the same force. As one body of the softer material they would
// be softer.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

#include <fstream>

namespace volumes_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

/// A column of two cubes of 2 x 2 x 2 elements.
void write_mesh(const std::string &name) {
  std::ofstream out(name);
  const auto node = [](const unsigned int i, const unsigned int j, const unsigned int k) {
    return 1 + i + 3 * (j + 3 * k);
  };
  out << "*NODE\n";
  for (unsigned int k = 0; k < 5; ++k)
    for (unsigned int j = 0; j < 3; ++j)
      for (unsigned int i = 0; i < 3; ++i)
        out << node(i, j, k) << "," << 0.5 * i << "," << 0.5 * j << "," << 0.5 * k << "\n";
  for (const unsigned int first : {0U, 2U}) {
    out << "*ELEMENT, TYPE=C3D8, ELSET=" << (first == 0 ? "lower" : "upper") << "\n";
    for (unsigned int k = first; k < first + 2; ++k)
      for (unsigned int j = 0; j < 2; ++j)
        for (unsigned int i = 0; i < 2; ++i) {
          out << 1 + i + 2 * (j + 2 * k);
          for (const unsigned int above : {0U, 1U})
            out << "," << node(i, j, k + above) << "," << node(i + 1, j, k + above) << ","
                << node(i + 1, j + 1, k + above) << "," << node(i, j + 1, k + above);
          out << "\n";
        }
  }
}

std::string body(const std::string &name, const std::string &mesh, const double modulus,
                 const std::string &more) {
  return " subsection " + name + "\n  set Symmetry planes = x = 0 ; y = 0\n  subsection Mesh\n" + mesh +
         "  end\n  subsection Material\n   set Young modulus = " + std::to_string(modulus) +
         "\n   set Poisson ratio = 0.3\n  end\n" + more + " end\n";
}

/// Returns the force on a plane that presses the column.
double press(const std::string &lower, const std::string &upper, const std::string &pair) {
  std::ofstream("column.prm")
      << "subsection Bodies\n"
      << body(
             "lower", lower, 1000.,
             "  subsection Supports\n   subsection floor\n    set Boundary ids = floor\n    set Components = "
             "z\n   end\n  end\n")
      << body("upper", upper, 500., "")
      << "end\nsubsection Tools\n subsection die\n  subsection Surfaces\n   subsection all\n    set Point = "
         "0, "
         "0, 2\n    set Normal = 0, 0, -1\n   end\n  end\n  subsection Motion\n   set Translation = 0 ; 0 ; "
         "-0.02*t\n  end\n end\nend\nsubsection Contact pairs\n subsection top\n  set Body = upper\n  set "
         "Boundary ids = top\n  set Tool = die\n end\n subsection between\n  set Body = upper\n  set Second "
         "body = lower\n"
      << pair << " end\nend\n";
  const auto scene_parameters = parameters::Scene::read("column.prm");
  SceneRun run(scene_parameters);
  run.finish();
  return std::abs(run.load().force[2]);
}

} // namespace

BILLET_MPI_TEST(volumes) {
  write_mesh("column.inp");
  const std::string
      file = "   set Source = file\n   set File = column.inp\n   set Boundary ids = floor : z < 1e-9 "
             "; top : z > 1.999\n   set Volumes = ",
      box = "   set Primitive = subdivided_hyper_rectangle\n   set Boundary ids = floor : z < 1e-9 ; "
            "top : z > 1.999 ; joint : abs(z - 1) < 1e-9\n   set Arguments = 2, 2, 2 : ";
  const double of_file =
                   press(file + "lower\n", file + "UPPER\n",
                         "  set Boundary ids = interface\n  set Second boundary ids = interface upper\n"),
               of_boxes = press(box + "0, 0, 0 : 1, 1, 1\n", box + "0, 0, 1 : 1, 1, 2\n",
                                "  set Boundary ids = joint\n  set Second boundary ids = joint\n");
  check("the same force", std::abs(of_file / of_boxes - 1.), 1e-8);
  check("that of two materials in a row", std::abs(of_file / (0.02 / (1. / 1000. + 1. / 500.)) - 1.), 0.1);
}

} // namespace volumes_test
