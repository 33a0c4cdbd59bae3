// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_FORMING_LIMIT_H
#define BILLET_MATERIAL_FORMING_LIMIT_H

#include "billet/registered_type.h"

#include <array>
#include <memory>
#include <vector>

namespace billet {

/// Forming limit curve of a sheet: the major logarithmic strain at which it necks, over the minor
/// one. It is linear between its points, and constant beyond them.
class FormingLimit {
public:
  /// `points`: minor and major strains; minor ones increase strictly, major ones are positive.
  explicit FormingLimit(std::vector<std::array<double, 2>> points) : points_(std::move(points)) {}

  /// Returns the major strain of the curve at a minor one.
  double major_strain(double minor_strain) const;

  /// Returns the parameters in scene files, and reads them; null if none is set.
  static std::vector<TypeParameter> parameters();
  static std::shared_ptr<const FormingLimit> read(const TypeInput &input);

private:
  std::vector<std::array<double, 2>> points_;
};

} // namespace billet

#endif
