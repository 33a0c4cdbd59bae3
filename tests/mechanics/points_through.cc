// SPDX-License-Identifier: LGPL-2.1-or-later
// More points through the thickness of a brick: the element matrix against differences, patch test and
// elastic response as with two points, along every axis of the brick; the plastic moment of a strip against
// its closed form; states that move between numbers of points; histories that are stored and restored.

#include "elements.h"

namespace points_through_test {

using namespace billet;
using namespace billet::testing;

const std::vector<unsigned int> more_points = {3, 5, 7};

std::unique_ptr<ElementBlock> make_layers(const MaterialLaw &material, const NodalTensor &X,
                                          const LawFormulation &formulation, const ThicknessAxis &axis = {}) {
  auto block = make_element_block(material, formulation);
  std::size_t offender = 0;
  AssertThrow(block->initialize({to_array(X)}, {axis}, offender), dealii::ExcInternalError());
  return block;
}

LawFormulation with_points(const unsigned int n, const std::string &elasticity = hencky) {
  LawFormulation formulation;
  formulation.points_through = n;
  formulation.elasticity = elasticity;
  return formulation;
}

void test_tangent(const LawFormulation &formulation) {
  const std::string name = name_of(formulation);
  const NodalTensor X = distorted_cube();
  WorstError elastic_error, plastic_error, mixed_error, symmetry, rigid, balance, same;
  Random random;
  const auto deform = [&](const double uniform, const double nodal) {
    // Rates see the middle of a step, which a large rotation loses.
    const Tensor<2, 3> rotation = formulation.elasticity == hypoelastic ? unit : random.rotation();
    return displace(rotation * (unit + random.tensor(uniform)), X) + random_nodal(random, nodal);
  };
  const auto add = [&](ElementBlock &block, const NodalTensor &u, const double step, const bool is_plastic,
                       WorstError &error) {
    ElementMatrix K;
    const NodalTensor force = compute_force(block, u, &K);
    same.add((force - compute_force(block, u)).norm());
    const MatrixTensor matrix = to_tensor(K);
    error.add((matrix - compute_difference(block, u, step)).norm() / matrix.norm());
    if (has_symmetric_tangent(formulation, is_plastic) || formulation.is_symmetrised)
      symmetry.add((matrix - transpose(matrix)).norm() / matrix.norm());
    for (unsigned int i = 0; i < 3; ++i) {
      NodalTensor translation;
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        translation[3 * a + i] = 1.;
      rigid.add(multiply(K, translation).norm() / matrix.norm());
    }
    const Tensor<2, 3> dyad = virial(force, X + u);
    balance.add((dyad - transpose(dyad)).norm() / force.norm());
    balance.add(resultant(force).norm() / force.norm());
  };
  unsigned int code = 0;
  const auto next_axis = [&] { return ThicknessAxis::from_code(code++ % 6); };
  for (const double nu : {0.3, 0., -0.5, 0.4999}) {
    const MaterialLaw material{ElasticModuli::from_young_poisson(young, nu), {}};
    add(*make_layers(material, X, formulation, next_axis()), deform(0.3, 0.1), 1e-5, false, elastic_error);
  }
  for_each_hardening([&](const std::string &, const auto &hardening) {
    const auto block = make_layers({steel, hardening}, X, formulation, next_axis());
    const NodalTensor u = deform(0.1, 0.05);
    add(*block, u, 1e-6, true, plastic_error);
    compute_force(*block, u);
    block->commit();
    add(*block, 1.5 * u, 1e-6, true, plastic_error);
  });
  add(*make_layers({steel, linear}, X, formulation, next_axis()), deform(0., 0.0025), 1e-7, true,
      mixed_error);
  check(name + ", elastic, differences", elastic_error.value(), 1e-8);
  check(name + ", plastic, differences", plastic_error.value(), 1e-7);
  check(name + ", some points yield, differences", mixed_error.value(), 1e-6);
  check(name + ", force is the same with and without matrix", same.value(), 0.);
  check(name + ", symmetry where it is promised", symmetry.value(), 1e-12);
  check(name + ", translations", rigid.value(), 1e-13);
  check(name + ", forces and moments balance", balance.value(), 1e-12);
}

/// Uniform deformation gives the forces of two points; so do small elastic strains of a box, whatever its
/// axis.
void test_patch_and_elasticity(const LawFormulation &formulation) {
  const std::string name = name_of(formulation);
  Random random;
  Tensor<2, 3> edges;
  for (unsigned int i = 0; i < 3; ++i)
    edges[i][i] = 1. + 0.4 * i;
  const NodalTensor X = distorted_cube(), box = transform(random.rotation() * edges, cube());
  LawFormulation twin = formulation;
  twin.points_through = 2;
  WorstError patch, elastic, matrices, energies;
  for (unsigned int code = 0; code < 6; ++code) {
    const ThicknessAxis axis = ThicknessAxis::from_code(code);
    const NodalTensor uniform = displace(unit + random.tensor(0.3), X);
    for (const MaterialLaw &material : {MaterialLaw{steel, {}}, MaterialLaw{steel, linear}}) {
      const NodalTensor expected = compute_force(*make_block(material, X, twin), uniform);
      patch.add((compute_force(*make_layers(material, X, formulation, axis), uniform) - expected).norm() /
                expected.norm());
    }
    const NodalTensor u = random_nodal(random, 1e-7);
    const auto block = make_layers({steel, {}}, box, formulation, axis),
               reference = make_block({steel, {}}, box, twin);
    ElementMatrix K, expected_K;
    const NodalTensor force = compute_force(*block, u, &K),
                      expected = compute_force(*reference, u, &expected_K);
    elastic.add((force - expected).norm() / expected.norm());
    matrices.add((to_tensor(K) - to_tensor(expected_K)).norm() / to_tensor(K).norm());
    block->commit();
    reference->commit();
    energies.add(std::abs(block->summarize(0, to_array(u)).elastic_energy /
                              reference->summarize(0, to_array(u)).elastic_energy -
                          1.));
  }
  check(name + ", uniform deformation as with two points", patch.value(), 1e-12);
  check(name + ", small elastic strains as with two points", elastic.value(), 1e-6);
  check(name + ", matrix as with two points", matrices.value(), 1e-6);
  check(name + ", energy as with two points", energies.value(), 1e-6);
}

/// A strip of length, width and thickness 1 in ideal plasticity, bent about y: moment over its plastic limit
/// M_p = σ t²/4 where it is free across, 2/√3 of it in plane strain, at these multiples of the curvature at
/// first yield.
std::vector<double> bend(const unsigned int n, const bool is_plane_strain,
                         const std::vector<double> &multiples, const std::string &elasticity,
                         double &pressure_error) {
  constexpr double yield = 0.7;
  const double limit = (is_plane_strain ? 2. / std::sqrt(3.) : 1.) * yield / 4.;
  const double first = 2. * (is_plane_strain ? yield / std::sqrt(1. - poisson + poisson * poisson) : yield) *
                       (is_plane_strain ? 1. - poisson * poisson : 1.) / young;
  NodalTensor X = cube(), bending, across;
  for (unsigned int k = 0; k < n_element_dofs; ++k)
    X[k] -= 0.5;
  for (unsigned int a = 0; a < n_element_nodes; ++a) {
    bending[3 * a] = X[3 * a] * X[3 * a + 2];
    across[3 * a + 1] = -X[3 * a + 1] * X[3 * a + 2];
  }
  const auto block = make_layers({steel, LinearHardening{yield, 0.}}, X, with_points(n, elasticity));
  std::vector<double> moments;
  double q = 0., done = 0.;
  for (const double multiple : multiples) {
    const unsigned int n_steps = 15;
    const double begin = done;
    for (unsigned int step = 1; step <= n_steps; ++step) {
      done = begin + (multiple - begin) * step / n_steps;
      const NodalTensor bent = done * first * bending;
      NodalTensor force;
      for (unsigned int iteration = 0; iteration < 30; ++iteration) {
        ElementMatrix K;
        force = compute_force(*block, bent + q * across, &K);
        if (is_plane_strain)
          break;
        const double residual = across * force;
        if (std::abs(residual) < 1e-13 * yield)
          break;
        q -= residual / (across * multiply(K, across));
      }
      block->commit();
      if (step == n_steps) {
        moments.push_back(bending * force / limit);
        if (const auto layers = block->summarize_layers(0, to_array(bent + q * across)))
          pressure_error = std::max(pressure_error, std::abs((*layers)[2].cauchy_stress[2][2]) / yield);
      }
    }
  }
  return moments;
}

/// The more points the closer, through all of the curve.
void test_bending(const std::string &elasticity) {
  const std::string name = name_of(with_points(2, elasticity));
  const std::vector<double> multiples = {1.5, 2., 3., 5., 20.};
  const std::vector<double> tolerances = {0.16, 0.115, 0.035, 0.0135};
  for (const bool is_plane_strain : {false, true}) {
    double last_worst = 1., pressure_error = 0.;
    for (std::size_t k = 0; k < all_points_through.size(); ++k) {
      const unsigned int n = all_points_through[k];
      const std::vector<double> moments = bend(n, is_plane_strain, multiples, elasticity, pressure_error);
      double worst = 0.;
      for (std::size_t i = 0; i < moments.size(); ++i)
        worst = std::max(worst, std::abs(moments[i] - 1. + 1. / (3. * multiples[i] * multiples[i])));
      const std::string points =
          name + (is_plane_strain ? ", plane strain, " : ", free across, ") + std::to_string(n) + " points";
      check(points + ", plastic moment", worst, tolerances[k]);
      check(points + ", closer than fewer points", worst < last_worst);
      last_worst = worst;
    }
    check(name + ", hardly any stress across the outer layer", pressure_error, 0.25);
  }
}

/// States go to other numbers of points and keep their means; a brick has the stress that it was given.
void test_transfer(const std::string &elasticity) {
  const std::string name = name_of(with_points(2, elasticity));
  Random random;
  const NodalTensor X = distorted_cube(), u = random_nodal(random, 0.1);
  const MaterialLaw material{steel, linear};
  const auto mean = [](const ElementStress &stress, const unsigned int n) {
    PointStress sum;
    for (unsigned int q = 0; q < stress.size(); ++q) {
      sum.deviator += 0.25 * gauss_rule(n).weights[q / 4] * stress[q].deviator;
      sum.equivalent_plastic_strain +=
          0.25 * gauss_rule(n).weights[q / 4] * stress[q].equivalent_plastic_strain;
    }
    return sum;
  };
  const auto distance = [](const PointStress &a, const PointStress &b) {
    return (a.deviator - b.deviator).norm() / b.deviator.norm() +
           std::abs(a.equivalent_plastic_strain / b.equivalent_plastic_strain - 1.);
  };
  WorstError means, same, yield, restored;
  for (const unsigned int from : all_points_through)
    for (const unsigned int to : all_points_through)
      for (unsigned int code = 0; code < 6; ++code) {
        const ThicknessAxis axis = ThicknessAxis::from_code(code), other = ThicknessAxis::from_code(5 - code);
        const auto source = make_layers(material, X, with_points(from, elasticity), axis);
        compute_force(*source, u);
        source->commit();
        const ElementStress stress = source->compute_stress(0, to_array(u));
        for (const ThicknessAxis &of_target : {axis, other}) {
          const auto target = make_layers(material, X, with_points(to, elasticity), of_target);
          target->set_stress(0, to_array(u), stress);
          const ElementStress found = target->compute_stress(0, to_array(u));
          means.add(distance(mean(found, to), mean(stress, from)));
          for (const PointStress &point : found)
            yield.add(
                std::sqrt(1.5) * point.deviator.norm() / linear.stress(point.equivalent_plastic_strain) - 1.);
          if (from == to && (from == 2 || of_target == axis))
            for (unsigned int q = 0; q < found.size(); ++q)
              same.add(distance(found[q], stress[q]));
        }
        std::vector<double> numbers(source->state_size());
        source->get_state(0, numbers.data());
        const auto twin = make_layers(material, X, with_points(from, elasticity), axis);
        twin->set_state(0, numbers.data());
        restored.add((compute_force(*twin, 1.1 * u) - compute_force(*source, 1.1 * u)).norm());
        restored.add(std::abs(twin->summarize(0, to_array(u)).elastic_energy -
                              source->summarize(0, to_array(u)).elastic_energy));
      }
  check(name + ", other numbers of points keep the mean", means.value(), 1e-9);
  check(name + ", as many points keep the state", same.value(), 1e-9);
  check(name + ", no state leaves the yield surface", yield.value(), 1e-9);
  check(name + ", history stored and restored", restored.value(), 0.);
}

/// Inner and outer layer follow the thickness direction, whatever the order of the nodes.
void test_layers() {
  WorstError error;
  for (unsigned int code = 0; code < 6; ++code) {
    const ThicknessAxis axis = ThicknessAxis::from_code(code);
    NodalTensor X = cube(), u;
    const unsigned int along = axis.axis, side = (along + 1) % 3;
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      u[3 * a + side] = 1e-3 * (X[3 * a + side] - 0.5) * (X[3 * a + along] - 0.5);
    Tensor<1, 3> direction;
    direction[along] = axis.is_reversed ? -1. : 1.;
    const auto found = find_thickness_axis(to_array(X), direction);
    error.add(found && *found == axis ? 0. : NAN);
    const auto block = make_layers({steel, {}}, X, with_points(5), axis);
    compute_force(*block, u);
    block->commit();
    const auto layers = block->summarize_layers(0, to_array(u));
    const double stress =
        (axis.is_reversed ? -1. : 1.) * 0.5e-3 * gauss_rule(5).points[4] * young / (1. - poisson * poisson);
    error.add(std::abs((*layers)[2].cauchy_stress[side][side] / stress - 1.));
    error.add(std::abs((*layers)[0].cauchy_stress[side][side] / stress + 1.));
    error.add(std::abs((*layers)[1].cauchy_stress[side][side] / stress));
    error.add(std::abs((*layers)[2].cauchy_stress[along][along] / stress));
  }
  check("inner, membrane and outer stress of an elastic plate", error.value(), 0.04);
  check("a direction between two axes has none",
        !find_thickness_axis(to_array(cube()), Tensor<1, 3>({1., 0.9, 0.})) &&
            !find_thickness_axis(to_array(cube()), Tensor<1, 3>()) &&
            find_thickness_axis(to_array(cube()), Tensor<1, 3>({1., 0.6, 0.})).has_value());
}

BILLET_TEST(points_through) {
  for (const auto &elasticity : metal_elasticities()) {
    test_bending(elasticity);
    test_transfer(elasticity);
    for (const unsigned int n : more_points) {
      test_tangent(with_points(n, elasticity));
      test_patch_and_elasticity(with_points(n, elasticity));
    }
  }
  test_layers();
}

} // namespace points_through_test
