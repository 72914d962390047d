#pragma once

#include <Eigen/Core>

namespace strongpoint {

/// What stops an iteration in Krylov spaces.
struct KrylovLimits {
  double tolerance = 1e-9;  ///< on |b - A x| / |b|, 2-norms
  int iterations = 1000;    ///< at most
  int restarts = 1;         ///< after breakdowns
};

/// How an iteration ended.
enum class KrylovOutcome { converged, iterations_exhausted, breakdown };

/// How an iteration went.
struct KrylovReport {
  KrylovOutcome outcome;
  int iterations;
  double residual;  ///< |b - A x| / |b| of the solution given, 2-norms
};

/// Runs an iteration until the residual r = b - A x, computed anew from the solution, is small
/// enough: where a recursion has drifted from it or has broken down the iteration starts again from
/// there. `matrix.multiply(x, y)` gives y = A x; `run(wanted, iterations)` improves x from its
/// residual in `r` until |r| should be at most `wanted`, counts, and says whether it broke down.
template <class Matrix, class Run>
KrylovReport restarted(const Matrix& matrix, const Eigen::VectorXd& b, const KrylovLimits& limits,
                       Eigen::VectorXd& r, Eigen::VectorXd& x, const Run& run) {
  const double size = b.norm();
  if (size == 0) x.setZero();
  int iterations = 0;
  int breakdowns = 0;
  while (true) {
    matrix.multiply(x, r);
    r = b - r;
    const double residual = size > 0 ? r.norm() / size : 0;
    const auto report = [&](KrylovOutcome outcome) {
      return KrylovReport{outcome, iterations, residual};
    };
    if (residual <= limits.tolerance) return report(KrylovOutcome::converged);
    if (breakdowns > limits.restarts) return report(KrylovOutcome::breakdown);
    if (iterations >= limits.iterations) return report(KrylovOutcome::iterations_exhausted);
    if (run(limits.tolerance * size, iterations)) ++breakdowns;
  }
}

}  // namespace strongpoint
