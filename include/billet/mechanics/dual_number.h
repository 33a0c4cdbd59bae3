// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_DUAL_NUMBER_H
#define BILLET_MECHANICS_DUAL_NUMBER_H

namespace billet {

#define BILLET_DUAL inline __attribute__((always_inline))

/// Number with its derivatives along n directions (forward automatic differentiation): results have
/// exact derivatives.
template <class Value, unsigned int n> struct Dual {
  Value value = {};
  Value rate[n] = {};

  BILLET_DUAL Dual() = default;
  BILLET_DUAL Dual(const Value &constant) : value(constant) {} // NOLINT(google-explicit-constructor)
  BILLET_DUAL Dual &operator+=(const Dual &b) {
    value += b.value;
    for (unsigned int d = 0; d < n; ++d)
      rate[d] += b.rate[d];
    return *this;
  }
  BILLET_DUAL Dual &operator-=(const Dual &b) {
    value -= b.value;
    for (unsigned int d = 0; d < n; ++d)
      rate[d] -= b.rate[d];
    return *this;
  }
  friend BILLET_DUAL Dual operator+(Dual a, const Dual &b) { return a += b; }
  friend BILLET_DUAL Dual operator-(Dual a, const Dual &b) { return a -= b; }
  friend BILLET_DUAL Dual operator*(const Dual &a, const Dual &b) {
    Dual result;
    result.value = a.value * b.value;
    for (unsigned int d = 0; d < n; ++d)
      result.rate[d] = a.value * b.rate[d] + a.rate[d] * b.value;
    return result;
  }
  /// Product with a constant.
  template <class Constant> friend BILLET_DUAL Dual operator*(const Constant &a, const Dual &b) {
    Dual result;
    result.value = a * b.value;
    for (unsigned int d = 0; d < n; ++d)
      result.rate[d] = a * b.rate[d];
    return result;
  }
};

/// Returns 1/x.
template <class Value, unsigned int n> BILLET_DUAL Dual<Value, n> invert(const Dual<Value, n> &x) {
  Dual<Value, n> result;
  const Value one = Value{} + 1;
  result.value = one / x.value;
  for (unsigned int d = 0; d < n; ++d)
    result.rate[d] = -(result.value * result.value) * x.rate[d];
  return result;
}

/// Returns √x; `root` is the square root of a Value.
template <class Value, unsigned int n, class Root>
BILLET_DUAL Dual<Value, n> square_root(const Dual<Value, n> &x, const Root &root) {
  Dual<Value, n> result;
  result.value = root(x.value);
  const Value twice = result.value + result.value;
  for (unsigned int d = 0; d < n; ++d)
    result.rate[d] = x.rate[d] / twice;
  return result;
}

/// Number after a step and its change in the step. Results have changes without cancellation error,
/// however small the step. `Value` holds the lanes of an explicit kernel. `Stepped()` sets nothing.
template <class Value> struct Stepped {
  Value value; ///< value after the step
  Value change;

  BILLET_DUAL Stepped() = default;
  BILLET_DUAL Stepped(const Value &now, const Value &by_step) : value(now), change(by_step) {}
  BILLET_DUAL Value before() const { return value - change; }
  BILLET_DUAL Stepped &operator+=(const Stepped &b) {
    value += b.value;
    change += b.change;
    return *this;
  }
  BILLET_DUAL Stepped &operator-=(const Stepped &b) {
    value -= b.value;
    change -= b.change;
    return *this;
  }
  friend BILLET_DUAL Stepped operator+(Stepped a, const Stepped &b) { return a += b; }
  friend BILLET_DUAL Stepped operator-(Stepped a, const Stepped &b) { return a -= b; }
  friend BILLET_DUAL Stepped operator*(const Stepped &a, const Stepped &b) {
    return {a.value * b.value, a.change * b.value + a.before() * b.change};
  }
  /// Product with a constant.
  template <class Constant> friend BILLET_DUAL Stepped operator*(const Constant &a, const Stepped &b) {
    return {a * b.value, a * b.change};
  }
};

/// Returns 1/x.
template <class Value> BILLET_DUAL Stepped<Value> invert(const Stepped<Value> &x) {
  const Value one = Value{} + 1, value = one / x.value;
  return {value, Value{} - value * x.change / x.before()};
}

/// Returns √x; `root` is the square root of a Value.
template <class Value, class Root>
BILLET_DUAL Stepped<Value> square_root(const Stepped<Value> &x, const Root &root) {
  const Value value = root(x.value);
  return {value, x.change / (value + root(x.before()))};
}
#undef BILLET_DUAL

} // namespace billet

#endif
