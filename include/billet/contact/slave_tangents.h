// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SLAVE_TANGENTS_H
#define BILLET_CONTACT_SLAVE_TANGENTS_H

#include "billet/contact/facet_contact_parts.h"
#include "billet/contact/traction.h"

#include <deal.II/lac/full_matrix.h>

#include <functional>
#include <memory>
#include <vector>

namespace billet {

/// Tangents of slave nodes. Method and friction are fixed at construction, so that no node tests
/// for them.
class SlaveTangents {
public:
  /// Function that receives nodes i, j, ... of this rank and ghosts, and the matrix −∂F_c,i/∂x_j,
  /// with three rows and columns per node [force/length].
  using Add = std::function<void(const std::vector<unsigned int> &, const dealii::FullMatrix<double> &)>;

  virtual ~SlaveTangents() = default;
  SlaveTangents(const SlaveTangents &) = delete;
  SlaveTangents &operator=(const SlaveTangents &) = delete;

  /// Adds the tangent of the last evaluation: for each slave that touches, the part of this rank's
  /// area. Kinds are those of compute_traction(); all except the exact and the numerical ones fix
  /// normals, areas and weights.
  virtual void visit(ContactTangent kind, const Add &add) const = 0;

protected:
  SlaveTangents() = default;
};

/// Makes the tangents. The parts must outlive them.
std::unique_ptr<SlaveTangents> make_slave_tangents(const FacetContactParts &parts);

/// Whether tangents of this kind depend on the nodes of the slave's own facets.
inline bool follows_own_facets(const ContactTangent kind) { return form_of(kind) != TangentForm::closed; }

} // namespace billet

#endif
