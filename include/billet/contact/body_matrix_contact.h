// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_BODY_MATRIX_CONTACT_H
#define BILLET_CONTACT_BODY_MATRIX_CONTACT_H

#include "billet/contact/body_contact_parts.h"
#include "billet/contact/body_couplings.h"
#include "billet/contact/facet_paths.h"
#include "billet/contact/matrix_contact.h"

namespace billet {

/// Contact between bodies in schemes with a matrix.
class BodyMatrixContact final : public MatrixContact {
public:
  /// The parts must outlive this object.
  BodyMatrixContact(BodyContactParts &parts, ContactTangent tangent);

  void update(const Vector &displacements) override;
  void add_forces(Vector &residual) const override;
  void set_tangent(const ContactTangent tangent) override { couplings_.set_tangent(tangent); }
  void add_tangent(const TangentSystem &system) const override { couplings_.add_tangent(system); }
  /// Returns the part of a motion before a node of either body goes through the other's facets, see
  /// FacetPaths.
  double find_free_part(const ContactPath &path) const override;
  /// Also allows the existing overlap.
  void begin(const ContactStep &step, const Vector &displacements) override;

  BodyCouplings &couplings() override { return couplings_; }
  const BodyCouplings &couplings() const override { return couplings_; }

private:
  /// Computes the positions of the surface nodes.
  void place(const Vector &displacements, FacetSearch::Positions &positions) const;

  BodyContactParts &parts_;
  BodyCouplings couplings_;
  mutable FacetPaths paths_; ///< exchanges facets of ranks
};

} // namespace billet

#endif
