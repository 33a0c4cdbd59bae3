// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_FREE_MASS_H
#define BILLET_SOLVE_IMPLICIT_FREE_MASS_H

#include "billet/forces/inertia.h"

namespace billet {

/// Mass of all bodies, with the supports: accelerations by forces on free dofs.
class FreeMass {
public:
  /// The discretization and the supports must outlive it.
  FreeMass(const Scene &scene, const Discretization &discretization, const Supports &supports,
           bool is_lumped);

  const Inertia &inertia() const { return inertia_; }
  /// Returns the row sums of M, an owned vector [mass].
  const Vector &row_sums() const { return row_sums_; }
  /// Returns M x of an owned vector x. Collective.
  Vector times(const Vector &x) const;
  /// Returns −M⁻¹ F of these forces on the free dofs; constrained dofs satisfy the homogeneous
  /// constraints. Collective.
  Vector accelerations_by(const Vector &forces) const;

private:
  const Discretization &discretization_;
  const Supports &supports_;
  Inertia inertia_;
  Vector row_sums_;
};

} // namespace billet

#endif
