#pragma once

#include "problems/core/motion.hpp"

namespace strongpoint {

/// All eigenvalues of K, (size), by dense algebra: O(size^3).
Eigen::VectorXcd dense_eigenvalues(const Motion& motion);

/// How fast the fastest growing vibration of u'' = K u grows: max Re sqrt(lambda), 1 over time.
double growth_rate(const Eigen::VectorXcd& eigenvalues);

/// Largest |eigenvalue| of K to about three digits, from products alone. Throws CaseError when the
/// iteration does not converge. Source: Arnoldi iteration with restarts, in Spectra.
double spectral_radius(const Motion& motion);

}  // namespace strongpoint
