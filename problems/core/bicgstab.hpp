#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Core>

namespace strongpoint {

/// BiCGSTAB with right preconditioning, whose residual is that of the system itself. Source: van
/// der Vorst 1992, in the form of Saad 2003, section 9.3. Deviations: the residual is computed anew
/// from the solution before it counts as converged, and where the recursion has drifted from it or
/// has broken down the iteration restarts from there.
class Bicgstab {
 public:
  /// What stops the iteration.
  struct Parameters {
    double tolerance = 1e-9;  ///< on |b - A x| / |b|, 2-norms
    int iterations = 1000;    ///< at most; each multiplies by A and preconditions twice
    int restarts = 1;         ///< after breakdowns
  };
  /// How it went.
  enum class Outcome { converged, iterations_exhausted, breakdown };
  struct Report {
    Outcome outcome;
    int iterations;
    double residual;  ///< |b - A x| / |b| of the solution given, 2-norms
  };

  /// Allocates the vectors for systems of `unknowns`.
  Bicgstab(Eigen::Index unknowns, const Parameters& parameters)
      : parameters_(parameters),
        r_(unknowns),
        shadow_(unknowns),
        p_(unknowns),
        v_(unknowns),
        t_(unknowns),
        preconditioned_(unknowns) {}

  /// Improves `x` until it solves A x = b. `matrix.multiply(x, y)` gives y = A x and
  /// `preconditioner.apply(r, z)` an approximation z of A^-1 r.
  template <class Matrix, class Preconditioner>
  Report solve(const Matrix& matrix, const Preconditioner& preconditioner, const Eigen::VectorXd& b,
               Eigen::VectorXd& x);

 private:
  /// Why a run from one start ended.
  enum class End { small_residual, limit, breakdown };

  Parameters parameters_;
  int iteration_ = 0;
  Eigen::VectorXd r_, shadow_, p_, v_, t_, preconditioned_;

  /// Iterates from `x`, whose residual is r, until the recursion's residual is at most `wanted`.
  template <class Matrix, class Preconditioner>
  End run(const Matrix& matrix, const Preconditioner& preconditioner, double wanted,
          Eigen::VectorXd& x);

  /// True when an inner product is but round-off of vectors of these norms, or not a number.
  static bool is_lost(double product, double norms) {
    return !(std::abs(product) > std::numeric_limits<double>::epsilon() * norms);
  }
};

template <class Matrix, class Preconditioner>
Bicgstab::Report Bicgstab::solve(const Matrix& matrix, const Preconditioner& preconditioner,
                                 const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  const double size = b.norm();
  if (size == 0) x.setZero();
  iteration_ = 0;
  int breakdowns = 0;
  while (true) {
    matrix.multiply(x, r_);
    r_ = b - r_;
    const double residual = size > 0 ? r_.norm() / size : 0;
    const auto report = [&](Outcome outcome) { return Report{outcome, iteration_, residual}; };
    if (residual <= parameters_.tolerance) return report(Outcome::converged);
    if (breakdowns > parameters_.restarts) return report(Outcome::breakdown);
    if (iteration_ >= parameters_.iterations) return report(Outcome::iterations_exhausted);
    const End end = run(matrix, preconditioner, parameters_.tolerance * size, x);
    if (end == End::breakdown) ++breakdowns;
  }
}

template <class Matrix, class Preconditioner>
Bicgstab::End Bicgstab::run(const Matrix& matrix, const Preconditioner& preconditioner,
                            double wanted, Eigen::VectorXd& x) {
  shadow_ = r_;
  p_.setZero();
  v_.setZero();
  const double shadow_size = shadow_.norm();
  double rho = 1;
  double alpha = 1;
  double omega = 1;
  while (iteration_ < parameters_.iterations) {
    const double previous = rho;
    rho = shadow_.dot(r_);
    if (is_lost(rho, shadow_size * r_.norm())) return End::breakdown;
    p_ = r_ + (rho / previous) * (alpha / omega) * (p_ - omega * v_);
    preconditioner.apply(p_, preconditioned_);
    matrix.multiply(preconditioned_, v_);
    const double projection = shadow_.dot(v_);
    if (is_lost(projection, shadow_size * v_.norm())) return End::breakdown;
    ++iteration_;
    alpha = rho / projection;
    x += alpha * preconditioned_;
    r_ -= alpha * v_;
    if (r_.norm() <= wanted) return End::small_residual;
    preconditioner.apply(r_, preconditioned_);
    matrix.multiply(preconditioned_, t_);
    const double along = t_.dot(r_);
    if (is_lost(along, t_.norm() * r_.norm())) return End::breakdown;
    omega = along / t_.squaredNorm();
    x += omega * preconditioned_;
    r_ -= omega * t_;
    if (r_.norm() <= wanted) return End::small_residual;
  }
  return End::limit;
}

}  // namespace strongpoint
