// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SLAVE_TANGENTS_H
#define BILLET_CONTACT_SLAVE_TANGENTS_H

#include "billet/contact/facet_contact_parts.h"

#include <deal.II/lac/full_matrix.h>

#include <functional>
#include <memory>
#include <vector>

namespace billet {

/// The tangents of slave nodes. Made once for the method, with friction or without, which no node
/// asks for.
class SlaveTangents {
public:
  /// Called with nodes i, j, ... of this rank and ghosts, and the matrix −∂F_c,i/∂x_j, three rows and columns
  /// a node [force/length].
  using Add = std::function<void(const std::vector<unsigned int> &, const dealii::FullMatrix<double> &)>;

  virtual ~SlaveTangents() = default;
  SlaveTangents(const SlaveTangents &) = delete;
  SlaveTangents &operator=(const SlaveTangents &) = delete;

  /// Adds the tangent of the last evaluation: of each slave that touches, the part of this rank's area. Kinds
  /// as of compute_traction(); all but the exact and the numerical ones hold normals, areas and weights.
  virtual void visit(ContactTangent kind, const Add &add) const = 0;

protected:
  SlaveTangents() = default;
};

/// The parts have to outlive the tangents.
std::unique_ptr<SlaveTangents> make_slave_tangents(const FacetContactParts &parts);

/// Whether tangents of this kind depend on the nodes of the slave's own facets.
inline bool follows_own_facets(const ContactTangent kind) {
  return kind == ContactTangent::exact || kind == ContactTangent::numerical;
}

} // namespace billet

#endif
