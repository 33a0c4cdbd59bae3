// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SLAVE_NODES_H
#define BILLET_CONTACT_SLAVE_NODES_H

#include "billet/contact/facet_search.h"
#include "billet/contact/traction.h"

#include <vector>

namespace billet {

/// The nodes of this rank that may touch facets, and the sizes of the undeformed facets around them.
class SlaveNodes {
public:
  /// Lists the nodes of all `facets`, which are this rank's, in their order; with one pass, those of surface
  /// 0 only. `sizes` [length] is of each of the rank's nodes.
  SlaveNodes(const std::vector<SurfaceFacet> &facets, bool two_pass, const std::vector<double> &sizes);

  std::size_t size() const { return list_.size(); }
  const std::vector<SlaveNode> &list() const { return list_; }
  unsigned int node(const std::size_t s) const { return list_[s].node; }
  unsigned int surface(const std::size_t s) const { return list_[s].surface; }
  /// [length]
  double facet_size(const std::size_t s) const { return sizes_[s]; }
  /// The largest gap of facets that fit each other [length].
  double flush_gap(const std::size_t s) const { return 1e-9 * sizes_[s]; }
  /// Depths that count as none: small against those that stiff penalties leave [length].
  double depth_rounding(const std::size_t s) const { return 1e-12 * sizes_[s]; }

private:
  std::vector<SlaveNode> list_;
  std::vector<double> sizes_;
};

/// The penalties of slave nodes, in one of the passes, and how many times as stiff they are as given.
class SlavePenalties {
public:
  /// `stiffness`, of each of the rank's nodes, is that of a node in one pass; two share it.
  SlavePenalties(const SlaveNodes &slaves, const std::vector<ContactStiffness> &stiffness, bool two_pass);

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
