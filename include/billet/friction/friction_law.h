// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FRICTION_FRICTION_LAW_H
#define BILLET_FRICTION_FRICTION_LAW_H

#include "billet/friction/coulomb.h"
#include "billet/friction/pressure_dependent.h"
#include "billet/friction/shear_limited.h"
#include "billet/friction/static_kinetic.h"

#include <variant>

namespace billet {

/// No friction: nothing is kept for it.
struct Frictionless {};

/// A law is a small value type with
///   FrictionLimit limit(double pressure, double slip_rate) const
/// for pressure >= 0 and slip_rate >= 0. A new one is a file beside this one, a name in this list, its
/// instance in contact/traction.cc, and its parameters in parameters/tool.cc and scene/scene.cc.
using FrictionLaw = std::variant<Frictionless, Coulomb, ShearLimited, StaticKinetic, PressureDependent>;

} // namespace billet

#endif
