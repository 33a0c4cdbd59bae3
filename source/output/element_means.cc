// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/element_means.h"

#include "billet/diagnostic_kinds.h"

#include <cmath>
#include <sstream>

namespace billet {

namespace {

/// Returns one scalar for each element.
template <class Get>
ElementValues values_of(const std::vector<std::vector<ElementSummary>> &summaries, const Get &get) {
  ElementValues values;
  for (const auto &of_body : summaries) {
    values.emplace_back();
    for (const ElementSummary &summary : of_body)
      values.back().push_back(get(summary));
  }
  return values;
}

std::vector<std::vector<ElementSummary>> summarize(const Solution &solution,
                                                   const Discretization &discretization) {
  std::vector<std::vector<ElementSummary>> summaries;
  for (std::size_t body = 0; body < discretization.n_bodies(); ++body)
    summaries.push_back(solution.summarize(body));
  return summaries;
}

/// Returns the integral of the squares over all ranks. Collective.
double integrate_squares(const Discretization &discretization, const ElementValues &values) {
  double sum = 0.;
  for (std::size_t body = 0; body < discretization.n_bodies(); ++body) {
    const auto &elements = discretization.elements(body);
    for (std::size_t e = 0; e < elements.size(); ++e)
      sum += elements[e].cell->measure() * values[body][e] * values[body][e];
  }
  return dealii::Utilities::MPI::sum(sum, discretization.communicator());
}

ElementValues difference(ElementValues values, const ElementValues &others) {
  for (std::size_t body = 0; body < values.size(); ++body)
    for (std::size_t e = 0; e < values[body].size(); ++e)
      values[body][e] -= others[body][e];
  return values;
}

} // namespace

ElementValues smooth(const Discretization &discretization, const ElementValues &values) {
  // A node's first dof holds the sum of values times volumes, its second dof the sum of volumes.
  Vector sums = discretization.make_additive_vector();
  for (std::size_t body = 0; body < discretization.n_bodies(); ++body) {
    const auto &elements = discretization.elements(body);
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const double volume = elements[e].cell->measure();
      for (unsigned int a = 0; a < n_element_nodes; ++a) {
        sums(elements[e].dofs[std::size_t{3} * a]) += volume * values[body][e];
        sums(elements[e].dofs[std::size_t{3} * a + 1]) += volume;
      }
    }
  }
  sums.compress(dealii::VectorOperation::add);
  Vector owned = discretization.make_owned_vector(), ghosted = discretization.make_ghosted_vector();
  owned = sums;
  ghosted = owned;
  ElementValues result;
  for (std::size_t body = 0; body < discretization.n_bodies(); ++body) {
    result.emplace_back();
    for (const auto &element : discretization.elements(body)) {
      double mean = 0.;
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        mean += ghosted(element.dofs[std::size_t{3} * a]) / ghosted(element.dofs[std::size_t{3} * a + 1]);
      result.back().push_back(mean / n_element_nodes);
    }
  }
  return result;
}

Checkerboard find_checkerboard(const Solution &solution, const Discretization &discretization) {
  constexpr unsigned int min_elements = 64;
  if (discretization.n_global_elements() < min_elements)
    return {};
  const ElementValues pressures =
      values_of(summarize(solution, discretization),
                [](const ElementSummary &summary) { return -dealii::trace(summary.cauchy_stress) / 3.; });
  const ElementValues rough = difference(pressures, smooth(discretization, pressures));
  const double all = integrate_squares(discretization, pressures),
               of_rough = integrate_squares(discretization, rough);
  if (!(of_rough > 0.))
    return {};
  return {std::sqrt(of_rough / all),
          std::sqrt(integrate_squares(discretization, difference(rough, smooth(discretization, rough))) /
                    of_rough)};
}

DiagnosticList Checkerboard::check() const {
  constexpr double much = 0.3, alternates = 0.9;
  if (!(size > much && alternating > alternates))
    return {};
  std::ostringstream text;
  text.precision(2);
  text << "Pressures alternate from element to element by " << 100. * size
       << " % of their size. Forces and displacements are not affected; pressures are right only as means "
          "over "
          "neighbours";
  return {Diagnostic(diagnostic::pressure_checkerboard, text.str()).measure("part of the pressures", size)};
}

} // namespace billet
