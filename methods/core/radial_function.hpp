#pragma once

#include <string>
#include <vector>

#include "methods/core/options.hpp"

namespace strongpoint {

/// A radial function phi(r) as f(s) of the squared distance s = r^2, with derivatives by s in
/// closed form. `gauss` exp(-s/c^2) (thesis 1.27), `mq` and `imq` (s + c^2)^(+-1/2) ((1.28) with n
/// = 2 and n = 1), `tps` r^power log r with an even power ((1.29), where r log r stands for r^2 log
/// r), and odd powers of r (polyharmonic splines). c is the shape parameter, a length.
class RadialFunction {
 public:
  /// The families offered.
  enum class Form { gauss, multiquadric, inverse_multiquadric, thin_plate, odd_power };

  /// Highest order of a derivative that is offered of functions that are smooth everywhere.
  static constexpr int highest_order = 8;

  /// `power` is even with `thin_plate`, odd with `odd_power`, and not used otherwise.
  explicit RadialFunction(Form form, int power = 0) : form_(form), power_(power) {}
  /// Reads the options `kernel` and `power`. Throws UsageError.
  explicit RadialFunction(const Options& options);

  /// True when the function depends on a shape parameter.
  bool has_shape() const { return form_ != Form::thin_plate && form_ != Form::odd_power; }
  /// Highest order of a derivative that exists everywhere, r = 0 included.
  int smoothness() const { return has_shape() ? highest_order : power_ - 1; }
  /// Fills f[m] = f^(m)(s), m = 0 to `order`. Those that are infinite at s = 0 are given as zero
  /// there: up to `smoothness()` a derivative only takes them times a vanishing power of r.
  void evaluate(double s, double c, int order, double* f) const;
  /// Why a derivative of this order cannot be given, in a sentence; empty when it can.
  std::string unsupported(int order, const std::string& derivative) const;

  /// The options `kernel`, with its default, and `power`.
  static std::vector<OptionDoc> options(const std::string& default_kernel);

 private:
  Form form_;
  int power_;
};

}  // namespace strongpoint
