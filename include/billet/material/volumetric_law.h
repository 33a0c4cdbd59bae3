// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_VOLUMETRIC_LAW_H
#define BILLET_MATERIAL_VOLUMETRIC_LAW_H

#include "billet/registered_type.h"

#include <memory>
#include <utility>

namespace billet {

/// Volumetric part of a stored energy over the bulk modulus, u(J) = U/κ, (V5) of
/// doc/theory/rubber.md. At J = 1, u = 0, J u' = 0, and the slope of J u' over ln J is 1.
class VolumetricLaw {
public:
  virtual ~VolumetricLaw() = default;

  /// Returns u.
  virtual double energy(double J) const = 0;
  /// Returns the mean Kirchhoff stress over κ, p = J u'.
  virtual double mean_stress(double J) const = 0;
  /// Returns dp/d ln J.
  virtual double slope(double J) const = 0;
  /// Returns an upper bound of slope() where mean_stress() is p. It bounds explicit steps.
  virtual double bound_slope(double p) const = 0;
};
using SharedVolumetricLaw = std::shared_ptr<const VolumetricLaw>;

/// Volumetric laws that a scene file can name for rubber. A new one is a file in source/material/
/// with a function that returns its type, and its name in the table of volumetric_law.cc.
using VolumetricLawType = RegisteredType<SharedVolumetricLaw>;
TypeTable<SharedVolumetricLaw> &volumetric_law_types();
inline constexpr const char *volumetric_law_key = "Volumetric law";

/// Returns u = ½ ln²J.
SharedVolumetricLaw make_logarithmic_volume();

/// Volumetric part U(J) = κ u(J) of a stored energy.
class VolumetricEnergy {
public:
  /// `bulk`: κ [stress].
  VolumetricEnergy(SharedVolumetricLaw law, const double bulk) : law_(std::move(law)), bulk_(bulk) {}

  double bulk_modulus() const { return bulk_; }
  /// Returns U per reference volume [stress].
  double energy(const double J) const { return bulk_ * law_->energy(J); }
  /// Returns the mean Kirchhoff stress J U' [stress].
  double mean_stress(const double J) const { return bulk_ * law_->mean_stress(J); }
  /// Returns the derivative of the mean stress by ln J [stress].
  double slope(const double J) const { return bulk_ * law_->slope(J); }
  /// Returns an upper bound of slope() at a mean stress [stress].
  double bound_slope(const double mean_stress) const {
    return bulk_ * law_->bound_slope(mean_stress / bulk_);
  }

private:
  SharedVolumetricLaw law_;
  double bulk_;
};

} // namespace billet

#endif
