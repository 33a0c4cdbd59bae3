// SPDX-License-Identifier: LGPL-2.1-or-later
// A strained element goes on in every other formulation: with the same stress at each point, or their mean,
// the same plastic strain, and, with eight points, the same forces; and its own history makes it another's
// twin.
#include "explicit_blocks.h"

namespace history_transfer_test {

using namespace billet;
using billet::testing::check;
using billet::testing::LawFormulation;
using billet::testing::MaterialLaw;
using billet::testing::NodalTensor;

namespace {

double distance(const ElementStress &a, const ElementStress &b) {
  testing::WorstError error;
  for (unsigned int q = 0; q < n_element_points; ++q) {
    error.add((a[q].deviator - b[q].deviator).norm() / (1. + b[q].deviator.norm()));
    error.add(std::abs(a[q].equivalent_plastic_strain - b[q].equivalent_plastic_strain));
  }
  return error.value();
}

ElementStress mean_of(const ElementStress &stress) {
  PointStress mean;
  for (const auto &point : stress) {
    mean.deviator += 0.125 * point.deviator;
    mean.equivalent_plastic_strain += 0.125 * point.equivalent_plastic_strain;
  }
  ElementStress result;
  std::fill(result.begin(), result.end(), mean);
  return result;
}

testing::NodalArray to_nodal(const NodalTensor &u) {
  testing::NodalArray values(32);
  for (unsigned int a = 0; a < 8; ++a)
    testing::set_node(values, a, testing::node(u, a));
  return values;
}

} // namespace

BILLET_TEST(history_transfer) {
  testing::Random random;
  const MaterialLaw material{ElasticModuli::from_young_poisson(200e3, 0.3),
                             VoceHardening{300., 500., 8., 100.}};
  NodalTensor X, u;
  for (unsigned int a = 0; a < 8; ++a)
    for (unsigned int i = 0; i < 3; ++i)
      X[3 * a + i] = ((a >> i) & 1U) + random(-0.1, 0.1);
  const dealii::Tensor<2, 3> rotation = random.rotation();
  u = testing::transform(rotation, X + testing::random_nodal(random, 0.08)) - X;
  const testing::NodalArray nodal = to_nodal(u);

  std::vector<std::pair<std::string, ElementStress>> sources;
  testing::for_each_kernel([&](const testing::Formulation &formulation) {
    testing::Body body(testing::make_mesh(X), material, formulation);
    body.advance(0. * u, 0.);
    for (unsigned int i = 1; i <= 50; ++i)
      body.advance(i / 50. * u, 1.);
    sources.emplace_back(testing::name_of(formulation), body.block().compute_stress(0, nodal.data()));

    std::vector<double> state(body.block().history_size());
    body.block().get_state(0, state.data());
    testing::Body twin(testing::make_mesh(X), material, formulation);
    twin.block().set_state(0, state.data());
    const NodalTensor f = body.advance(1.01 * u, 1.);
    twin.advance(u, 0.);
    twin.block().set_state(0, state.data());
    check(testing::name_of(formulation) + ", history given to another",
          (twin.advance(1.01 * u, 1.) - f).norm(), 0.);
  });
  testing::for_each_formulation([&](const LawFormulation &formulation) {
    const auto block = testing::make_block(material, X, formulation);
    for (unsigned int i = 1; i <= 50; ++i) {
      testing::compute_force(*block, i / 50. * u);
      block->commit();
    }
    sources.emplace_back("implicit, " + testing::name_of(formulation),
                         block->compute_stress(0, testing::to_array(u)));
  });
  bool all_yield = true;
  for (const auto &[name, stress] : sources)
    for (const auto &point : stress)
      all_yield = all_yield && point.equivalent_plastic_strain > 1e-3;
  check("All points have yielded", all_yield);

  for (const auto &[name, stress] : sources) {
    const auto implicit = make_element_block(material);
    std::size_t ignored = 0;
    implicit->initialize({testing::to_array(X)}, ignored);
    implicit->set_stress(0, testing::to_array(u), stress);
    check(name + " to implicit", distance(implicit->compute_stress(0, testing::to_array(u)), stress), 1e-9);
    testing::for_each_kernel([&, &from = name, &wanted = stress](const testing::Formulation &formulation) {
      testing::Body body(testing::make_mesh(X), material, formulation);
      body.block().set_stress(0, nodal.data(), wanted);
      const bool has_one = formulation.element == testing::Formulation::Element::one_point;
      const std::string to = from + " to " + testing::name_of(formulation);
      check(to, distance(body.block().compute_stress(0, nodal.data()), has_one ? mean_of(wanted) : wanted),
            1e-9);
      const NodalTensor f = body.advance(u, 0.);
      check(to + ", no work", std::abs(body.result().plastic_work), 1e-9);
      if (has_one)
        check(to + ", no hourglass energy", body.result().hourglass_energy, 1e-9);
      else if (formulation.elasticity != testing::hypoelastic) {
        LawFormulation twin;
        twin.element = formulation.element;
        const auto reference = testing::make_block(material, X, twin);
        reference->set_stress(0, testing::to_array(u), wanted);
        const NodalTensor force = testing::compute_force(*reference, u);
        check(to + ", forces", (f - force).norm() / force.norm(), 1e-9);
      }
    });

    testing::WorstError hourglass_energy, twin_error;
    testing::for_each_formulation([&, &from = name, &wanted = stress](const LawFormulation &formulation) {
      const auto block = testing::make_block(material, X, formulation);
      block->set_stress(0, testing::to_array(u), wanted);
      const bool has_one = formulation.element == ElementFormulation::Element::one_point;
      const std::string to = from + " to " + "implicit, " + testing::name_of(formulation);
      check(to, distance(block->compute_stress(0, testing::to_array(u)), has_one ? mean_of(wanted) : wanted),
            1e-9);
      hourglass_energy.add(block->summarize(0, testing::to_array(u)).hourglass_energy);
      testing::compute_force(*block, 1.01 * u);
      block->commit();
      std::vector<double> numbers(block->state_size());
      block->get_state(0, numbers.data());
      const auto twin = testing::make_block(material, X, formulation);
      twin->set_state(0, numbers.data());
      const NodalTensor expected = testing::compute_force(*block, 1.02 * u);
      twin_error.add((testing::compute_force(*twin, 1.02 * u) - expected).norm());
      std::vector<double> again(twin->state_size());
      twin->get_state(0, again.data());
      twin_error.add(again == numbers ? 0. : NAN);
    });
    check(name + " to implicit, no hourglass energy", hourglass_energy.value(), 1e-9);
    check(name + " to implicit, history given to another and taken back", twin_error.value(), 0.);
  }
}

} // namespace history_transfer_test
