// SPDX-License-Identifier: LGPL-2.1-or-later
// Usage: explicit_kernels [ELEMENTS_PER_EDGE [STEPS [INSTRUCTION_SET]]]
//
// Prints the time per element and step in nanoseconds of every kernel of explicit dynamics, for each
// instruction set that this machine has and each type of number: a cube of distorted elements, nearly all
// yielding; the least of several steps (0 elements: no kernels). Beside it what the machine gives in the same
// run: memory bandwidth (triad) and floating-point peak (multiply-add).
#include "../sample_formulations.h"

#include <deal.II/base/aligned_vector.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

using namespace billet;
using billet::testing::Formulation;
using billet::testing::MaterialLaw;

namespace {

template <class Function> double time_of(const Function &run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Best of ten, GB/s, 32 bytes for each entry: the store reads its line first.
double measure_triad() {
  constexpr std::size_t n = std::size_t{1} << 23;
  std::vector<double> a(n, 0.), b(n, 1.), c(n, 2.);
  double best = 1e300;
  for (unsigned int repetition = 0; repetition < 10; ++repetition)
    best = std::min(best, time_of([&] {
                      for (std::size_t i = 0; i < n; ++i)
                        a[i] = b[i] + 3. * c[i];
                    }));
  return a[n / 2] == 7. ? 32e-9 * n / best : 0.;
}

using Two = double __attribute__((vector_size(16)));
using Four = double __attribute__((vector_size(32)));
using Eight = double __attribute__((vector_size(64)));

/// Twelve independent chains; returns a sum that depends on all.
template <class Vector> __attribute__((always_inline)) inline double run_chains(const unsigned int n) {
  Vector x[12];
  for (unsigned int k = 0; k < 12; ++k)
    x[k] = Vector{} + 1. + k;
  const Vector factor = Vector{} + 0.9999999, summand = Vector{} + 1e-7;
  for (unsigned int i = 0; i < n; ++i)
    for (Vector &v : x)
      v = v * factor + summand;
  double sum = 0.;
  for (const Vector &v : x)
    sum += v[0];
  return sum;
}

#if defined(__clang__) // which has no such attribute
#define OPTIMIZED
#else
#define OPTIMIZED __attribute__((optimize("O3")))
#endif

#if defined(__x86_64__)
__attribute__((target("avx512f,avx512dq,avx512vl,fma"))) OPTIMIZED double
chains_avx512(const unsigned int n) {
  return run_chains<Eight>(n);
}
__attribute__((target("avx2,fma"))) OPTIMIZED double chains_avx2(const unsigned int n) {
  return run_chains<Four>(n);
}
#endif
OPTIMIZED double chains_sse2(const unsigned int n) { return run_chains<Two>(n); }

/// Best of five, GF/s.
template <class Function> double measure_chains(const Function &run, const unsigned int width) {
  constexpr unsigned int n = 2000000;
  double best = 1e300;
  for (unsigned int repetition = 0; repetition < 5; ++repetition)
    best = std::min(best, time_of([&] {
                      if (!std::isfinite(run(n)))
                        std::printf("overflow\n");
                    }));
  return 2e-9 * width * 12 * n / best;
}

double measure_peak(const InstructionSet instructions) {
#if defined(__x86_64__)
  if (instructions == InstructionSet::avx512)
    return measure_chains(chains_avx512, 8);
  if (instructions == InstructionSet::avx2)
    return measure_chains(chains_avx2, 4);
#endif
  // One at a time takes as long as two.
  return measure_chains(chains_sse2, instructions == InstructionSet::scalar ? 1 : 2);
}

struct Cube {
  std::vector<std::array<unsigned int, 8>> elements;
  dealii::AlignedVector<double> positions;
};

/// Unit cube, inner nodes moved at random by up to 0.15 of an edge.
Cube make_cube(const unsigned int n) {
  Cube cube;
  std::mt19937 random(1);
  const auto uniform = [&] { return static_cast<double>(random()) / std::mt19937::max() - 0.5; };
  const unsigned int m = n + 1;
  cube.positions.resize(std::size_t{4} * m * m * m);
  for (unsigned int k = 0, node = 0; k < m; ++k)
    for (unsigned int j = 0; j < m; ++j)
      for (unsigned int i = 0; i < m; ++i, ++node) {
        const unsigned int index[3] = {i, j, k};
        for (unsigned int d = 0; d < 3; ++d)
          cube.positions[4 * std::size_t{node} + d] = (index[d] + 0.3 * uniform()) / n;
      }
  for (unsigned int k = 0; k < n; ++k)
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i) {
        std::array<unsigned int, 8> element{};
        for (unsigned int a = 0; a < 8; ++a)
          element[a] = i + (a & 1) + m * (j + (a >> 1 & 1) + m * (k + (a >> 2)));
        cube.elements.push_back(element);
      }
  return cube;
}

/// Compressed by 0.1 % in each step, after a first one of 1 %.
double measure(const Cube &cube, const Formulation &formulation, const unsigned int n_steps) {
  const MaterialLaw material{ElasticModuli::from_young_poisson(2e5, 0.3), LinearHardening{400., 1000.}};
  const auto block = make_explicit_block(material, 7.8e-9, formulation);
  std::size_t offender = 0;
  if (!block->initialize(cube.elements, cube.positions.data(), offender))
    return NAN;
  const std::size_t n = cube.positions.size();
  dealii::AlignedVector<double> displacements(n), velocities(n), forces(n);
  double best = 1e300;
  for (unsigned int step = 0; step < n_steps; ++step) {
    const double axial = step == 0 ? -0.01 : -0.001, dt = 1e-6;
    for (std::size_t node = 0; node < n / 4; ++node)
      for (unsigned int d = 0; d < 3; ++d) {
        const double change = (d == 2 ? axial : -0.45 * axial) * cube.positions[4 * node + d];
        displacements[4 * node + d] += change;
        velocities[4 * node + d] = change / dt;
      }
    forces.fill(0.);
    ExplicitBlock::StepResult result{};
    const double time = time_of([&] {
      result = block->advance({displacements.data(), velocities.data(), forces.data()}, dt);
    });
    if (result.inverted != block->size())
      return NAN;
    best = std::min(best, time);
  }
  return 1e9 * best / static_cast<double>(cube.elements.size());
}

} // namespace

int main(int argc, char *argv[]) {
  const unsigned int n = argc > 1 ? static_cast<unsigned int>(std::stoul(argv[1])) : 64;
  const unsigned int n_steps = argc > 2 ? static_cast<unsigned int>(std::stoul(argv[2])) : 8;
  const Cube cube = make_cube(n);
  const std::pair<const char *, InstructionSet> sets[] = {{"scalar", InstructionSet::scalar},
                                                          {"sse2", InstructionSet::sse2},
                                                          {"avx2", InstructionSet::avx2},
                                                          {"avx512", InstructionSet::avx512}};
  const std::pair<const char *, Formulation::Element> elements[] = {
      {"assumed strain", Formulation::Element::assumed_strain},
      {"mean dilatation", Formulation::Element::mean_dilatation},
      {"one point", Formulation::Element::one_point}};
  const std::pair<const char *, std::string> laws[] = {{"hypoelastic", testing::hypoelastic},
                                                       {"neo-Hookean", testing::neo_hookean},
                                                       {"Hencky", testing::hencky}};
  std::printf("%zu elements, triad %.1f GB/s\n", cube.elements.size(), measure_triad());
  std::printf("%-8s %-6s %6s", "", "", "GF/s");
  for (const auto &element : elements)
    for (const auto &law : laws)
      if (n > 0)
        std::printf("  %s %s", element.first, law.first);
  std::printf("\n");
  const std::pair<const char *, NumberType> types[] = {{"double", NumberType::double_precision},
                                                       {"float", NumberType::float_precision}};
  for (const auto &set : sets)
    for (const auto &type : types) {
      if ((argc > 3 && std::string(argv[3]) != set.first) || !is_available(set.second) ||
          (n == 0 && type.first != types[0].first))
        continue;
      std::printf("%-8s %-6s %6.1f", set.first, type.first, measure_peak(set.second));
      for (const auto &element : elements)
        for (const auto &law : laws) {
          if (n == 0)
            continue;
          Formulation formulation;
          formulation.element = element.second;
          formulation.elasticity = law.second;
          formulation.instructions = set.second;
          formulation.number_type = type.second;
          std::printf("  %8.0f", measure(cube, formulation, n_steps));
          std::fflush(stdout);
        }
      std::printf("\n");
    }
  std::printf("triad %.1f GB/s\n", measure_triad());
  return 0;
}
