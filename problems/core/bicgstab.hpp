#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Core>

#include "problems/core/krylov.hpp"

namespace strongpoint {

/// BiCGSTAB with right preconditioning, whose residual is that of the system itself. Source: van
/// der Vorst 1992, in the form of Saad 2003, section 9.3. Deviation: restarted as `restarted` does.
class Bicgstab {
 public:
  using Parameters = KrylovLimits;
  using Outcome = KrylovOutcome;
  using Report = KrylovReport;

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
  iteration_ = 0;
  return restarted(matrix, b, parameters_, r_, x, [&](double wanted, int& iterations) {
    iteration_ = iterations;
    const End end = run(matrix, preconditioner, wanted, x);
    iterations = iteration_;
    return end == End::breakdown;
  });
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
