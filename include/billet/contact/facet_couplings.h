// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_COUPLINGS_H
#define BILLET_CONTACT_FACET_COUPLINGS_H

#include "billet/contact/facet_contact_parts.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace billet {

/// Facets to which the matrix couples slave nodes.
class FacetCouplings {
public:
  /// The parts must outlive this object.
  explicit FacetCouplings(const FacetContactParts &parts) : parts_(parts) {}

  /// Calls add(nodes) with the nodes of each block that SlaveTangents may add until coupling facets
  /// change, and records the blocks.
  void find(ContactTangent kind, const std::function<void(const std::vector<unsigned int> &)> &add);
  /// Whether SlaveTangents has blocks of this rank that the last find() did not include.
  bool has_new() const;
  /// Returns the record of the last find() as numbers; set() restores it.
  std::vector<double> numbers() const;
  void set(const std::vector<double> &numbers);

private:
  /// Returns the facets of a slave, now and where it may slide next.
  std::vector<unsigned int> facets_of(std::size_t s) const;

  const FacetContactParts &parts_;
  std::vector<std::vector<std::uint64_t>> coupled_; ///< keys of facets, sorted, by slave
};

} // namespace billet

#endif
