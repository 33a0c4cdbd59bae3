// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_MATRIX_CONTACT_H
#define BILLET_CONTACT_MATRIX_CONTACT_H

#include "billet/contact/contact_couplings.h"
#include "billet/contact/contact_step.h"
#include "billet/contact/traction.h"
#include "billet/discretization/supports.h"

namespace billet {

/// Forces of a contact pair in schemes with a matrix, and their tangents. Displacements are
/// distributed vectors.
class MatrixContact {
public:
  virtual ~MatrixContact() = default;
  MatrixContact(const MatrixContact &) = delete;
  MatrixContact &operator=(const MatrixContact &) = delete;

  /// Computes gaps and tractions at `displacements` (ghosted). Collective.
  virtual void update(const Vector &displacements) = 0;
  /// Adds −F_c [force] to `residual` (additive vector).
  virtual void add_forces(Vector &residual) const = 0;
  /// Sets the kind of tangents from now on.
  virtual void set_tangent(ContactTangent tangent) = 0;
  /// Adds −∂F_c/∂u [force/length]. Collective.
  virtual void add_tangent(const TangentSystem &system) const = 0;
  /// Returns the part of a motion during which no node goes through a surface (C12). A node that
  /// would soon come out on another side counts as through. Collective.
  virtual double find_free_part(const ContactPath &path) const = 0;
  /// Starts a pair that is new at the start of a step, as if it had existed without contact.
  /// Collective.
  virtual void begin(const ContactStep &step, const Vector &displacements) = 0;

  /// Returns no couplings, unless contact is between bodies.
  virtual ContactCouplings &couplings() { return no_couplings_; }
  virtual const ContactCouplings &couplings() const { return no_couplings_; }

protected:
  MatrixContact() = default;

private:
  ContactCouplings no_couplings_;
};

} // namespace billet

#endif
