// SPDX-License-Identifier: LGPL-2.1-or-later
// What is not admissible is refused, and leaves no trace: a step that was tried and given up gives the same
// bits as one that never was.

#include "billet/without_traps.h"

#include "elements.h"

#include <limits>

namespace element_failure_test {

using namespace billet;
using namespace billet::testing;

/// Everything that a block answers, for comparison by bits.
struct Answer {
  ElementVectors force;
  ElementMatrix matrix;
  ElementSummary summary;

  bool operator==(const Answer &other) const {
    return force == other.force && matrix == other.matrix &&
           summary.cauchy_stress == other.summary.cauchy_stress &&
           summary.equivalent_plastic_strain == other.summary.equivalent_plastic_strain &&
           summary.elastic_energy == other.summary.elastic_energy &&
           summary.plastic_work == other.summary.plastic_work;
  }
};

/// Evaluates element e at u, commits, and answers.
Answer advance(ElementBlock &block, const NodalTensor &u, const std::size_t e = 0) {
  Answer answer;
  AssertThrow(block.evaluate(e, to_array(u), answer.force, &answer.matrix), dealii::ExcInternalError());
  block.commit();
  answer.summary = block.summarize(e, to_array(u));
  return answer;
}

/// Displacements that no step may accept, by name.
std::vector<std::pair<std::string, NodalTensor>> bad_displacements(const NodalTensor &X) {
  std::vector<std::pair<std::string, NodalTensor>> result;
  Tensor<2, 3> flat = unit, mirrored = unit;
  flat[2][2] = 0.;
  mirrored[2][2] = -1.;
  result.emplace_back("flattened", displace(flat, cube())); // on the cube det F is exactly 0
  result.emplace_back("turned inside out", displace(mirrored, X));
  NodalTensor corner; // node 7 pushed far beyond node 0
  for (unsigned int i = 0; i < 3; ++i)
    corner[21 + i] = -2.5;
  result.emplace_back("one corner pushed through", corner);
  NodalTensor not_a_number, infinite;
  not_a_number[5] = std::numeric_limits<double>::quiet_NaN();
  infinite[23] = std::numeric_limits<double>::infinity();
  result.emplace_back("not a number", not_a_number);
  result.emplace_back("infinite", infinite);
  result.emplace_back("det F overflows", displace(1e200 * unit, X));
  result.emplace_back("b overflows, det F does not", displace(1e100 * unit, X));
  return result;
}

void test_failures(const std::string &name, const MaterialLaw &material) {
  Random random;
  const NodalTensor X = distorted_cube();
  const NodalTensor u_1 = displace(unit + random.tensor(0.1), X), u_2 = u_1 + random_nodal(random, 0.05);
  const auto undisturbed = make_block(material, X);
  const Answer first = advance(*undisturbed, u_1), second = advance(*undisturbed, u_2);
  check(name + ", the two steps differ", !(first == second));

  for (const auto &[label, bad] : bad_displacements(X)) {
    const auto block = make_block(material, label == "flattened" ? cube() : X);
    ElementVectors force;
    ElementMatrix matrix;
    check(name + ", " + label + ", refused", !block->evaluate(0, to_array(bad), force, nullptr) &&
                                                 !block->evaluate(0, to_array(bad), force, &matrix));
    const auto tried = make_block(material, X);
    tried->evaluate(0, to_array(bad), force, &matrix);
    const Answer first_after = advance(*tried, u_1);
    tried->evaluate(0, to_array(bad), force, nullptr);
    check(name + ", " + label + ", leaves no trace", first_after == first && advance(*tried, u_2) == second);
  }

  // A cut step: evaluated with success at a far trial state, then given up.
  const auto cut = make_block(material, X);
  ElementVectors force;
  for (const double factor : {3., 2., -1., 1.5})
    cut->evaluate(0, to_array(factor * u_1), force, nullptr);
  check(name + ", before the commit the history is untouched",
        cut->summarize(0, to_array(NodalTensor())).equivalent_plastic_strain == 0.);
  const Answer first_after = advance(*cut, u_1);
  cut->evaluate(0, to_array(3. * u_2), force, nullptr);
  check(name + ", abandoned evaluations leave no trace",
        first_after == first && advance(*cut, u_2) == second);

  // A commit of nothing new.
  const auto twice = make_block(material, X);
  advance(*twice, u_1);
  twice->commit();
  check(name + ", committing twice is committing once", advance(*twice, u_2) == second);

  std::size_t offender = 0;
  check(name + ", initialized again, it is virgin again",
        twice->initialize({to_array(X)}, offender) && advance(*twice, u_1) == first);
}

/// In a block of several, each element has its own history.
void test_neighbours(const std::string &name, const MaterialLaw &material) {
  Random random;
  const NodalTensor X = distorted_cube(), u_1 = displace(unit + random.tensor(0.1), X), u_2 = 1.3 * u_1;
  const auto alone = make_block(material, X);
  advance(*alone, u_1);
  const Answer expected = advance(*alone, u_2);

  const auto block = make_element_block(material);
  std::size_t offender = 0;
  check(name + ", three elements",
        block->initialize({to_array(cube()), to_array(X), to_array(2. * X)}, offender) && block->size() == 3);
  advance(*block, u_1, 1);
  check(name + ", neighbours stay virgin",
        block->summarize(0, ElementVectors{}).equivalent_plastic_strain == 0. &&
            block->summarize(2, ElementVectors{}).equivalent_plastic_strain == 0.);
  advance(*block, 3. * u_1, 0);
  advance(*block, NodalTensor(), 2);
  check(name + ", neighbours do not disturb", advance(*block, u_2, 1) == expected);
}

/// The kinematics refuse what they can see; an overflow of b is left to the law.
void test_kinematics() {
  const NodalTensor X = distorted_cube();
  for (const auto &[label, bad] : bad_displacements(X)) {
    ReferenceElement element;
    MeanDilatationKinematics ignored;
    AssertThrow(compute_reference_element(to_array(label == "flattened" ? cube() : X), element),
                dealii::ExcInternalError());
    const bool admissible = label == "b overflows, det F does not";
    check(std::string("kinematics, ") + label + (admissible ? ", accepted" : ", refused"),
          compute_kinematics(element, to_array(bad), ignored) == admissible);
  }
}

void test_reference() {
  const auto block = make_element_block({steel, linear});
  NodalTensor inverted = cube(), flat = cube(), not_a_number = cube();
  std::size_t offender = 99;
  for (unsigned int i = 0; i < 3; ++i)
    std::swap(inverted[i], inverted[3 + i]); // nodes 0 and 1 in the wrong order
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    flat[3 * a + 1] = 0.;
  not_a_number[10] = std::numeric_limits<double>::quiet_NaN();
  const ElementVectors good = to_array(cube());
  check("reference element inverted, index 2",
        !block->initialize({good, good, to_array(inverted), good}, offender) && offender == 2);
  check("reference element flat, index 0",
        !block->initialize({to_array(flat), to_array(inverted)}, offender) && offender == 0);
  check("reference element not a number, index 1",
        !block->initialize({good, to_array(not_a_number)}, offender) && offender == 1);
  check("initialized again after that", block->initialize({good}, offender) && block->size() == 1);
}

BILLET_TEST(element_failure) {
  const WithoutTraps quiet; // some displacements are no numbers
  test_failures("elastic", {steel, {}});
  test_failures("plastic", {steel, linear});
  test_neighbours("elastic", {steel, {}});
  test_neighbours("plastic", {steel, linear});
  test_kinematics();
  test_reference();
  check("elastic, keeps no history", make_block({steel, {}}, cube())->history_size() == 0);
  check("plastic, keeps two beats of C_p and alpha in eight points",
        make_block({steel, linear}, cube())->history_size() == 112); // 2 · 8 · 7
}

} // namespace element_failure_test
