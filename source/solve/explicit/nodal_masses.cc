// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/nodal_masses.h"

#include <numeric>

namespace billet {

NodalMasses::NodalMasses(const LocalNodes &nodes, ExplicitElements &elements, const double min_step) {
  const MPI_Comm communicator = nodes.discretization().communicator();
  std::vector<double> local = elements.lumped_masses();
  of_bodies_ = dealii::Utilities::MPI::sum(std::accumulate(local.begin(), local.end(), 0.), communicator);
  if (min_step > 0.) {
    added_ = dealii::Utilities::MPI::sum(elements.scale_mass(min_step), communicator);
    local = elements.lumped_masses();
  }
  NodalVectors sums = nodes.make_vectors();
  for (unsigned int node = 0; node < nodes.size(); ++node)
    sums[std::size_t{nodal_stride} * node] = local[node];
  nodes.sum_shared(sums);
  values_.resize(nodes.size());
  for (unsigned int node = 0; node < nodes.size(); ++node)
    values_[node] = sums[std::size_t{nodal_stride} * node];
  for (const double mass : values_)
    inverse_.push_back(1. / mass);
  memory_.set(2 * values_.size() * sizeof(double));
}

} // namespace billet
