// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/forces/inertia.h"

#include <deal.II/lac/full_matrix.h>

#include <numeric>

namespace billet {

Inertia::Inertia(const Scene &scene, const Discretization &discretization, const bool is_lumped)
    : discretization_(discretization) {
  double own = 0.;
  masses_.resize(discretization.n_bodies());
  for (std::size_t b = 0; b < masses_.size(); ++b)
    for (const auto &element : discretization.elements(b)) {
      ReferenceElement reference{};
      compute_reference_element(nodal_positions(element.cell), reference);
      masses_[b].push_back(compute_element_mass(reference, scene.bodies()[b].density));
      own = std::accumulate(masses_[b].back().begin(), masses_[b].back().end(), own);
      if (is_lumped)
        lump(masses_[b].back());
    }
  total_ = dealii::Utilities::MPI::sum(own, discretization.communicator());
}

Vector Inertia::times(const Vector &ghosted) const {
  Vector sum = discretization_.make_additive_vector();
  for (std::size_t b = 0; b < masses_.size(); ++b)
    for (std::size_t e = 0; e < masses_[b].size(); ++e) {
      const auto &dofs = discretization_.elements(b)[e].dofs;
      const ElementVectors x = gather(ghosted, dofs);
      ElementVectors y{};
      for (unsigned int i = 0; i < n_element_nodes; ++i)
        for (unsigned int j = 0; j < n_element_nodes; ++j)
          for (unsigned int c = 0; c < 3; ++c)
            y[3 * i + c] += masses_[b][e][i * n_element_nodes + j] * x[3 * j + c];
      sum.add(n_element_dofs, dofs.data(), y.data());
    }
  sum.compress(dealii::VectorOperation::add);
  Vector result = discretization_.make_owned_vector();
  result = sum;
  return result;
}

void Inertia::add_tangent(const double factor, const TangentSystem &system) const {
  dealii::FullMatrix<double> matrix(n_element_dofs, n_element_dofs);
  std::vector<DofIndex> dofs(n_element_dofs);
  for (std::size_t b = 0; b < masses_.size(); ++b)
    for (std::size_t e = 0; e < masses_[b].size(); ++e) {
      for (unsigned int i = 0; i < n_element_nodes; ++i)
        for (unsigned int j = 0; j < n_element_nodes; ++j)
          for (unsigned int c = 0; c < 3; ++c)
            matrix(3 * i + c, 3 * j + c) = factor * masses_[b][e][i * n_element_nodes + j];
      const auto &element = discretization_.elements(b)[e].dofs;
      dofs.assign(element.begin(), element.end());
      system.add(matrix, dofs);
    }
}

std::vector<double> Inertia::nodal_masses(const LocalNodes &nodes) const {
  std::vector<double> result(nodes.size(), 0.);
  for (std::size_t b = 0; b < masses_.size(); ++b)
    for (std::size_t e = 0; e < masses_[b].size(); ++e)
      for (unsigned int i = 0; i < n_element_nodes; ++i)
        for (unsigned int j = 0; j < n_element_nodes; ++j)
          result[nodes.elements(b)[e][i]] += masses_[b][e][i * n_element_nodes + j];
  return result;
}

} // namespace billet
