// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_HARDENING_CURVES_H
#define BILLET_MATERIAL_HARDENING_CURVES_H

#include "billet/registered_type.h"

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace billet {

/// Measured curves of hardening, each at another value of a quantity such as the temperature, as a
/// factor over the first curve, (H19) of doc/theory.md. Stresses are linear between points and
/// between values, and constant beyond both ends.
class HardeningCurves {
public:
  /// `stresses[i][k]`: at strain i and value k. Strains and values increase strictly.
  HardeningCurves(std::vector<double> strains, std::vector<double> values,
                  std::vector<std::vector<double>> stresses);

  std::size_t size() const { return values_.size(); }
  /// Returns the factor at a plastic strain and a value.
  double factor(double alpha, double value) const;
  /// Returns its derivatives by the value and by the plastic strain; from the right where it has a
  /// kink.
  std::pair<double, double> slopes(double alpha, double value) const;

private:
  /// Place between two numbers; at the ends, and beyond them, both are the same and the length
  /// is 0.
  struct Place {
    std::size_t i, next;
    double part, length;
  };
  static Place find(const std::vector<double> &numbers, double x);
  static double mix(const Place &place, const double from, const double to) {
    return (1. - place.part) * from + place.part * to;
  }
  double stress(const Place &strain, std::size_t k) const;
  double hardening(const Place &strain, std::size_t k) const;

  std::vector<double> strains_, values_;
  std::vector<std::vector<double>> stresses_;
};

/// Parameters of such curves in scene files.
struct CurvesInput {
  /// Names of the parameters: values, file, and columns of the file.
  std::string values_key, file_key, columns_key;
  std::string quantity; ///< of the values, such as "rate"
  std::string unit;     ///< of the values, such as "1/time"

  /// `meaning`: of the values; the unit follows.
  std::vector<TypeParameter> parameters(const std::string &meaning) const;
  /// Returns the curves over `values`, which increase strictly. `check` may refuse the stresses at
  /// a plastic strain, given with words for this strain. Throws as TypeInput::reject().
  HardeningCurves read(const TypeInput &input, std::vector<double> values,
                       const std::function<void(const std::vector<double> &stresses, const std::string &at)>
                           &check = {}) const;
};

} // namespace billet

#endif
