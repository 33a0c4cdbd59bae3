// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_COMPATIBILITY_H
#define BILLET_COMPATIBILITY_H

// Names that moved between releases of deal.II, from 9.4 on. Nothing else in the program depends on
// its version.

#include <deal.II/base/config.h>
#include <deal.II/base/index_set.h>
#include <deal.II/lac/affine_constraints.h>

namespace billet::compatibility {

/// Empties `constraints` and prepares them for the locally relevant part of a distributed system.
inline void reinit(dealii::AffineConstraints<double> &constraints, const dealii::IndexSet &owned,
                   const dealii::IndexSet &relevant) {
#if DEAL_II_VERSION_GTE(9, 6, 0)
  constraints.reinit(owned, relevant);
#else
  (void)owned;
  constraints.reinit(relevant);
#endif
}

} // namespace billet::compatibility

#endif
