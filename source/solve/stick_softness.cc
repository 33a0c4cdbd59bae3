// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/stick_softness.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace billet {

std::vector<double> body_thicknesses(const Discretization &discretization) {
  std::vector<double> thicknesses;
  for (std::size_t body = 0; body < discretization.n_bodies(); ++body) {
    constexpr std::size_t n_moments = 10; // 1, x_i, x_i x_j
    std::vector<double> moments(n_moments);
    for (const auto &element : discretization.elements(body)) {
      const double volume = element.cell->measure();
      const dealii::Tensor<1, 3> centre = element.cell->center() - discretization.centre();
      dealii::SymmetricTensor<2, 3> second =
          volume * dealii::symmetrize(dealii::outer_product(centre, centre));
      // The moment of a parallelepiped about its centre is a third of the mean over its corners.
      for (const unsigned int v : element.cell->vertex_indices()) {
        const dealii::Tensor<1, 3> arm = element.cell->vertex(v) - element.cell->center();
        constexpr double n_corners = 8.;
        second += volume / (3. * n_corners) * dealii::symmetrize(dealii::outer_product(arm, arm));
      }
      moments[0] += volume;
      for (unsigned int i = 0; i < 3; ++i)
        moments[1 + i] += volume * centre[i];
      for (unsigned int i = 0; i < dealii::SymmetricTensor<2, 3>::n_independent_components; ++i)
        moments[4 + i] += second.access_raw_entry(i);
    }
    dealii::Utilities::MPI::sum(moments, discretization.communicator(), moments);
    dealii::Tensor<1, 3> first;
    for (unsigned int i = 0; i < 3; ++i)
      first[i] = moments[1 + i];
    dealii::SymmetricTensor<2, 3> second;
    for (unsigned int i = 0; i < dealii::SymmetricTensor<2, 3>::n_independent_components; ++i)
      second.access_raw_entry(i) = moments[4 + i];
    second -= 1. / moments[0] * dealii::symmetrize(dealii::outer_product(first, first));
    const std::array<double, 3> principal = dealii::eigenvalues(second); // the largest first
    constexpr double of_box = 12.;
    thicknesses.push_back(std::sqrt(of_box * std::max(0., principal[2]) / moments[0]));
  }
  return thicknesses;
}

StickSprings::StickSprings(const Scene &scene, const Discretization &discretization)
    : communicator_(discretization.communicator()) {
  const std::vector<double> thicknesses = body_thicknesses(discretization);
  const auto flexibility = [&](const std::size_t body) {
    return thicknesses[body] / scene.bodies()[body].law->elastic().shear;
  };
  const auto coefficient = [](const PairSettings &pair) {
    return pair.has_friction() ? pair.friction->coefficient() : 0.;
  };
  for (const auto &pair : scene.pairs())
    pairs_.push_back({coefficient(pair), 1. / flexibility(pair.body)});
  for (const auto &pair : scene.body_pairs())
    pairs_.push_back({coefficient(pair), 1. / (flexibility(pair.bodies[0]) + flexibility(pair.bodies[1]))});
}

std::vector<StickSoftness>
StickSprings::measure(const std::vector<std::vector<ContactNodeReport>> &reports) const {
  constexpr std::size_t n_sums = 4;
  std::vector<double> sums(n_sums * pairs_.size());
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    double *of_pair = &sums[n_sums * p];
    for (const auto &node : reports[p]) {
      if (!(node.pressure > 0.))
        continue;
      of_pair[0] += node.pressure * node.area;
      if (!(node.tangential_stiffness > 0.))
        continue;
      const double traction =
          std::sqrt(std::max(0., node.traction.norm_square() - node.pressure * node.pressure));
      of_pair[1] += traction * node.area;
      of_pair[3] += 0.5 * traction * traction / node.tangential_stiffness * node.area;
      if (node.status != ContactStatus::stick)
        continue;
      const double when_rigid = std::min(pairs_[p].friction_coefficient * node.pressure,
                                         (1. + pairs_[p].stiffness / node.tangential_stiffness) * traction);
      of_pair[2] += std::max(0., when_rigid - traction) * node.area;
    }
  }
  dealii::Utilities::MPI::sum(sums, communicator_, sums);
  std::vector<StickSoftness> result;
  for (const double *next = sums.data(); result.size() < pairs_.size(); next += n_sums)
    result.push_back({next[0], next[1], next[2], next[3]});
  return result;
}

} // namespace billet
