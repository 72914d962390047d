#pragma once

#include <array>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include <Eigen/Core>

#include "methods/core/derivatives.hpp"
#include "methods/core/points.hpp"
#include "problems/core/jet_tables.hpp"

namespace strongpoint {

/// A function's truncated Taylor expansion about a point: all its derivatives up to a total order,
/// carried exactly (to round-off) through arithmetic and elementary functions. Write the function
/// once, generic in its number type, and evaluate it on jets to differentiate it. Where a function
/// is not smooth or not defined the result holds NaN or infinity, as that of <cmath> does. Cost of
/// a product: binomial(Order + 2 Dim, 2 Dim) multiplications.
template <int Dim, int Order>
class Jet {
  static constexpr const JetTables<Dim, Order>& tables = jet_tables<Dim, Order>;

 public:
  /// Number of coefficients.
  static constexpr int size = JetTables<Dim, Order>::size;
  /// Taylor coefficients f^(k) / k! of a function of one variable.
  using Series = std::array<double, Order + 1>;

  /// Zero.
  Jet() = default;
  /// A constant; implicit, so that numbers mix with jets.
  Jet(double constant) { c_[0] = constant; }  // NOLINT(google-explicit-constructor)

  /// Coordinate number `axis` at a point where it has this value.
  static Jet variable(double value, int axis) {
    Jet jet(value);
    if constexpr (Order > 0) {
      MultiIndex<Dim> alpha{};
      alpha.at(axis) = 1;
      jet.c_[tables.position(alpha)] = 1;
    }
    return jet;
  }

  /// Value at the point.
  double value() const { return c_[0]; }

  /// A partial derivative at the point. Throws std::logic_error when the jet does not carry it.
  double derivative(const MultiIndex<Dim>& alpha) const {
    if (order_of<Dim>(alpha) > Order) {
      throw std::logic_error("derivative " + name_of<Dim>(alpha) + " is of order " +
                             std::to_string(order_of<Dim>(alpha)) + ", the jet carries order " +
                             std::to_string(Order) + "; evaluate with jets of a higher order");
    }
    return factorial<Dim>(alpha) * c_[tables.position(alpha)];
  }

  /// f(jet) for a function of one variable whose Taylor series about `value()` is given.
  Jet compose(const Series& series) const {
    Jet rest = *this;
    rest.c_[0] = 0;
    Jet result(series[Order]);
    for (int k = Order - 1; k >= 0; --k) {
      result *= rest;
      result.c_[0] += series[k];
    }
    return result;
  }

  /// The same jet with another value: what an added constant does, without its rounding.
  Jet with_value(double value) const {
    Jet result = *this;
    result.c_[0] = value;
    return result;
  }

  /// Arithmetic between jets, and between jets and numbers, coefficient by coefficient where it can
  /// be.
  Jet operator-() const {
    Jet result;
    for (int i = 0; i < size; ++i) result.c_[i] = -c_[i];
    return result;
  }
  Jet operator+() const { return *this; }

  Jet& operator+=(const Jet& b) {
    for (int i = 0; i < size; ++i) c_[i] += b.c_[i];
    return *this;
  }
  Jet& operator-=(const Jet& b) {
    for (int i = 0; i < size; ++i) c_[i] -= b.c_[i];
    return *this;
  }
  Jet& operator*=(const Jet& b) {
    std::array<double, size> sum{};
    const std::uint8_t* product = tables.products.data();
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < tables.partners[i]; ++j) sum[*product++] += c_[i] * b.c_[j];
    }
    c_ = sum;
    return *this;
  }
  /// Long division: the quotient's coefficients one after the other, each taken off the remainder.
  Jet& operator/=(const Jet& divisor) {
    const Jet b = divisor;  // the divisor may be this very jet
    const std::uint8_t* product = tables.products.data();
    for (int i = 0; i < size; ++i) {
      c_[i] /= b.c_[0];
      ++product;
      for (int j = 1; j < tables.partners[i]; ++j) c_[*product++] -= c_[i] * b.c_[j];
    }
    return *this;
  }
  Jet& operator+=(double b) {
    c_[0] += b;
    return *this;
  }
  Jet& operator-=(double b) {
    c_[0] -= b;
    return *this;
  }
  Jet& operator*=(double b) {
    for (double& c : c_) c *= b;
    return *this;
  }
  Jet& operator/=(double b) {
    for (double& c : c_) c /= b;
    return *this;
  }

  friend Jet operator+(Jet a, const Jet& b) { return a += b; }
  friend Jet operator-(Jet a, const Jet& b) { return a -= b; }
  friend Jet operator*(Jet a, const Jet& b) { return a *= b; }
  friend Jet operator/(Jet a, const Jet& b) { return a /= b; }
  friend Jet operator+(Jet a, double b) { return a += b; }
  friend Jet operator-(Jet a, double b) { return a -= b; }
  friend Jet operator*(Jet a, double b) { return a *= b; }
  friend Jet operator/(Jet a, double b) { return a /= b; }
  friend Jet operator+(double a, Jet b) { return b += a; }
  friend Jet operator-(double a, const Jet& b) { return -b + a; }
  friend Jet operator*(double a, Jet b) { return b *= a; }
  friend Jet operator/(double a, const Jet& b) { return Jet(a) / b; }

  /// Comparisons look at the values, so that generic code takes the branch that numbers would.
  friend bool operator==(const Jet& a, const Jet& b) { return a.value() == b.value(); }
  friend std::partial_ordering operator<=>(const Jet& a, const Jet& b) {
    return a.value() <=> b.value();
  }

  /// Elementary functions: the function's own Taylor series, composed with the jet.
  friend Jet exp(const Jet& x) {
    Series s{std::exp(x.value())};
    for (int k = 1; k <= Order; ++k) s[k] = s[k - 1] / k;
    return x.compose(s);
  }
  friend Jet log(const Jet& x) {
    Series s{std::log(x.value())};
    double power = -1;
    for (int k = 1; k <= Order; ++k) {
      power /= -x.value();
      s[k] = power / k;
    }
    return x.compose(s);
  }
  friend Jet sin(const Jet& x) { return x.compose(wave(std::sin(x.value()), std::cos(x.value()))); }
  friend Jet cos(const Jet& x) {
    return x.compose(wave(std::cos(x.value()), -std::sin(x.value())));
  }
  friend Jet tan(const Jet& x) { return sin(x) / cos(x); }
  friend Jet sqrt(const Jet& x) {
    Series s{std::sqrt(x.value())};
    for (int k = 1; k <= Order; ++k) s[k] = s[k - 1] * (1.5 - k) / (k * x.value());
    return x.compose(s);
  }
  /// x^power; whole powers also where x is zero or negative.
  friend Jet pow(const Jet& x, double power) {
    Series s{};
    double binomial = 1;
    for (int k = 0; k <= Order && binomial != 0; ++k) {
      s[k] = binomial * std::pow(x.value(), power - k);
      binomial *= (power - k) / (k + 1);
    }
    return x.compose(s);
  }
  friend Jet atan(const Jet& x) {
    // The derivative g = 1 / (1 + (x + t)^2) has the recurrence (1 + x^2) g_k + 2 x g_k-1 + g_k-2 =
    // 0.
    const double x0 = x.value();
    const double scale = 1 + x0 * x0;
    Series s{std::atan(x0)};
    double previous = 0;
    double g = 1 / scale;
    for (int k = 1; k <= Order; ++k) {
      s[k] = g / k;
      const double next = -(2 * x0 * g + previous) / scale;
      previous = g;
      g = next;
    }
    return x.compose(s);
  }
  /// The angle of (x, y) in (-pi, pi]; not differentiable at the origin (NaN).
  friend Jet atan2(const Jet& y, const Jet& x) {
    // Two branches of the same derivative, so that neither quotient exceeds 1.
    const bool flat = std::abs(x.value()) >= std::abs(y.value());
    const Jet angle = flat ? atan(y / x) : -atan(x / y);
    return angle.with_value(std::atan2(y.value(), x.value()));
  }

 private:
  std::array<double, size> c_{};

  /// Series of a function whose derivatives repeat as f, f', -f, -f'.
  static Series wave(double f, double slope) {
    Series s{f};
    if constexpr (Order > 0) s[1] = slope;
    for (int k = 2; k <= Order; ++k) s[k] = -s[k - 2] / (k * (k - 1));
    return s;
  }
};

/// The coordinates of a point as jets, to be passed to a generic function.
template <int Dim, int Order>
std::array<Jet<Dim, Order>, Dim> jet_variables(const Point<Dim>& x) {
  std::array<Jet<Dim, Order>, Dim> variables;
  for (int c = 0; c < Dim; ++c) variables[c] = Jet<Dim, Order>::variable(x[c], c);
  return variables;
}

/// Evaluates `function(const std::array<T, Dim>&)`, generic in T, with jets at a point. Gives
/// whatever it returns: a jet, or several in an array or a struct.
template <int Dim, int Order, class Function>
auto jets_at(const Function& function, const Point<Dim>& x) {
  return function(jet_variables<Dim, Order>(x));
}

/// Derivatives at a point, in the order of `wanted`, of a scalar `function(const std::array<T,
/// Dim>&)` that is generic in T. Throws std::logic_error when one is of an order above 8.
template <int Dim, class Function>
Eigen::VectorXd exact_derivatives(const Function& function, const Point<Dim>& x,
                                  const Derivatives<Dim>& wanted) {
  const auto pick = [&wanted](const auto& jet) {
    Eigen::VectorXd values(wanted.size());
    for (int i = 0; i < wanted.size(); ++i) values[i] = jet.derivative(wanted[i]);
    return values;
  };
  // Few sizes only: each is compiled for every function.
  const int order = wanted.highest_order();
  if (order <= 2) return pick(jets_at<Dim, 2>(function, x));
  if (order <= 4) return pick(jets_at<Dim, 4>(function, x));
  return pick(jets_at<Dim, 8>(function, x));
}

}  // namespace strongpoint
