#pragma once

#include <string>

#include <fmt/format.h>

#include "methods/core/local_stencil.hpp"
#include "methods/core/smoothing_kernel.hpp"

namespace strongpoint {

/// A smoothing kernel with its smoothing length, the same multiple of the local spacing everywhere:
/// what sph, cspm, msph, mls and rkpm share.
template <int Dim>
class StencilKernel {
 public:
  /// Reads the options `kernel` and `h`. Throws UsageError.
  explicit StencilKernel(const Options& options)
      : kernel_(options.text("kernel"), Dim), factor_(options.number("h", 0.5, 20)) {}
  /// The same with a support of so many local spacings when the option `h` was left out.
  StencilKernel(const Options& options, double default_support)
      : kernel_(options.text("kernel"), Dim),
        factor_(options.has("h") ? options.number("h", 0.5, 20)
                                 : default_support / kernel_.support()) {}

  /// Nodes that a stencil holds at least, as many as that of a lean Taylor fit of order 2.
  static constexpr int least_nodes = Dim == 1 ? 3 : Dim == 2 ? 9 : 20;

  const SmoothingKernel& kernel() const { return kernel_; }
  /// Smoothing length in units of the stencil radius. It stretches where the stencil reaches beyond
  /// the support, so that no node is without a say.
  double length(const LocalStencil<Dim>& stencil) const {
    const double nominal = factor_ * stencil.spacing;
    return nominal * kernel_.support() * (1 + tolerance) >= 1 ? nominal
                                                              : stretched / kernel_.support();
  }
  /// The same as numbers for kernels that treat several stencils at a time.
  SmoothingProfile profile() const {
    SmoothingProfile profile = kernel_.profile();
    profile.factor = factor_;
    profile.enough = kernel_.support() * (1 + tolerance);
    profile.stretched = stretched / kernel_.support();
    return profile;
  }
  /// The stencil rule that gives all nodes within the support.
  std::string default_stencil() const {
    return fmt::format("radius[factor={:.6g}]", factor_ * kernel_.support());
  }

 private:
  static constexpr double tolerance = 1e-5;  // of the rule's factor, printed with six digits
  static constexpr double stretched = 1.1;   // as of the weights on residuals
  SmoothingKernel kernel_;
  double factor_;
};

}  // namespace strongpoint
