// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_DERIVATIVE_H
#define BILLET_GEOMETRY_DERIVATIVE_H

#include <deal.II/base/tensor.h>

#include <Sacado.hpp>

namespace billet {

/// A number that carries its derivatives by so many variables along (forward differentiation, Sacado). What a
/// template computes with it has derivatives that are exact to round-off, of the same branches that doubles
/// take.
constexpr int most_variables = 192;
using Derivative = Sacado::Fad::Exp::SLFad<double, most_variables>;

inline double value_of(const double x) { return x; }
inline double value_of(const Derivative &x) { return x.val(); }

} // namespace billet

// So that deal.II's tensors take it.
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
