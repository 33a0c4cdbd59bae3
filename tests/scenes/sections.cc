// SPDX-License-Identifier: LGPL-2.1-or-later
// Models in two dimensions. An axisymmetric ring: its volume, its widening under pressure (Lamé: u(a) =
// p a/E ((a² + b²)/(b² − a²) + ν), free along the axis), and the force on the full circle that presses it
// together, turned and moved, too; from a file with a two-dimensional mesh, too. A disc up to the axis under
// pressure on its rim has one stress everywhere: u = −(1 − ν) p r/E. Explicit, its least stable step is not
// set by the prisms on the axis alone. A layer in plane strain, pressed together: force per width
// E/(1 − ν²) ε h.
#include "scene_run.h"

#include "billet/output/history_quantity.h"
#include "billet/scene/section_geometry.h"

#include <deal.II/base/mpi.h>

#include <fstream>
#include <map>

namespace sections_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

using dealii::Tensor;

constexpr double young = 1000., poisson = 0.3, inner = 10., outer = 20., height = 4., shortening = 4e-4;

parameters::Scene read(const std::string &mesh, const std::string &body) {
  const std::string file = "sections.prm";
  const bool is_file = mesh.find("set File") != std::string::npos;
  std::ofstream(file)
      << "subsection Bodies\n  subsection body\n    subsection Mesh\n"
      << (is_file ? "" : "      set Primitive = subdivided_hyper_rectangle\n") << mesh
      << "    end\n    subsection Material\n      set Law = elastic\n"
         "      set Young modulus = 1000\n      set Poisson ratio = 0.3\n    end\n"
      << body
      << "  end\nend\nsubsection Time stepping\n  set End time = 1\n  set Step control = fixed\n"
         "  set Initial step = 1\nend\nsubsection Output\n  set Format = none\nend\n";
  return parameters::Scene::read(file);
}

// The section's edges are 0 to 3: inner, outer, bottom, top.
const std::string ring =
    "      set Arguments = 20, 2 : 10, 0 : 20, 4 : true\n      set Section = axisymmetric\n"
    "      set Wedge angle = 3\n";

std::string press(const std::string &axes, const std::string &component) {
  std::string text = "    subsection Supports\n";
  for (const bool is_top : {false, true}) {
    text += std::string("      subsection ") + (is_top ? "top" : "bottom") +
            "\n        set Boundary ids = " + (is_top ? "3" : "2") +
            "\n        set Components = " + component + "\n" + axes;
    if (is_top)
      text += std::string("        set Displacement = ") +
              (component == "y" ? "0 ; -4e-4*t ; 0" : "0 ; 0 ; -4e-4*t") + "\n";
    text += "      end\n";
  }
  return text + "    end\n";
}

/// Forces in the whole on the first support, from the history.
Tensor<1, 3> whole_force(const SceneRun &run, const std::string &column) {
  const std::vector<double> probes;
  const HistorySample sample{run.problem.state(),      1, 1., nullptr, run.problem.reactions(), probes,
                             run.scene.whole_section()};
  for (const HistoryQuantity &quantity : history_quantities()) {
    if (quantity.name != "forces in the whole of a section")
      continue;
    const std::vector<std::string> columns = quantity.columns(run.scene);
    const std::vector<double> values = quantity.evaluate(sample);
    for (std::size_t i = 0; i + 2 < columns.size() && columns.size() == values.size(); ++i)
      if (columns[i] == column)
        return Tensor<1, 3>({values[i], values[i + 1], values[i + 2]});
  }
  return Tensor<1, 3>({std::nan(""), 0., 0.});
}

/// `inside`: id or name of the inner faces.
void check_ring(const std::string &name, const std::string &mesh, const std::string &inside) {
  const double pressure = 0.01;
  SceneRun run(read(mesh, "    set Symmetry planes = z = 0\n    subsection Loads\n      subsection gas\n"
                          "        set Boundary ids = " +
                              inside + "\n        set Pressure = 0.01\n      end\n    end\n"));
  double volume = 0.;
  testing::WorstError widening, side;
  run.finish();
  const double exact = pressure * inner / young *
                       ((inner * inner + outer * outer) / (outer * outer - inner * inner) + poisson);
  for (const auto &element : run.discretization.elements(0)) {
    volume += element.cell->measure();
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const auto &x = element.cell->vertex(a);
      Tensor<1, 3> u;
      for (unsigned int i = 0; i < 3; ++i)
        u[i] = run.problem.state().displacements(element.dofs[3 * a + i]);
      const double radius = std::hypot(x[0], x[1]);
      if (radius < inner * (1. + 1e-6))
        widening.add(std::abs((u[0] * x[0] + u[1] * x[1]) / radius / exact - 1.));
      side.add(std::abs(u[1] * x[0] - u[0] * x[1]) / radius / exact);
    }
  }
  check(
      name + ": volume of the full circle",
      std::abs(run.scene.whole_section().factor * volume / (M_PI * (outer * outer - inner * inner) * height) -
               1.),
      1e-12);
  check(name + ": widening", widening.value(), 3e-3);
  check(name + ": no displacement around the axis", side.value(), 1e-8);
}

/// Writes the ring's section as Gmsh does, in a plane z = 1: its edges are two groups.
std::string write_ring() {
  constexpr unsigned int n_x = 20, n_y = 2;
  std::ofstream file("ring.msh");
  file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 1 \"inside\"\n1 2 \"bottom\"\n"
          "$EndPhysicalNames\n$Nodes\n"
       << (n_x + 1) * (n_y + 1) << "\n";
  const auto node = [](const unsigned int i, const unsigned int j) { return 1 + i + (n_x + 1) * j; };
  for (unsigned int j = 0; j <= n_y; ++j)
    for (unsigned int i = 0; i <= n_x; ++i)
      file << node(i, j) << " " << inner + (outer - inner) * i / n_x << " " << height * j / n_y << " 1\n";
  file << "$EndNodes\n$Elements\n" << n_x * n_y + n_x + n_y << "\n";
  unsigned int number = 0;
  for (unsigned int j = 0; j < n_y; ++j)
    file << ++number << " 1 2 1 1 " << node(0, j) << " " << node(0, j + 1) << "\n";
  for (unsigned int i = 0; i < n_x; ++i)
    file << ++number << " 1 2 2 2 " << node(i, 0) << " " << node(i + 1, 0) << "\n";
  for (unsigned int j = 0; j < n_y; ++j)
    for (unsigned int i = 0; i < n_x; ++i) // clockwise
      file << ++number << " 3 2 3 1 " << node(i, j) << " " << node(i, j + 1) << " " << node(i + 1, j + 1)
           << " " << node(i + 1, j) << "\n";
  file << "$EndElements\n";
  return "      set Source = file\n      set File = ring.msh\n      set Section = axisymmetric\n"
         "      set Wedge angle = 3\n";
}

const std::string disc =
    "      set Arguments = 5, 2 : 0, 0 : 20, 4 : true\n      set Section = axisymmetric\n"
    "      set Wedge angle = 3\n";

void check_disc() {
  const double pressure = 0.01;
  SceneRun run(read(disc, "    set Symmetry planes = z = 0\n    subsection Loads\n      subsection oil\n"
                          "        set Boundary ids = 1\n        set Pressure = 0.01\n      end\n    end\n"));
  run.finish();
  testing::WorstError error;
  for (const auto &element : run.discretization.elements(0))
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const auto &x = element.cell->vertex(a);
      Tensor<1, 3> exact = pressure / young * Tensor<1, 3>(x);
      exact[0] *= poisson - 1.;
      exact[1] *= poisson - 1.;
      exact[2] *= 2. * poisson;
      for (unsigned int i = 0; i < 3; ++i)
        error.add(std::abs(run.problem.state().displacements(element.dofs[3 * a + i]) - exact[i]) /
                  (pressure / young * outer));
    }
  check("disc up to the axis: one stress everywhere", error.value(), 1e-4); // pressure and stress, of E
}

void check_pressed_ring(const std::string &name, const std::string &motion, const std::string &axes,
                        const Tensor<1, 3> &axis) {
  SceneRun run(read(ring + motion, press(axes, "z")));
  run.finish();
  const double exact = young * shortening / height * M_PI * (outer * outer - inner * inner);
  const Tensor<1, 3> force = whole_force(run, "body.support top.full_circle_force_x");
  check(name + ": force on the full circle", (force / exact + axis).norm(), 1e-3);
}

/// A load in the whole of the section: traction times area.
void check_traction(const std::string &name, const std::string &mesh, const std::string &planes,
                    const std::string &traction, const std::string &column, const Tensor<1, 3> &exact) {
  SceneRun run(
      read(mesh, "    set Symmetry planes = " + planes +
                     "\n    subsection Loads\n      subsection weight\n        set Type = dead traction\n"
                     "        set Boundary ids = 3\n        set Traction = " +
                     traction + "\n      end\n    end\n"));
  run.finish();
  const Tensor<1, 3> force = whole_force(run, "body.load weight." + column);
  check(name, (force - exact).norm() / exact.norm(), 1e-10);
}

const std::string layer =
    "      set Arguments = 2, 2 : 0, 0 : 5, 4 : true\n      set Section = plane strain\n"
    "      set Height = 2\n";

void check_layer() {
  SceneRun run(read(layer, "    set Symmetry planes = x = 0\n" + press("", "y")));
  run.finish();
  const double exact = young / (1. - poisson * poisson) * shortening / height * 5.;
  const Tensor<1, 3> force = whole_force(run, "body.support top.force_per_width_x");
  check("layer: force per width", (force / exact + Tensor<1, 3>({0., 1., 0.})).norm(), 1e-3);
}

/// The angles at which a section is compared with its solid: no symmetry of up to twelve axes, however it is
/// turned, has the same value at all of them.
void check_places() {
  const parameters::Scene scene = read(disc, "");
  const SectionGeometry section(scene.bodies.front().mesh);
  for (unsigned int n = 1; n <= 12; ++n) {
    double least = 2.;
    for (unsigned int i = 0; i < 360; ++i) {
      double low = 1., high = -1.;
      for (const auto &x : section.places(Tensor<1, 3>({2., 0., 1.}))) {
        const double value = std::cos(n * (std::atan2(x[1], x[0]) + i * M_PI / 180.));
        low = std::min(low, value);
        high = std::max(high, value);
      }
      least = std::min(least, high - low);
    }
    check("places: symmetry of " + std::to_string(n) + " axes", least > 0.2);
  }
}

/// Nodes and points of a section are on both sides of the layer or wedge: both move alike. `body`: supports
/// and loads.
void check_sides(const std::string &name, const std::string &mesh, const std::string &body) {
  SceneRun run(read(mesh, body));
  run.finish();
  const bool is_wedge = mesh.find("axisymmetric") != std::string::npos;
  // Displacement in the section of each of its points, from the first of its nodes.
  std::map<std::array<long, 2>, Tensor<1, 3>> known;
  testing::WorstError difference;
  double largest = 0.;
  for (const auto &element : run.discretization.elements(0))
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const auto &x = element.cell->vertex(a);
      Tensor<1, 3> u;
      for (unsigned int i = 0; i < 3; ++i)
        u[i] = run.problem.state().displacements(element.dofs[3 * a + i]);
      const double radius = std::hypot(x[0], x[1]);
      if (is_wedge && radius > 0.)
        u = Tensor<1, 3>({(u[0] * x[0] + u[1] * x[1]) / radius, (u[1] * x[0] - u[0] * x[1]) / radius, u[2]});
      const auto number = [](const double length) { return std::lround(1e6 * length); };
      const auto [first, is_new] =
          known.insert({{number(is_wedge ? radius : x[0]), number(is_wedge ? x[2] : x[1])}, u});
      if (!is_new)
        difference.add((u - first->second).norm());
      largest = std::max(largest, u.norm());
    }
  check(name + ": it moves", largest > 1e-6);
  check(name + ": both sides move alike", difference.value() / largest, 1e-8);
}

void check_refusal(const std::string &name, const std::string &mesh, const std::string &expected) {
  std::string message;
  try {
    const parameters::Scene scene = read(mesh, press("", "z"));
    const SceneRun run(scene);
  } catch (const InputError &error) {
    message = error.what();
  }
  check(name, message.find(expected) != std::string::npos);
}

} // namespace

BILLET_MPI_TEST(sections) {
  check_ring("ring", ring, "0");
  check_ring("ring from a file", write_ring(), "inside");
  check_disc();
  check_places();
  check_pressed_ring("pressed ring", "", "", Tensor<1, 3>({0., 0., 1.}));
  check_pressed_ring(
      "turned ring",
      "      set Rotation axis = 0, 1, 0\n      set Rotation angle = 90\n"
      "      set Translation = 1, 2, 3\n",
      "        set Axes = local\n        set First axis = 0, 1, 0\n        set Second axis = 0, "
      "0, 1\n",
      Tensor<1, 3>({1., 0., 0.}));
  check_layer();
  const auto support = [](const std::string &node, const std::string &components) {
    return "    subsection Supports\n      subsection rest\n        set Nodes = at " + node +
           "\n        set Components = " + components + "\n      end\n    end\n";
  };
  const auto force = [](const std::string &at, const std::string &vector) {
    return "    subsection Loads\n      subsection push\n        set Type = force\n        set " + at +
           "\n        set Force = " + vector + "\n      end\n    end\n";
  };
  for (const std::string &at : {std::string("Nodes = at 2.5, 4, 0"), std::string("Point = 2.4, 3.9, 0"),
                                std::string("Point = 2.5, 4, 0\n        set Place = nearest node")})
    check_sides("layer, " + at.substr(0, at.find('\n')), layer,
                support("0, 0, 0 ; at 5, 0, 0", "x, y") + force(at, "0.1 ; -0.2 ; 0"));
  for (const std::string &at : {std::string("Nodes = at 8, 0, 4"), std::string("Point = 9, 0, 3.9"),
                                std::string("Point = 0, 0, 4\n        set Place = nearest node")})
    check_sides("wedge, " + at.substr(0, at.find('\n')), disc,
                support("20, 0, 0", "z") + force(at, "0.01 ; 0 ; -0.02"));

  check_traction("load on a ring", ring, "z = 0", "0 ; 0 ; -0.01", "full_circle_force_x",
                 Tensor<1, 3>({0., 0., -0.01 * M_PI * (outer * outer - inner * inner)}));
  check_traction("load on a layer", layer, "x = 0 ; y = 0", "0.002, -0.01, 0", "force_per_width_x",
                 Tensor<1, 3>({0.01, -0.05, 0.}));
  check_refusal("a section across the axis is refused",
                "      set Arguments = 4, 2 : -1, 0 : 20, 4 : true\n      set Section = axisymmetric\n",
                "begins at the radius x = -1; allowed are sections with x >= 0");
}

} // namespace sections_test
