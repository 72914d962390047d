#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "methods/core/options.hpp"
#include "methods/core/simd/smoothing_profile.hpp"

namespace strongpoint {

/// Derivatives of kernels up to this order are offered at most: as many as of a Taylor fit.
inline constexpr int most_smoothness = 8;

/// A radial kernel W(r) = f(r/h) of compact support, h being the smoothing length, normalised so
/// that its integral over the space is h^Dim. Offered: `gauss` exp(-q^2) cut at 2.6 h,
/// `cubic_spline` (B-spline), `quartic_spline` 1 - 6t^2 + 8t^3 - 3t^4 and `wendland` (quintic, C2)
/// (1-t)^4 (1+4t) with t = q/2. Source: Monaghan & Lattanzio 1985 (cubic), Belytschko et al. 1996
/// (quartic), Wendland 1995.
class SmoothingKernel {
 public:
  /// Throws UsageError for an unknown name. `dimension` fixes the normalisation.
  SmoothingKernel(std::string_view name, int dimension);

  /// Radius of the support over the smoothing length.
  double support() const { return pieces_.back().end; }
  /// Highest order of a derivative that is continuous everywhere, the edge of a Gauss bell's
  /// support apart.
  int smoothness() const { return smoothness_; }
  /// Fills f[m] = d^m W / ds^m, m = 0 to `order`, at s = (r/h)^2; zero outside the support. At s =
  /// 0 derivatives that only multiply powers of r may be infinite (see RadialDerivative).
  void evaluate(double s, int order, double* f) const;
  /// The same for kernels that treat several stencils at a time; lengths are left to others.
  SmoothingProfile profile() const;

  /// The option by which a method's spec names a kernel, and the one for its smoothing length.
  static OptionDoc kernel_option(std::string default_name);
  static OptionDoc length_option(std::string default_length);

 private:
  /// sum_k coefficients[k] q^k up to q = end; without coefficients exp(-q^2).
  struct Piece {
    double end;
    std::vector<double> coefficients;
  };
  std::vector<Piece> pieces_;
  int smoothness_ = 2;
  double normalisation_ = 1;
};

}  // namespace strongpoint
