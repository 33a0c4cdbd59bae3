// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_ANISOTROPY_H
#define BILLET_MATERIAL_ANISOTROPY_H

#include "billet/geometry/axes.h"
#include "billet/material/log_map.h"
#include "billet/registered_type.h"

#include <memory>
#include <string>

namespace billet {

/// Coefficients of Hill's quadratic yield function in the material axes (Hill 1948), (H11) of
/// doc/theory.md,
///   Q² = F (σ22 − σ33)² + G (σ33 − σ11)² + H (σ11 − σ22)² + 2 L σ23² + 2 M σ13² + 2 N σ12².
/// The default is von Mises' function.
struct HillCoefficients {
  double F = 0.5, G = 0.5, H = 0.5, L = 1.5, M = 1.5, N = 1.5;

  /// Returns those of a sheet with these ratios of the strain rates across and through it. The
  /// ratios are those in tension along 0°, 45° and 90° to axis 1. Since G + H = 1, the flow stress
  /// is that along axis 1. Shear through the sheet is that of von Mises, L = M = 3/2.
  static HillCoefficients from_r_values(double r0, double r45, double r90);
  /// Returns those of yield stresses along 11, 22, 33, 12, 13, 23 over those of von Mises'
  /// function.
  static HillCoefficients from_stress_ratios(const std::array<double, 6> &ratios);

  /// Whether Q² is positive for all stresses with a deviator, so that the yield surface is convex
  /// and closed.
  bool is_convex() const;
  /// Returns H for which Q² = σ : H : σ, in Kelvin's notation, with material axes along these unit
  /// vectors.
  Matrix6 matrix(const std::array<dealii::Tensor<1, 3>, 3> &axes) const;
};

/// Anisotropic yield function of a material.
struct Anisotropy {
  HillCoefficients coefficients;
  Axes axes; ///< of the undeformed body

  /// Returns a description such as "Hill's anisotropy (F 0.28, ...)".
  std::string description() const;
};

/// Yield functions that a scene file can name; "none" makes a null pointer. A new one is a file in
/// source/material/ with a function that returns its type, and its name in the table of
/// anisotropy.cc.
using AnisotropyType = RegisteredType<std::shared_ptr<const Anisotropy>>;
TypeTable<std::shared_ptr<const Anisotropy>> &anisotropy_types();

} // namespace billet

#endif
