#include "methods/core/radial_function.hpp"

#include <cmath>

#include <fmt/format.h>

namespace strongpoint {
namespace {

using Form = RadialFunction::Form;

/// base^exponent and its derivatives by the base, from its value.
void fill_power(double value, double exponent, double base, int order, double* f) {
  f[0] = value;
  for (int m = 0; m < order; ++m) f[m + 1] = f[m] * (exponent - m) / base;
}

/// s^k log(s) / 2. Source: d^m/ds^m (s^k log s) = s^(k-m) (a log s + b), where one more derivative
/// makes b = (k - m) b + a, then a = (k - m) a.
void fill_thin_plate(double s, int k, int order, double* f) {
  const double logarithm = std::log(s);
  double a = 0.5;
  double b = 0;
  double power = std::pow(s, k);
  for (int m = 0; m <= order; ++m) {
    f[m] = power * (a * logarithm + b);
    b = (k - m) * b + a;
    a *= k - m;
    power /= s;
  }
}

Form form_of(const Options& options) {
  return options.choice<Form>("kernel", {{"mq", Form::multiquadric},
                                         {"imq", Form::inverse_multiquadric},
                                         {"gauss", Form::gauss},
                                         {"tps", Form::thin_plate}});
}

}  // namespace

RadialFunction::RadialFunction(const Options& options)
    : form_(form_of(options)), power_(options.integer("power", 2, 8)) {
  if (power_ % 2 != 0) {
    throw UsageError(
        fmt::format("{}={} must be even: r^power log r", options.where("power"), power_));
  }
}

void RadialFunction::evaluate(double s, double c, int order, double* f) const {
  if (s == 0 && !has_shape()) {
    for (int m = 0; m <= order; ++m) f[m] = 0;
    return;
  }
  switch (form_) {
    case Form::gauss:
      f[0] = std::exp(-s / (c * c));
      for (int m = 0; m < order; ++m) f[m + 1] = -f[m] / (c * c);
      return;
    case Form::multiquadric:
      return fill_power(std::sqrt(s + c * c), 0.5, s + c * c, order, f);
    case Form::inverse_multiquadric:
      return fill_power(1 / std::sqrt(s + c * c), -0.5, s + c * c, order, f);
    case Form::thin_plate:
      return fill_thin_plate(s, power_ / 2, order, f);
    case Form::odd_power: {
      double value = std::sqrt(s);
      for (int q = 1; q < power_; q += 2) value *= s;
      return fill_power(value, 0.5 * power_, s, order, f);
    }
  }
}

std::string RadialFunction::unsupported(int order, const std::string& derivative) const {
  if (order <= smoothness()) return {};
  if (has_shape()) {
    return fmt::format("derivatives of order above {} are not offered, {} is of order {}",
                       highest_order, derivative, order);
  }
  return fmt::format("r^{}{} has no derivative {} at r = 0; ask for a larger {}", power_,
                     form_ == Form::thin_plate ? " log r" : "", derivative,
                     form_ == Form::thin_plate ? "power" : "odd phs");
}

std::vector<OptionDoc> RadialFunction::options(const std::string& default_kernel) {
  return {{"kernel", default_kernel, "radial function: mq, imq, gauss or tps"},
          {"power", "4", "tps: even power in r^power log r, 2 to 8; above the derivatives' order"}};
}

}  // namespace strongpoint
