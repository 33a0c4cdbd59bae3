// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SLAVE_NODES_H
#define BILLET_CONTACT_SLAVE_NODES_H

#include "billet/contact/facet_search.h"
#include "billet/contact/traction.h"

#include <vector>

namespace billet {

/// Nodes of this rank that may touch facets, and the sizes of the undeformed facets around them.
class SlaveNodes {
public:
  /// Lists the nodes of all `facets` of this rank, in their order; with one pass, only those of
  /// surface 0. `sizes` [length] has an entry for each of the rank's nodes.
  SlaveNodes(const std::vector<SurfaceFacet> &facets, bool two_pass, const std::vector<double> &sizes);

  std::size_t size() const { return list_.size(); }
  const std::vector<SlaveNode> &list() const { return list_; }
  unsigned int node(const std::size_t s) const { return list_[s].node; }
  unsigned int surface(const std::size_t s) const { return list_[s].surface; }
  /// Returns the size of the facets around a slave [length].
  double facet_size(const std::size_t s) const { return sizes_[s]; }
  /// Returns the maximum gap at which facets count as flush [length].
  double flush_gap(const std::size_t s) const { return 1e-9 * sizes_[s]; }
  /// Returns the maximum penetration that counts as none: small compared with those at stiff
  /// penalties [length].
  double penetration_rounding(const std::size_t s) const { return 1e-12 * sizes_[s]; }

private:
  std::vector<SlaveNode> list_;
  std::vector<double> sizes_;
};

/// Penalties of slave nodes in one of the passes, and their factors on the given ones.
class SlavePenalties {
public:
  /// Constructs the penalties. `stiffness` of each of the rank's nodes applies to one pass; two
  /// passes share it. Without friction, tangential penalties are 0.
  SlavePenalties(const SlaveNodes &slaves, const std::vector<ContactStiffness> &stiffness, bool two_pass,
                 bool has_friction);

  const ContactStiffness &operator[](const std::size_t s) const { return stiffness_[s]; }
  void scale(double normal, double tangential);
  /// Returns the factors on the given penalties so far.
  double stiffening() const { return stiffening_; }
  double tangential_stiffening() const { return tangential_stiffening_; }

private:
  std::vector<ContactStiffness> given_, stiffness_;
  double stiffening_ = 1., tangential_stiffening_ = 1.;
};

} // namespace billet

#endif
