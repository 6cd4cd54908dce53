// SPDX-License-Identifier: GPL-3.0-or-later
// A number and its derivatives in N variables, so that a formula written once gives exact derivatives too
// (forward differentiation). Nested, Jet<Jet<double, 1>, 1>, it carries the second derivative in one
// variable; that is why it is not Ceres's Jet, whose constants are not made of a number when it is nested.
//
// Example: auto r = variable<2>(3.0, 0);  (r * r).d[0] == 6
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

namespace skinframe {

template <class T, int N>
struct Jet {
  T v{};
  std::array<T, N> d{};

  Jet() = default;
  Jet(double value) : v(value) {}  // NOLINT(google-explicit-constructor): constants stand in formulas

  Jet& operator+=(const Jet& o) { return *this = *this + o; }
  Jet& operator-=(const Jet& o) { return *this = *this - o; }
  Jet& operator*=(const Jet& o) { return *this = *this * o; }
  Jet& operator/=(const Jet& o) { return *this = *this / o; }

  // f(v) with f'(v) = slope.
  Jet chained(const T& value, const T& slope) const {
    Jet out;
    out.v = value;
    for (int i = 0; i < N; ++i) out.d[i] = slope * d[i];
    return out;
  }
  friend Jet operator-(const Jet& a) { return a.chained(-a.v, T(-1.0)); }
  friend Jet operator+(const Jet& a, const Jet& b) {
    Jet out;
    out.v = a.v + b.v;
    for (int i = 0; i < N; ++i) out.d[i] = a.d[i] + b.d[i];
    return out;
  }
  friend Jet operator-(const Jet& a, const Jet& b) { return a + (-b); }
  friend Jet operator*(const Jet& a, const Jet& b) {
    Jet out;
    out.v = a.v * b.v;
    for (int i = 0; i < N; ++i) out.d[i] = a.d[i] * b.v + a.v * b.d[i];
    return out;
  }
  friend Jet operator/(const Jet& a, const Jet& b) {
    const T inverse = T(1.0) / b.v;
    return a * b.chained(inverse, -inverse * inverse);
  }
  friend bool operator==(const Jet& a, const Jet& b) { return a.v == b.v; }  // Eigen asks for it
  friend Jet sqrt(const Jet& a) {
    using std::sqrt;
    const T root = sqrt(a.v);
    return a.chained(root, T(0.5) / root);
  }
};

template <int N>
using Gradient = Jet<double, N>;
using Curve = Jet<Jet<double, 1>, 1>;  // value, first and second derivative in one variable

template <int N>
Gradient<N> variable(double value, int index) {
  Gradient<N> out(value);
  out.d[index] = 1.0;
  return out;
}

inline Curve curve_variable(double value) {
  Curve out(value);
  out.v.d[0] = 1.0;
  out.d[0].v = 1.0;
  return out;
}

inline double value_of(double x) { return x; }
template <class T, int N>
double value_of(const Jet<T, N>& x) {
  return value_of(x.v);
}

}  // namespace skinframe

namespace Eigen {
template <class T, int N>
struct NumTraits<skinframe::Jet<T, N>> : NumTraits<double> {
  using Real = skinframe::Jet<T, N>;
  using NonInteger = skinframe::Jet<T, N>;
  using Nested = skinframe::Jet<T, N>;
  using Literal = double;
  enum { IsComplex = 0, IsInteger = 0, IsSigned = 1, RequireInitialization = 1 };
};
}  // namespace Eigen
