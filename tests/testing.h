// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_TESTING_H
#define BILLET_TESTS_TESTING_H

#include "checks.h"

#include <deal.II/base/tensor.h>

#include <deal.II/physics/transformations.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <sstream>
#include <string>

/// What the tests share.
namespace billet::testing {

/// Checks that an error is at most the tolerance; one that is not a number fails.
inline void check(const std::string &name, const double error, const double tolerance) {
  std::ostringstream detail;
  detail.precision(3);
  detail << " (error " << error << ", at most " << tolerance << ")";
  report_check(name, error <= tolerance, detail.str());
}

/// Whether a is b but for this part of it.
inline bool near(const double a, const double b, const double part) {
  return std::abs(a - b) <= part * std::abs(b);
}

/// The largest of many errors; not a number as soon as one of them is.
class WorstError {
public:
  void add(const double error) { value_ = std::isnan(error) ? error : std::max(error, value_); }
  double value() const { return value_; }

private:
  double value_ = 0.;
};

/// Derivative of f at 0 by central differences of fourth order.
template <class Function> auto central_difference(const Function &f, const double h) {
  return (8. * (f(h) - f(-h)) - (f(2. * h) - f(-2. * h))) / (12. * h);
}

/// The same numbers on every machine, unlike the distributions of <random>.
class Random {
public:
  double operator()(const double low, const double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967296.;
  }

  dealii::Tensor<1, 3> vector(const double size) {
    dealii::Tensor<1, 3> result;
    for (unsigned int i = 0; i < 3; ++i)
      result[i] = (*this)(-size, size);
    return result;
  }

  dealii::Tensor<2, 3> tensor(const double size) {
    dealii::Tensor<2, 3> result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        result[i][j] = (*this)(-size, size);
    return result;
  }

  dealii::Tensor<2, 3> rotation() {
    dealii::Tensor<1, 3> axis;
    do
      axis = vector(1.);
    while (!(axis.norm() > 0.1 && axis.norm() < 1.));
    return dealii::Physics::Transformations::Rotations::rotation_matrix_3d(
        dealii::Tensor<1, 3>(axis / axis.norm()), (*this)(0., 2. * M_PI));
  }

private:
  std::mt19937 engine_;
};

} // namespace billet::testing

#endif
