#pragma once

#include <optional>
#include <string>

#include "problems/core/spectrum.hpp"

namespace strongpoint {

/// A number, or none, and what is to be said of it.
struct Figure {
  std::optional<double> value;
  std::string reason;
};

/// What the spectrum of an operator K says of u'' = K u.
struct SpectrumFigures {
  EigenPairs modes;  ///< ascending in |eigenvalue|: all, or the lowest
  bool complete = false;
  EigenPairs fastest;  ///< the fastest growing one, or none
  double radius = 0;   ///< largest |eigenvalue|
  Figure largest_real, largest_imaginary, growth_rate, non_normality, residual;
};

/// From all eigenvalues.
SpectrumFigures dense_figures(const Motion& motion);

/// From the `count` lowest eigenvalues, the largest and the fastest growing; what cannot be known
/// so has no value.
SpectrumFigures sparse_figures(const Motion& motion, int count);

}  // namespace strongpoint
