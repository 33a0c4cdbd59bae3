// SPDX-License-Identifier: LGPL-2.1-or-later
// Laws of rubber in scenes: a brick in four modes against the point and Rivlin's simple shear, with every
// element; static, implicit dynamic and explicit; relaxation; Rivlin's torsion of a cylinder; a bonded disc
// that does not lock; a sphere inflated past its maximum pressure; a cylinder pressed flat.

#include "../material/rubber_laws.h"
#include "explicit_run.h"
#include "scene_run.h"

#include <fstream>
#include <map>

namespace rubber_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using billet::testing::WorstError;
using dealii::Tensor;

namespace {

const char *const elements[] = {"assumed strain", "mean dilatation", "one point"};

/// Lines of a material, with moduli in units of `unit` [stress].
std::map<std::string, std::string> materials(const double unit, const std::string &volume) {
  const auto number = [&](const double value) { return std::to_string(value * unit); };
  return {{"Mooney-Rivlin", "set Elasticity = Mooney-Rivlin\nset C10 = " + number(0.293) +
                                "\nset C01 = " + number(0.177) + volume},
          {"Yeoh", "set Elasticity = Yeoh\nset C10 = " + number(0.184343) +
                       "\nset C20 = " + number(-0.0021273) + "\nset C30 = " + number(4.95955e-5) + volume},
          {"Ogden", "set Elasticity = Ogden\nset Ogden moduli = " + number(0.63) + ", " + number(0.0012) +
                        ", " + number(-0.01) + "\nset Ogden exponents = 1.3, 5, -2" + volume},
          {"Arruda-Boyce", "set Elasticity = Arruda-Boyce\nset Chain modulus = " + number(0.3) +
                               "\nset Locking stretch = 3" + volume}};
}

/// A unit cube of one brick. `supports`: subsections.
std::string brick(const std::string &element, const std::string &material, const std::string &supports) {
  return "subsection Bodies\n  subsection cube\n    set Element = " + element +
         "\n    subsection Mesh\n      set Primitive = subdivided_hyper_rectangle\n"
         "      set Arguments = 1, 1, 1 : 0, 0, 0 : 1, 1, 1 : true\n    end\n    subsection Material\n" +
         material + "\nset Density = 1e-9\n    end\n" + supports + "  end\nend\n";
}

std::string support(const std::string &name, const unsigned int face, const std::string &component,
                    const std::string &displacement) {
  return "      subsection " + name + "\n        set Boundary ids = " + std::to_string(face) +
         "\n        set Components = " + component + "\n        set Displacement = " + displacement +
         "\n      end\n";
}

parameters::Scene read(const std::string &bodies, const std::string &time) {
  const bool is_explicit = time.find("explicit") != std::string::npos;
  std::ofstream("rubber.prm") << bodies << "subsection Time stepping\n"
                              << time << "end\nsubsection Output\n  set Format = none\nend\n"
                              << (is_explicit ? ""
                                              : "subsection Solver\n  set Force tolerance = 1e-10\n"
                                                "  set Energy tolerance = 1e-15\nend\n");
  return parameters::Scene::read("rubber.prm");
}

const Resultant &reaction(const SceneRun &run, const std::string &name) {
  const std::vector<NamedSupport> supports = named_supports(run.scene);
  for (std::size_t i = 0; i < supports.size(); ++i)
    if (supports[i].name == name)
      return run.problem.reactions().of_supports.at(i);
  throw std::logic_error("no " + name);
}

const std::string symmetry = "    set Symmetry planes = x = 0 ; y = 0 ; z = 0\n    subsection Supports\n",
                  end_of_supports = "    end\n";

/// Modes of a brick that is pulled along z.
struct Mode {
  std::string name, supports;
  bool is_free[2]; ///< along x and y
  double factor;   ///< of the stretch along x, if it is that of z
};

/// Nominal stress along z of a law with the free directions relaxed, by bisection.
double exact_force(const SpatialLaw &law, const Mode &mode, const double stretch) {
  testing::Point point(law);
  Tensor<2, 3> F = testing::unit;
  F[2][2] = stretch;
  if (mode.factor > 0.)
    F[0][0] = stretch;
  double low = 0.05, high = 4.;
  dealii::SymmetricTensor<2, 3> tau;
  for (unsigned int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    for (unsigned int k = 0; k < 2; ++k)
      if (mode.is_free[k])
        F[k][k] = middle;
    tau = point.evaluate(F, 0.);
    (tau[mode.is_free[1] ? 1 : 0][mode.is_free[1] ? 1 : 0] > 0. ? high : low) = middle;
  }
  return tau[2][2] / stretch;
}

void test_modes() {
  const std::string along = "0 ; 0 ; 0.6*t", time = "  set End time = 1\n  set Step control = fixed\n"
                                                    "  set Initial step = 0.125\n";
  const Mode modes[] = {
      {"uniaxial", support("top", 5, "z", along), {true, true}, 0.},
      {"equibiaxial",
       support("top", 5, "z", along) + support("side", 1, "x", "0.6*t ; 0 ; 0"),
       {false, true},
       1.},
      {"planar", support("top", 5, "z", along) + support("side", 1, "x", "0 ; 0 ; 0"), {false, true}, 0.}};
  unsigned int i = 0;
  const char *const volumes[] = {"\nset Poisson ratio = 0.49", "\nset Bulk modulus = 30",
                                 "\nset Bulk modulus = 30\nset Volumetric law = quadratic",
                                 "\nset Poisson ratio = 0.499\nset Volumetric law = Ogden"};
  for (const auto &[name, lines] : materials(1., ""))
    for (const std::string element : elements) {
      WorstError error;
      const std::string material = lines + volumes[i++ % 4];
      for (const Mode &mode : modes) {
        SceneRun run(read(brick(element, material, symmetry + mode.supports + end_of_supports), time));
        run.finish();
        const auto law = std::dynamic_pointer_cast<const SpatialLaw>(run.scene.bodies()[0].law);
        const double exact = exact_force(*law, mode, 1.6);
        error.add(std::abs(reaction(run, "support top").force[2] / exact - 1.));
      }
      check(name + ", " + element + ", uniaxial, equibiaxial and planar tension", error.value(), 1e-8);
    }
}

const std::string sheared = "    subsection Supports\n" + support("bottom", 4, "x, y, z", "0 ; 0 ; 0") +
                            "      subsection top\n"
                            "        set Boundary ids = 5\n        set Displacement = amount*(t < 0.1 ? "
                            "t/0.1 : 1) ; 0 ; 0\n      end\n    end\n";

std::string shear_by(const double amount) {
  std::string text = sheared;
  text.replace(text.find("amount"), 6, std::to_string(amount));
  return text;
}

/// Rivlin's simple shear, then Prony's series at a constant shear.
void test_shear() {
  constexpr double gamma = 0.8, dt = 0.1;
  const double elastic = 2. * (0.293 + 0.177) * gamma;
  for (const std::string element : elements)
    for (const bool is_viscous : {false, true}) {
      const std::string material =
          materials(1., "\nset Poisson ratio = 0.4999").at("Mooney-Rivlin") +
          (is_viscous ? "\nset Prony moduli = 0.5, 0.2\nset Prony times = 0.3, 0.02" : "");
      SceneRun run(read(brick(element, material, shear_by(gamma)),
                        "  set End time = 1\n  set Step control = fixed\n  set Initial step = 0.1\n"));
      WorstError error;
      run.finish([&](const NewtonReport &) {
        double left = is_viscous ? 0.3 : 1.;
        const double t = run.problem.state().time;
        if (is_viscous)
          for (const auto &[g, tau] : {std::pair(0.5, 0.3), std::pair(0.2, 0.02)})
            left -= g * std::expm1(-dt / tau) * tau / dt * std::exp(-(t - dt) / tau);
        error.add(std::abs(reaction(run, "support top").force[0] / (left * elastic) - 1.));
      });
      check(element + (is_viscous ? ", relaxation in shear" : ", simple shear"), error.value(), 1e-8);
      if (is_viscous)
        check(element + ", it dissipates", run.problem.state().energies.plastic > 0.);
    }
}

/// A brick that moves: energies balance, and the end of a slow pull is that of statics.
void test_dynamics() {
  const std::string pull =
      symmetry + support("top", 5, "z", "0 ; 0 ; 0.4*(1 - cos(pi*t/5e-5))/2") + end_of_supports;
  for (const auto &[name, lines] : materials(1e5, "\nset Poisson ratio = 0.45"))
    for (const std::string element : elements) {
      const Mode uniaxial{"", "", {true, true}, 0.};
      testing::ExplicitRun moving(
          read(brick(element, lines, pull), "  set Scheme = explicit\n  set End time = 5e-5\n"));
      moving.finish(5e-5, [] {});
      const auto law = std::dynamic_pointer_cast<const SpatialLaw>(moving.scene.bodies()[0].law);
      double exact = 0.;
      for (unsigned int i = 0; i < 200; ++i) // work of the force
        exact += 0.4 / 200. * exact_force(*law, uniaxial, 1. + 0.4 * (i + 0.5) / 200.);
      check(name + ", " + element + ", explicit", std::abs(moving.state().energies.elastic / exact - 1.),
            1e-2);
      check(name + ", " + element + ", explicit, energies balance",
            std::abs(moving.state().energies.drift()) / exact, 1e-3);
      SceneRun run(read(brick(element, lines, pull),
                        "  set Scheme = implicit dynamics\n  set End time = 5e-5\n"
                        "  set Step control = fixed\n  set Initial step = 2.5e-6\n"));
      run.finish();
      check(name + ", " + element + ", implicit dynamics",
            std::abs(run.problem.state().energies.elastic / exact - 1.), 1e-2);
    }
  // Hencky's law and rubber with Prony's series: what the support gives is stored or dissipated.
  for (const std::string &material : {std::string("set Young modulus = 2e5\nset Poisson ratio = 0.45"),
                                      materials(1e5, "\nset Poisson ratio = 0.45").at("Ogden")}) {
    testing::ExplicitRun moving(
        read(brick("assumed strain", material + "\nset Prony moduli = 0.6\nset Prony times = 1.2e-5", pull),
             "  set Scheme = explicit\n  set End time = 5e-5\n"));
    moving.finish(5e-5, [] {});
    const EnergyLedger &energies = moving.state().energies;
    check("viscous, explicit, energies balance", std::abs(energies.drift()) / energies.elastic, 1e-3);
    check("viscous, explicit, dissipation", energies.plastic > 0.05 * energies.elastic);
  }
}

/// Rivlin (1949): a cylinder of radius a, twisted by q per length between ends that keep their distance,
/// takes T = π a⁴ q (C10 + C01) and N = −(π a⁴ q²/2)(C10 + 2 C01). The circle has 16 edges here; the radius
/// gives them the polar moment of area of the circle with a = 1.
void test_torsion(const std::string &element) {
  constexpr double q = 1., height = 0.4;
  const double angle = M_PI / 8.,
               polygon = 4. * std::sin(angle) * (2. + std::cos(angle)) / 3., // polar moment, circumradius 1
      radius = std::pow(0.5 * M_PI / polygon, 0.25);
  std::ostringstream text;
  text.precision(17);
  text << "subsection Bodies\n  subsection rod\n    set Element = " << element
       << "\n    subsection Mesh\n      set Source = extruded primitive\n      set Primitive = hyper_ball\n"
          "      set Arguments = 0, 0 : "
       << radius << "\n      set Height = " << height
       << "\n      set Layers = 8\n      set Refinements = 2\n    end\n    subsection Material\n"
       << materials(1., "\nset Poisson ratio = 0.499").at("Mooney-Rivlin")
       << "\n    end\n    subsection Supports\n      subsection bottom\n        set Boundary ids = 1\n"
          "      end\n      subsection top\n        set Boundary ids = 2\n        set Displacement = "
          "x*cos(a) - y*sin(a) - x ; x*sin(a) + y*cos(a) - y ; 0\n      end\n    end\n  end\nend\n";
  std::string bodies = text.str();
  const std::string turn = "(" + std::to_string(q * height) + "*t)";
  for (std::size_t at = 0; (at = bodies.find("(a)", at)) != std::string::npos;)
    bodies.replace(at, 3, turn);
  parameters::Scene scene = read(bodies, "  set End time = 1\n  set Initial step = 0.5\n");
  scene.solver.force_tolerance = 1e-5;
  scene.solver.energy_tolerance = 1e-9;
  SceneRun run(scene);
  run.finish();
  const Resultant &top = reaction(run, "support top");
  check(element + ", torsion, moment", std::abs(top.moment[2] / (M_PI * q * 0.47) - 1.), 1e-2);
  check(element + ", torsion, axial force",
        std::abs(top.force[2] / (-0.5 * M_PI * q * q * (0.293 + 2. * 0.177)) - 1.), 3e-2);
}

/// I_1(x)/I_0(x), by series.
double bessel_ratio(const double x) {
  double zero = 1., one = 0.5 * x, a = 1., b = 0.5 * x;
  for (unsigned int k = 1; k < 200; ++k) {
    a *= 0.25 * x * x / (k * k);
    b *= 0.25 * x * x / (k * (k + 1.));
    zero += a;
    one += b;
  }
  return one / zero;
}

/// A disc of radius 10 and thickness 1 between bonded plates, pulled by 0.1 %. Apparent modulus
/// κ (1 − 2 I_1(x)/(x I_0(x))), x = a √(12 G/κ)/t (Gent & Lindley 1959 with compressibility; Chalhoub & Kelly
/// 1990), good to a few parts in a hundred at this shape. An element that locks is several times too stiff.
void test_bonded(const std::string &element) {
  const double nu = 0.4999, G = 1., bulk = 2. * G * (1. + nu) / (3. * (1. - 2. * nu));
  const std::string bodies =
      "subsection Bodies\n  subsection disc\n    set Element = " + element +
      "\n    set Symmetry planes = z = 0\n    subsection Mesh\n      set Section = axisymmetric\n"
      "      set Wedge angle = 5\n      set Primitive = subdivided_hyper_rectangle\n"
      "      set Arguments = 20, 4 : 0, 0 : 10, 0.5 : true\n    end\n    subsection Material\n"
      "      set Elasticity = Mooney-Rivlin\n      set C10 = 0.3\n      set C01 = 0.2\n"
      "      set Poisson ratio = 0.4999\n    end\n    subsection Supports\n" +
      support("bonded", 3, "x, y, z", "0 ; 0 ; 0.0005*t") + "    end\n  end\nend\n";
  SceneRun run(read(bodies, "  set End time = 1\n  set Step control = fixed\n  set Initial step = 1\n"));
  run.finish();
  const double x = 10. * std::sqrt(12. * G / bulk), exact = bulk * (1. - 2. * bessel_ratio(x) / x),
               found = reaction(run, "support bonded").force[2] * 72. / (M_PI * 100. * 1e-3);
  check(element + ", a bonded disc does not lock", std::abs(found / exact - 1.), 0.05);
}

/// A thick sphere, inflated from inside by its displacement: p/µ = [2/l + 1/(2 l⁴)] at the outer less the
/// inner stretch (Green & Zerna 1968), past its maximum at a stretch of 1.85.
void test_sphere(const std::string &element) {
  const std::string bodies =
      "subsection Bodies\n  subsection shell\n    set Element = " + element +
      "\n    set Symmetry planes = z = 0\n    subsection Mesh\n      set Section = axisymmetric\n"
      "      set Wedge angle = 5\n      set Primitive = subdivided_hyper_rectangle\n"
      "      set Arguments = 8, 16 : 1, 0 : 2, 90 : true\n"
      "      set Positions = x*cos(pi/180*y) ; x*sin(pi/180*y)\n    end\n    subsection Material\n"
      "      set Elasticity = Mooney-Rivlin\n      set C10 = 0.5\n      set Poisson ratio = 0.4995\n    end\n"
      "    subsection Supports\n" +
      support("inside", 0, "x, y, z", "2*t*x ; 2*t*y ; 2*t*z") + "    end\n  end\nend\n";
  parameters::Scene scene =
      read(bodies, "  set End time = 1\n  set Initial step = 0.05\n  set Maximum step = 0.1\n");
  scene.solver.force_tolerance = 1e-6;
  scene.solver.energy_tolerance = 1e-10;
  SceneRun run(scene);
  WorstError error;
  const auto part = [](const double l) { return 2. / l + 0.5 * std::pow(l, -4.); };
  double last = 0., greatest = 0.;
  run.finish([&](const NewtonReport &) {
    const double l = 1. + 2. * run.problem.state().time, outer = std::cbrt(1. + (l * l * l - 1.) / 8.);
    last = reaction(run, "support inside").force[2] * run.scene.whole_section().factor / (M_PI * l * l);
    greatest = std::max(greatest, last);
    error.add(std::abs(last / (part(outer) - part(l)) - 1.));
  });
  check(element + ", pressure of a sphere", error.value(), 1e-2);
  check(element + ", it is past its maximum", last < 0.85 * greatest);
}

/// A cylinder of radius 200 pressed between frictionless plates to half of its height: 250 N per mm of width
/// at an approach of 100, 1400 N at 200, read from a graph (Sussman & Bathe 1987; verification manual of
/// ANSYS, VM201).
void test_pressed_cylinder() {
  const std::string scene =
      "subsection Bodies\n  subsection cylinder\n    set Symmetry planes = x = 0 ; y = 0\n"
      "    subsection Mesh\n      set Section = plane strain\n      set Height = 10\n"
      "      set Primitive = quarter_hyper_ball\n      set Arguments = 0, 0 : 200\n"
      "      set Refinements = 3\n    end\n    subsection Material\n      set Elasticity = Mooney-Rivlin\n"
      "      set C10 = 0.293\n      set C01 = 0.177\n      set Poisson ratio = 0.49967\n    end\n  end\nend\n"
      "subsection Tools\n  subsection plate\n    subsection Surfaces\n      subsection plane\n"
      "        set Point = 0, 200, 0\n        set Normal = 0, -1, 0\n      end\n    end\n"
      "    subsection Motion\n      set Translation = 0 ; -100*t ; 0\n    end\n  end\nend\n"
      "set Contact = all\nsubsection General contact\n  set Self-contact = false\nend\n";
  parameters::Scene parameters =
      read(scene, "  set End time = 1\n  set Stops = 0.5\n  set Initial step = 0.05\n"
                  "  set Maximum step = 0.1\n");
  parameters.solver.force_tolerance = 1e-3;
  parameters.solver.energy_tolerance = 1e-5;
  SceneRun run(parameters);
  run.finish([&](const NewtonReport &) {
    const double t = run.problem.state().time, force = 2. * std::abs(run.load().force[1]) / 10.;
    if (std::abs(t - 0.5) < 1e-9)
      check("a cylinder pressed by a quarter", std::abs(force / 250. - 1.), 0.04);
    if (std::abs(t - 1.) < 1e-9)
      check("a cylinder pressed by a half", std::abs(force / 1400. - 1.), 0.02);
  });
}

} // namespace

BILLET_MPI_TEST(rubber) {
  test_modes();
  test_shear();
  test_dynamics();
  for (const std::string element : {"assumed strain", "mean dilatation"})
    test_torsion(element);
  for (const std::string element : elements) {
    test_bonded(element);
    test_sphere(element);
  }
  test_pressed_cylinder();
}

} // namespace rubber_test
