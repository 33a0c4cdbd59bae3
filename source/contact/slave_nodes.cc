// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/slave_nodes.h"

namespace billet {

SlaveNodes::SlaveNodes(const std::vector<SurfaceFacet> &facets, const bool two_pass,
                       const std::vector<double> &sizes) {
  std::vector<bool> is_listed(sizes.size());
  for (const auto &facet : facets)
    for (const unsigned int node : facet.nodes)
      if (!is_listed[node] && (two_pass || facet.surface == 0)) {
        is_listed[node] = true;
        list_.push_back({node, facet.surface});
        sizes_.push_back(sizes[node]);
      }
}

SlavePenalties::SlavePenalties(const SlaveNodes &slaves, const std::vector<ContactStiffness> &stiffness,
                               const bool two_pass, const bool has_friction) {
  const double part = two_pass ? 0.5 : 1., tangential_part = has_friction ? part : 0.;
  for (const SlaveNode &slave : slaves.list())
    given_.push_back(
        {part * stiffness[slave.node].normal, tangential_part * stiffness[slave.node].tangential});
  stiffness_ = given_;
}

void SlavePenalties::scale(const double normal, const double tangential) {
  stiffening_ *= normal;
  tangential_stiffening_ *= tangential;
  for (std::size_t s = 0; s < stiffness_.size(); ++s)
    stiffness_[s] = {stiffening_ * given_[s].normal, tangential_stiffening_ * given_[s].tangential};
}

} // namespace billet
