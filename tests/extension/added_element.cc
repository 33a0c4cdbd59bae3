// SPDX-License-Identifier: LGPL-2.1-or-later
// An element that the library does not know, the fully integrated brick, registered here and named by a
// scene: uniaxial tension against mean dilatation, which is the same where the strain is uniform, in statics
// and explicitly; advice where it locks in bending; a parameter of its own, kept by a checkpoint.

#include "../scenes/restart_run.h"
#include "pulled_cube.h"

#include "billet/diagnostic_kinds.h"
#include "billet/material/elasticity.h"
#include "billet/mechanics/element_comparison.h"
#include "billet/mechanics/law_block.h"
#include "billet/output/local_state.h"
#include "billet/scene/plausibility.h"
#include "billet/solve/element_watch.h"

namespace added_element_test {

using namespace billet;
using billet::testing::check;

namespace {

/// Q1 with 2 × 2 × 2 points: F as it is. A part of the volume is solid, the rest is holes.
class FullyIntegratedElement {
public:
  static constexpr unsigned int n_points = n_element_points;
  static constexpr bool is_stabilised = false, is_layered = false;
  using Reference = ReferenceElement;
  struct Kinematics {
    std::array<dealii::Tensor<2, 3>, n_points> F;
    std::array<Gradients<n_element_nodes>, n_points> gradients;
    std::array<double, n_points> J;
    double volume;
  };
  using Stresses = std::array<dealii::SymmetricTensor<2, 3>, n_points>;

  FullyIntegratedElement(const ElasticModuli &, const ElementFormulation &formulation)
      : solid_part_(formulation.constants.empty() ? 1. : formulation.constants[0]) {}

  bool initialize(const ElementVectors &positions, Reference &reference) const {
    const bool is_sound = compute_reference_element(positions, reference);
    for (double &volume : reference.volumes)
      volume *= solid_part_;
    return is_sound;
  }
  static bool compute(const Reference &reference, const ElementVectors &displacements,
                      Kinematics &kinematics) {
    MeanDilatationKinematics mean;
    if (!compute_kinematics(reference, displacements, mean))
      return false;
    kinematics.volume = mean.current_volume;
    for (unsigned int q = 0; q < n_points; ++q) {
      kinematics.J[q] = mean.current_volumes[q] / reference.volumes[q];
      kinematics.F[q] = std::cbrt(kinematics.J[q] / mean.volume_ratio) * mean.F_bar[q];
      kinematics.gradients[q] = mean.gradients[q];
    }
    return true;
  }

  template <bool>
  static const dealii::Tensor<2, 3> &deformation(const Reference &, const Kinematics &kinematics,
                                                 const unsigned int q) {
    return kinematics.F[q];
  }
  static double volume_ratio(const Kinematics &kinematics, const unsigned int q) { return kinematics.J[q]; }
  static double reference_volume(const Reference &reference, const unsigned int q) {
    return reference.volumes[q];
  }
  static double current_volume(const Kinematics &kinematics) { return kinematics.volume; }
  template <bool> static double weight(const Reference &reference, const Kinematics &, const unsigned int q) {
    return reference.volumes[q];
  }

  template <bool>
  static void add_force(const Reference &reference, const Kinematics &kinematics, const Stresses &tau,
                        ElementVectors &force) {
    for (unsigned int q = 0; q < n_points; ++q) {
      const auto product = multiply_gradients(tau[q], kinematics.gradients[q]);
      for (unsigned int k = 0; k < n_element_dofs; ++k)
        force[k] += reference.volumes[q] * product[k];
    }
  }

  template <bool is_symmetrised, class Moduli>
  void compute_tangent(const Reference &reference, const Kinematics &kinematics, const Stresses &tau,
                       const std::array<Moduli, n_points> &moduli, ElementMatrix &matrix) const {
    matrix.fill(0.);
    for (unsigned int q = 0; q < n_points; ++q)
      add(reference.volumes[q], kinematics.gradients[q], tau[q], moduli[q], matrix);
    if constexpr (is_symmetrised)
      symmetrise(matrix);
  }
  static void compute_symmetric_tangent(const Reference &reference, const Kinematics &kinematics,
                                        const Stresses &tau,
                                        const std::array<SpatialModuli, n_points> &moduli,
                                        ElementMatrix &matrix) {
    FullyIntegratedElement({}, {}).compute_tangent<false>(reference, kinematics, tau, moduli, matrix);
  }

private:
  double solid_part_;

  static void add(const double w, const Gradients<n_element_nodes> &g,
                  const dealii::SymmetricTensor<2, 3> &tau, const SpatialModuli &moduli,
                  ElementMatrix &matrix) {
    add_point_tangent(w, g, tau, moduli, matrix.data(), n_element_dofs);
  }
  /// The rows of the moduli are those of dev τ; the pressure's is added.
  void add(const double w, const Gradients<n_element_nodes> &g, const dealii::SymmetricTensor<2, 3> &tau,
           const GradientModuli &moduli, ElementMatrix &matrix) const {
    auto rates = multiply_gradients(moduli, g);
    for (unsigned int r = 0; r < 3; ++r)
      for (unsigned int k = 0; k < n_element_dofs; ++k)
        rates[r][k] += moduli.volumetric * g[k / 3][k % 3];
    add_point_tangent(w, g, tau, rates, matrix.data(), n_element_dofs);
  }
};

constexpr ElementKind kind = {"fully integrated",
                              &make_law_block<FullyIntegratedElement>,
                              false,
                              false,
                              {},
                              &compare_points<FullyIntegratedElement>,
                              /*may_lock_in_bending=*/true};
const BrickElement fully_integrated(kind);

const char *const solid_part = "Solid part";

ElementType make_type() {
  return make_element_type(
      fully_integrated, "eight points, for comparisons",
      {{solid_part, "1", TypeParameter::Kind::number, "Part without holes, from 0 to 1."}},
      [](const TypeInput &input, ElementChoice &choice) {
        choice.constants = {input.positive(solid_part)};
        if (choice.constants[0] > 1.)
          input.reject(solid_part, "a number from 0 to 1");
      });
}

constexpr double quick = 5e-5; // s

const std::string plastic = "set Young modulus = 200e3\nset Poisson ratio = 0.3\nset Yield stress = 300\n"
                            "set Hardening modulus = 500\nset Elasticity = ",
                  elastic = "set Law = elastic\nset Young modulus = 200e3\nset Poisson ratio = 0.3";

/// A brick of 5 x 3 x 1, bent about y, against the closed forms of the element, with σ_xx by κ + 4/3 G and
/// the shear besides, and of a plate that cannot bend across.
void check_bending() {
  constexpr double young = 1000., poisson = 0.3, length = 5.;
  const ElasticModuli moduli = ElasticModuli::from_young_poisson(young, poisson);
  ElementVectors x{}, u{};
  for (unsigned int a = 0; a < n_element_nodes; ++a) {
    x[3 * a] = (a & 1U) != 0U ? length : 0.;
    x[3 * a + 1] = (a & 2U) != 0U ? 3. : 0.;
    x[3 * a + 2] = (a & 4U) != 0U ? 1. : 0.;
    u[3 * a] = 1e-5 * (x[3 * a] - 0.5 * length) * (x[3 * a + 2] - 0.5);
  }
  ElementFormulation formulation;
  formulation.element = fully_integrated;
  ElementEnergies energies;
  const double exact = (moduli.bulk + 4. / 3. * moduli.shear + moduli.shear * length * length) *
                       (1. - poisson * poisson) / young;
  check("its stiffness in bending is compared",
        ElementComparison(make_hencky_law(moduli), formulation).compare(x, u, energies) &&
            std::abs(energies.factor() / exact - 1.) < 1e-3);
}

/// The factors of a probe at a face are those that the kind tells, and without any those of displacements.
PlaneFactors twice(const ElasticModuli &, const ElementFormulation &, const ElementVectors &, unsigned int) {
  return {2., 3.};
}
constexpr ElementKind kind_with_factors = {
    "with factors", &make_law_block<FullyIntegratedElement>, false, false, {}, nullptr, false, false, &twice};

/// Returns the stress at the upper face of the unit cube, whose points have the deviator diag(2, 0, −2) above
/// and the opposite below.
dealii::SymmetricTensor<2, 3> stress_at_face(const BrickElement element) {
  ElementFormulation formulation;
  formulation.element = element;
  ElementPoints points;
  ElementData data{{}, {}, {}, &points};
  for (unsigned int a = 0; a < n_element_nodes; ++a) {
    for (unsigned int i = 0; i < 3; ++i)
      data.positions[3 * a + i] = (a >> i) & 1U;
    points.stress[a].deviator[0][0] = (a & 4U) != 0U ? 2. : -2.;
    points.stress[a].deviator[2][2] = -points.stress[a].deviator[0][0];
  }
  const SharedLaw law = make_hencky_law(ElasticModuli::from_young_poisson(1e9, 0.25));
  return LocalStates(law, formulation).evaluate(data, dealii::Point<3>(0.5, 0.5, 1.)).cauchy_stress;
}

void check_plane_factors() {
  // At the face, √3 times the points: deviator 2 √3 along x, 0 along y; half its trace in both, and the rest.
  const double mean = std::sqrt(3.), rest = std::sqrt(3.);
  const auto own = stress_at_face(BrickElement(kind_with_factors)), none = stress_at_face(fully_integrated),
             other = stress_at_face(BrickElement::mean_dilatation);
  check("a probe at a face uses the factors of the added element",
        std::abs(own[0][0] - (2. * mean + 3. * rest)) + std::abs(own[1][1] - (2. * mean - 3. * rest)), 1e-12);
  const double of_poisson = 3. * 1.25 / 0.75; // 3 (1 + ν)/(1 − ν)
  check("without any, those of displacements",
        std::abs(none[0][0] - (of_poisson * mean + rest)) + std::abs(none[1][1] - (of_poisson * mean - rest)),
        1e-12);
  check("as mean dilatation", (none - other).norm() == 0.);
}

/// A cantilever with one brick through its thickness.
void check_advice() {
  std::ofstream("cantilever.prm") << R"(
subsection Bodies
  subsection strip
    set Element = fully integrated
    subsection Mesh
      set Primitive = subdivided_hyper_rectangle
      set Arguments = 4, 1, 1 : 0, 0, 0 : 20, 3, 1 : true
    end
    subsection Material
      set Law = elastic
      set Young modulus = 1000
      set Poisson ratio = 0.3
    end
    subsection Supports
      subsection root
        set Boundary ids = 0
        set Components = x, y, z
      end
      subsection tip
        set Boundary ids = 1
        set Components = z
        set Displacement = 0 ; 0 ; 0.1*t
      end
    end
  end
end
subsection Time stepping
  set Step control = fixed
  set Initial step = 1
end
subsection Output
  set Format = none
end
)";
  testing::SceneRun run(parameters::Scene::read("cantilever.prm"));
  run.finish();
  const DiagnosticList before = check_bricks(run.scene);
  check("the check warns that its long bricks may lock in bending",
        find(before, diagnostic::bricks_may_lock) != nullptr);
  const DiagnosticList after = ElementWatch(run.scene, run.discretization).watch(run.problem.state(), true);
  const Diagnostic *message = find(after, diagnostic::element_too_stiff);
  check("the run warns that they are too stiff", message != nullptr);
  check("and recommends assumed strains",
        message != nullptr && message->advice() == "Use 'Element = assumed strain'");
}

/// The parameter of the element scales forces and energies, and the history knows it: a run that resumes with
/// another one begins from stresses.
void check_parameter() {
  const std::string half = "fully integrated\n    set Solid part = 0.5", law = plastic + "Hencky";
  const auto whole = testing::pull("fully integrated", law, 1.2, 1., 10),
             part = testing::pull(half, law, 1.2, 1., 10);
  check("half of it is solid, statics", std::abs(part.plastic / (0.5 * whole.plastic) - 1.), 1e-9);
  const auto fast = testing::pull_explicitly("fully integrated", law, 1.2, quick),
             fast_part = testing::pull_explicitly(half, law, 1.2, quick);
  check("half of it is solid, explicit", std::abs(fast_part.plastic / (0.5 * fast.plastic) - 1.), 2e-3);
  const auto scene_of = [&](const std::string &element) {
    return testing::read_pulled_cube(element, law, 1.2, 1., false, 10);
  };
  testing::History ignored, rest, expected;
  testing::ImplicitSolutionRun first(scene_of(half), MPI_COMM_WORLD);
  first.run(0.5, ignored);
  first.save("half.h5");
  first.run(1., expected);
  testing::ImplicitSolutionRun same(scene_of(half), MPI_COMM_WORLD);
  check("a run resumes with the parameter", same.load("half.h5").is_exact);
  same.run(1., rest);
  check("to the last bit", testing::are_same_bits(expected, rest));
  testing::ImplicitSolutionRun other(scene_of("fully integrated"), MPI_COMM_WORLD);
  check("and not exactly with another one", !other.load("half.h5").is_exact);
  check("a value that its type refuses",
        testing::refusal([&] {
          scene_of("fully integrated\n    set Solid part = 2");
        }).find("'Solid part' in 'Bodies / cube' is '2'; allowed is a number from 0 to 1") !=
            std::string::npos);
  check("another element has none",
        testing::refusal([&] {
          scene_of("one point\n    set Solid part = 0.5");
        }).find("allowed is no value: 'Element = one point' does not use it") != std::string::npos);
}

/// The explicit kernels do not have the element, so that the profile 'fast' leaves its numbers double.
void check_number_type() {
  const auto read = [](const std::string &lines) {
    std::ofstream("fast.prm") << R"(
set Profile = fast
subsection Bodies
  subsection cube
    set Element = fully integrated
    subsection Material
      set Young modulus = 200e3
      set Poisson ratio = 0.3
      set Density = 7.8e-9
    end
  end
end
subsection Time stepping
  set Scheme = explicit
end
)" << lines;
    return parameters::Scene::read("fast.prm");
  };
  check("the profile 'fast' computes it in double",
        read("").explicit_dynamics.number_type == NumberType::double_precision);
  std::string message;
  try {
    read("subsection Explicit dynamics\n  set Number type = float\nend\n");
  } catch (const InputError &error) {
    message = error.what();
  }
  check("float is refused where the scene sets it",
        message.find(
            "fast.prm:17: 'Number type' in 'Explicit dynamics' is 'float'; allowed is double, since no "
            "kernel computes body 'cube' in float: fully integrated, Hencky, elastic") != std::string::npos);
}

} // namespace

BILLET_MPI_TEST(added_element) {
  element_types().add(make_type());
  check_bending();
  check_plane_factors();
  check_advice();
  check_number_type();
  check_parameter();
  for (const std::string law : {"Hencky", "neo-Hookean", "hypoelastic"}) {
    const auto found = testing::pull("fully integrated", plastic + law, 1.2, 1., 10),
               wanted = testing::pull("mean dilatation", plastic + law, 1.2, 1., 10);
    check(law + ", statics, elastic energy", std::abs(found.elastic / wanted.elastic - 1.), 1e-9);
    check(law + ", statics, plastic work", std::abs(found.plastic / wanted.plastic - 1.), 1e-9);
    check(law + ", at most four Newton iterations a step", found.n_iterations <= 40);
  }
  for (const std::string law : {"Hencky", "neo-Hookean", "hypoelastic"}) {
    const auto found = testing::pull_explicitly("fully integrated", plastic + law, 1.2, quick),
               wanted = testing::pull_explicitly("mean dilatation", plastic + law, 1.2, quick);
    check(law + ", explicit, plastic work", std::abs(found.plastic / wanted.plastic - 1.), 1e-3);
  }
  const auto found = testing::pull_explicitly("fully integrated", elastic, 1.001, quick),
             wanted = testing::pull("mean dilatation", elastic, 1.001, 1., 1);
  check("elastic, explicit", std::abs(found.elastic / wanted.elastic - 1.), 2e-3);
}

} // namespace added_element_test
