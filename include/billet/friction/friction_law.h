// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FRICTION_FRICTION_LAW_H
#define BILLET_FRICTION_FRICTION_LAW_H

#include "billet/friction/friction_limit.h"
#include "billet/registered_type.h"

#include <memory>
#include <string>

namespace billet {

/// The tangential traction that a surface bears before it slides.
class FrictionLaw {
public:
  virtual ~FrictionLaw() = default;

  /// Describes the law, for example "mu = 0.1 up to 50".
  virtual std::string description() const = 0;
  /// Returns a typical ratio of limit to pressure at rest, for checks of plausibility and of the
  /// stiffness of tangential springs.
  virtual double coefficient() const = 0;
  /// Returns the limit at a pressure >= 0 [stress] and a slip rate >= 0 [length/time].
  virtual FrictionLimit limit(double pressure, double slip_rate) const = 0;
};

/// Null without friction; then there is no history.
using FrictionPointer = std::shared_ptr<const FrictionLaw>;

/// Friction laws that a scene file can name. To add one, add a file in source/friction/ with a
/// function that returns its type, and its name in the table of friction_law.cc.
struct FrictionLawType : RegisteredType<FrictionPointer> {
  std::string vanishes_with =
      {}; ///< parameter that is 0 without friction; empty: the law is never frictionless
};
TypeTable<FrictionPointer, FrictionLawType> &friction_law_types();

/// Parameter of several friction laws.
extern const TypeParameter friction_coefficient_parameter;
/// Returns the friction coefficient, which must not be 0.
double read_friction_coefficient(const TypeInput &input);

/// Placeholder for a law without friction, so that loops over nodes choose once.
struct Frictionless {};

/// Calls evaluate(law), or evaluate(Frictionless()) for a null pointer.
template <class Evaluate> void choose_friction(const FrictionPointer &friction, const Evaluate &evaluate) {
  if (friction == nullptr)
    evaluate(Frictionless());
  else
    evaluate(*friction);
}

} // namespace billet

#endif
