// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FRICTION_FRICTION_LIMIT_H
#define BILLET_FRICTION_FRICTION_LIMIT_H

namespace billet {

/// The tangential traction at which a point slides, and its derivatives.
struct FrictionLimit {
  double value;          ///< [stress]
  double pressure_slope; ///< ∂value/∂pressure
  double rate_slope;     ///< ∂value/∂(slip rate) [stress time/length]
};

} // namespace billet

#endif
