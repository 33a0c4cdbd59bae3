// SPDX-License-Identifier: LGPL-2.1-or-later
// A load that the library does not know, a traction of fixed direction on undeformed faces, registered here
// and named by scenes: a cube that it stretches slowly, against the closed form of uniaxial tension, and one
// that it sets in motion, against its momentum.

#include "../scenes/explicit_run.h"
#include "../scenes/scene_run.h"

#include "billet/loads/load.h"
#include "billet/vector_text.h"

#include <deal.II/base/mpi.h>

#include <fstream>

namespace added_load_test {

using namespace billet;
using billet::testing::check;

namespace {

/// F_a = A_a t, where t is a force per undeformed area.
class AddedTraction final : public DeadLoad<NodalLoad> {
public:
  void add_forces(const std::vector<LoadedNode> &nodes, const LoadValues &values,
                  const NodalMotion & /*motion*/, double *forces) const override {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const double *t = values.at(k);
      add_vector(forces, nodes[k].node, nodes[k].area * dealii::Tensor<1, 3>({t[0], t[1], t[2]}));
    }
  }
};

LoadType added_traction_type() {
  return {"added traction",
          "on the undeformed faces, in a fixed direction",
          {loaded_faces(),
           {"Traction", "0 ; 0 ; 0", TypeParameter::Kind::text,
            "Three expressions of the undeformed position, the time t and the names of amplitudes. "
            "[stress]"}},
          [](const TypeInput &input) {
            Load load{{}, std::make_shared<const AddedTraction>()};
            for (const std::string &component : read_expressions(input, "Traction"))
              load.expressions.push_back({"Traction", component, true});
            return load;
          }};
}

/// F_a = −c A_a v_a on the undeformed faces: a load on faces that limits explicit steps by its damping.
class ViscousFaces final : public FaceLoad {
public:
  explicit ViscousFaces(const double damping) : damping_(damping) {}

  void add_forces(const std::vector<LoadedFace> &faces, const LoadValues & /*values*/,
                  const NodalMotion &motion, double *forces) const override {
    for (const LoadedFace &face : faces)
      for (unsigned int a = 0; a < 4; ++a)
        add_vector(forces, face.nodes[a],
                   -damping_ * face.areas[a] * get_vector(motion.velocities, face.nodes[a]));
  }
  LoadTangent tangent() const override { return LoadTangent::symmetric; }
  Bound bound(const LoadedSurface & /*surface*/) const override { return {0., damping_}; }
  std::vector<dealii::Tensor<1, 3>> supports(const dealii::Tensor<1, 3> & /*normal*/) const override {
    return {};
  }

private:
  double damping_;
};

LoadType viscous_faces_type() {
  return {"viscous faces",
          "against the velocity of the undeformed faces",
          {loaded_faces(),
           {"Viscosity", "0", TypeParameter::Kind::number,
            "c >= 0. Force per area and velocity. "
            "[stress time/length]"}},
          [](const TypeInput &input) {
            return Load{{}, std::make_shared<const ViscousFaces>(input.not_negative("Viscosity"))};
          }};
}

constexpr double young = 200e3, density = 7.8e-9;

/// A unit cube of eight bricks with this traction on its upper face.
parameters::Scene make_cube(const bool is_explicit, const std::string &planes, const std::string &traction,
                            const double end) {
  const std::string file = is_explicit ? "explicit.prm" : "implicit.prm";
  std::ofstream text(file);
  text.precision(17);
  text << "subsection Bodies\n"
          "  subsection cube\n"
          "    set Symmetry planes = "
       << planes
       << "\n"
          "    subsection Mesh\n"
          "      set Primitive = subdivided_hyper_rectangle\n"
          "      set Arguments = 2, 2, 2 : 0, 0, 0 : 1, 1, 1 : true\n"
          "    end\n"
          "    subsection Material\n"
          "      set Law = elastic\n"
          "      set Young modulus = "
       << young << "\n      set Poisson ratio = 0.3\n      set Density = " << density
       << "\n"
          "    end\n"
          "    subsection Loads\n"
          "      subsection pull\n"
          "        set Type = added traction\n"
          "        set Boundary ids = 5\n"
          "        set Traction = "
       << traction
       << "\n"
          "      end\n"
          "    end\n"
          "  end\n"
          "end\n"
          "subsection Time stepping\n"
          "  set Scheme = "
       << (is_explicit ? "explicit" : "implicit dynamics") << "\n  set End time = " << end << "\n";
  if (!is_explicit)
    text << "  set Step control = fixed\n  set Initial step = " << end / 50 << "\n";
  text << "end\n"
          "subsection Output\n"
          "  set Format = none\n"
          "end\n";
  text.close();
  return parameters::Scene::read(file);
}

/// A cube that moves along z, and that viscous faces hold, ten times stiffer than its waves: without the
/// bound of the load, steps would be eight times too long.
void check_viscous_faces() {
  std::ofstream text("viscous.prm");
  text << "subsection Bodies\n"
          "  subsection cube\n"
          "    set Initial velocity = 0 ; 0 ; 1\n"
          "    subsection Mesh\n"
          "      set Primitive = subdivided_hyper_rectangle\n"
          "      set Arguments = 2, 2, 2 : 0, 0, 0 : 1, 1, 1 : true\n"
          "    end\n"
          "    subsection Material\n"
          "      set Law = elastic\n"
          "      set Young modulus = "
       << young << "\n      set Poisson ratio = 0.3\n      set Density = " << density
       << "\n"
          "    end\n"
          "    subsection Loads\n"
          "      subsection brake\n"
          "        set Type = viscous faces\n"
          "        set Boundary ids = 4, 5\n"
          "        set Viscosity = "
       << 10. * std::sqrt(young * density)
       << "\n"
          "      end\n"
          "    end\n"
          "  end\n"
          "end\n"
          "subsection Time stepping\n"
          "  set Scheme = explicit\n"
          "  set End time = 1e-6\n"
          "end\n"
          "subsection Output\n"
          "  set Format = none\n"
          "end\n";
  text.close();
  testing::ExplicitRun run(parameters::Scene::read("viscous.prm"));
  run.finish(1e-6, [] {});
  // A wave loses a third of its energy at each of the five times that it comes to a face.
  const double energy = run.state().energies.kinetic + run.state().energies.elastic;
  check("viscous faces: they take most of the energy, in stable steps", energy < 0.25 * 0.5 * density);
}

/// Stretch λ of E ln λ/λ = t, the nominal stress of uniaxial Hencky tension.
double stretch_of(const double t) {
  double low = 1., high = 2.;
  for (unsigned int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (std::log(middle) / middle * young < t ? low : high) = middle;
  }
  return low;
}

template <class Run>
void check_tension(const std::string &name, const Run &run, const SolutionState &state,
                   const double traction) {
  double height = 0.;
  for (const auto &element : run.discretization.elements(0))
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      height = std::max(height, element.cell->vertex(a)[2] + state.displacements(element.dofs[3 * a + 2]));
  const double strain = std::log(stretch_of(traction)), energy = 0.5 * young * strain * strain;
  check(name + ": stretch", std::abs(height / stretch_of(traction) - 1.), 1e-4);
  check(name + ": elastic energy", std::abs(state.energies.elastic / energy - 1.), 2e-3);
  check(name + ": work", std::abs(state.energies.external / energy - 1.), 2e-3);
}

} // namespace

BILLET_MPI_TEST(added_load) {
  load_types().add(added_traction_type());
  load_types().add(viscous_faces_type());

  // Slow: 50 times what a wave takes through the cube and back.
  constexpr double duration = 4e-5, traction = 1e4;
  const std::string planes = "x = 0 ; y = 0 ; z = 0", slow = "0 ; 0 ; 1e4*(1 - cos(pi*t/4e-5))/2";
  {
    testing::ExplicitRun run(make_cube(true, planes, slow, duration));
    run.finish(duration, [] {});
    check_tension("explicit", run, run.state(), traction);
  }
  {
    testing::SceneRun run(make_cube(false, planes, slow, duration));
    run.finish();
    check_tension("implicit", run, run.problem.state(), traction);
  }

  // Free: the resultant of 10 (1 + x) along x sets the cube in motion.
  constexpr double end = 1e-6, impulse = 15. * end;
  {
    testing::ExplicitRun run(make_cube(true, "", "10*(1 + x) ; 0 ; 0", end));
    run.finish(end, [] {});
    check("explicit: momentum", std::abs(run.state().momentum[0] / impulse - 1.), 1e-10);
  }
  {
    testing::SceneRun run(make_cube(false, "", "10*(1 + x) ; 0 ; 0", end));
    run.finish();
    check("implicit: momentum", std::abs(run.problem.state().momentum[0] / impulse - 1.), 1e-2);
  }
  check_viscous_faces();
}

} // namespace added_load_test
