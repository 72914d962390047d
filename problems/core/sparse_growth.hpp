#pragma once

#include <complex>
#include <cstdint>

#include "problems/core/motion.hpp"

namespace strongpoint {

/// The fastest growing vibration of u'' = K u, as far as products with K tell.
struct FoundGrowth {
  double rate = 0;                  ///< Re sqrt(lambda), 1 over time; 0 when none was found
  std::complex<double> eigenvalue;  ///< lambda, 1 over time squared; 0 when none was found
  Eigen::VectorXcd vector;          ///< u, (size), of norm 1; empty when none was found
  double residual = 0;              ///< |K u - lambda u| / (|lambda| |u|)
  double bound = 0;                 ///< growth up to this rate may be hidden, 1 over time
  std::int64_t products = 0;        ///< with K
};

/// Finds the fastest growing vibration of a motion with this spectral radius. Takes `budget`
/// products with K at most, and no fewer than 3000 where growth is slow or absent.
/// Source: Arnoldi iteration (Saad 2011, chapter 7) on blocks of m central-difference steps from
/// rest, which multiply by T_m(1 + dt^2 K / 2), a Chebyshev polynomial: 1 at most on vibrations
/// that do not grow, exp(rate m dt) / 2 on one that does. m doubles until the eigenvalue is
/// accurate enough for its rate.
FoundGrowth find_growth(const Motion& motion, double spectral_radius, std::int64_t budget);

}  // namespace strongpoint
