// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_DERIVATIVE_H
#define BILLET_GEOMETRY_DERIVATIVE_H

#include <deal.II/base/tensor.h>

#include <Sacado.hpp>

namespace billet {

/// Number with its derivatives by at most this many variables (forward automatic differentiation,
/// Sacado). Results of a template have derivatives that are exact to round-off; the code takes the
/// same branches as with doubles.
constexpr int max_variables = 192;
using Derivative = Sacado::Fad::Exp::SLFad<double, max_variables>;

inline double value_of(const double x) { return x; }
inline double value_of(const Derivative &x) { return x.val(); }

} // namespace billet

// Required by deal.II's tensors.
template <> struct dealii::EnableIfScalar<billet::Derivative> { using type = billet::Derivative; };
template <> struct dealii::internal::ProductTypeImpl<billet::Derivative, billet::Derivative> {
  using type = billet::Derivative;
};
template <> struct dealii::internal::ProductTypeImpl<billet::Derivative, double> {
  using type = billet::Derivative;
};
template <> struct dealii::internal::ProductTypeImpl<double, billet::Derivative> {
  using type = billet::Derivative;
};

#endif
