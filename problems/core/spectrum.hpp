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

/// Condition of the eigenvectors in the 2-norm, 1 or more, infinite when they are linearly
/// dependent: from rest, a motion without growth never exceeds its first displacements by a larger
/// factor, and a change of K by E moves no eigenvalue farther than this factor times |E|.
/// O(size^3). Throws SkipCase when the pairs are not all pairs of K. Source: Bauer and Fike 1960.
double eigenvector_condition(const EigenPairs& pairs);

/// Largest |K u - lambda u| / (|lambda| |u|) of the pairs; 0 / 0 counts as 0. Products: two a pair.
double eigen_residual(const Motion& motion, const EigenPairs& pairs);

/// How fast the fastest growing vibration of u'' = K u grows: max Re sqrt(lambda), 1 over time;
/// `fastest_growth` says the same with damping, `find_growth` without eigenvalues.
double growth_rate(const Eigen::VectorXcd& eigenvalues);

/// Largest |eigenvalue| of K to about three digits, from products alone. Throws CaseError when the
/// iteration does not converge. Source: Arnoldi iteration with restarts, in Spectra.
double spectral_radius(const Motion& motion);

/// The `count` eigenvalues nearest to 0 with their eigenvectors, nearest first, to about ten
/// digits; one factorisation. A pair of complex ones may be cut in two at the end. Throws CaseError
/// when the iteration does not converge or the factorisation fails, UsageError when `count` is not
/// from 1 to the size. Source: Arnoldi iteration on the inverse of K but for a shift by 1e-10 of
/// its spectral radius, in Spectra.
EigenPairs lowest_modes(const Motion& motion, int count);

/// The `count` largest eigenvalues in magnitude with their eigenvectors, largest first, to about
/// ten digits, from products alone. Throws as `lowest_modes`.
EigenPairs largest_modes(const Motion& motion, int count);

}  // namespace strongpoint
