#pragma once

#include "problems/core/motion.hpp"

namespace strongpoint {

/// All eigenvalues of K, (size), by dense algebra on one thread: O(size^3), complex ones in pairs.
/// Throws CaseError when K is not finite or the QR algorithm does not converge. Source: LAPACK's
/// dgeev.
Eigen::VectorXcd dense_eigenvalues(const Motion& motion);

/// Eigenvalues with their right eigenvectors.
struct EigenPairs {
  Eigen::VectorXcd values;   ///< (count)
  Eigen::MatrixXcd vectors;  ///< (size, count), columns of norm 1
};

/// As `dense_eigenvalues`, with the eigenvectors: about half as much again.
EigenPairs dense_eigenpairs(const Motion& motion);

/// How fast the fastest growing vibration of u'' = K u grows: max Re sqrt(lambda), 1 over time.
double growth_rate(const Eigen::VectorXcd& eigenvalues);

/// Largest |eigenvalue| of K to about three digits, from products alone. Throws CaseError when the
/// iteration does not converge. Source: Arnoldi iteration with restarts, in Spectra.
double spectral_radius(const Motion& motion);

}  // namespace strongpoint
