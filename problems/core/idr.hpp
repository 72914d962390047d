#pragma once

#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Dense>

#include "problems/core/krylov.hpp"
#include "problems/core/random.hpp"

namespace strongpoint {

/// IDR(s) with right preconditioning, whose residual is that of the system itself. Source: van
/// Gijzen and Sonneveld 2011, the bi-orthogonal variant, with their lower bound 0.7 on the angle
/// that omega is made of. Deviation: restarted as `restarted` does.
class Idr {
 public:
  /// Allocates 3 s + 4 vectors for systems of `unknowns`; the shadow space is random and always the
  /// same.
  Idr(Eigen::Index unknowns, const KrylovLimits& limits, int s)
      : limits_(limits),
        s_(s),
        shadow_(unknowns, s),
        g_(unknowns, s),
        u_(unknowns, s),
        products_(s, s),
        f_(s),
        r_(unknowns),
        v_(unknowns),
        t_(unknowns) {
    std::mt19937_64 generator(1);
    for (double& entry : shadow_.reshaped()) entry = 2 * uniform01(generator) - 1;
    for (int i = 0; i < s; ++i) {
      for (int j = 0; j < i; ++j)
        shadow_.col(i) -= shadow_.col(j).dot(shadow_.col(i)) * shadow_.col(j);
      const double size = shadow_.col(i).norm();
      if (size > 0) shadow_.col(i) /= size;
    }
  }

  /// Improves `x` until it solves A x = b, with matrix and preconditioner as in `Bicgstab::solve`.
  /// An iteration is one product with A.
  template <class Matrix, class Preconditioner>
  KrylovReport solve(const Matrix& matrix, const Preconditioner& preconditioner,
                     const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    return restarted(matrix, b, limits_, r_, x, [&](double wanted, int& iterations) {
      return run(matrix, preconditioner, wanted, iterations, x);
    });
  }

 private:
  KrylovLimits limits_;
  int s_;
  Eigen::MatrixXd shadow_, g_, u_, products_;
  Eigen::VectorXd f_, r_, v_, t_;

  /// True when it broke down.
  template <class Matrix, class Preconditioner>
  bool run(const Matrix& matrix, const Preconditioner& preconditioner, double wanted,
           int& iterations, Eigen::VectorXd& x);

  /// Makes u_k and g_k = A u_k, g_k orthogonal to the first k shadow vectors; false when a pivot is
  /// lost.
  template <class Matrix, class Preconditioner>
  bool make_direction(const Matrix& matrix, const Preconditioner& preconditioner, int k,
                      double omega) {
    const int left = s_ - k;
    const Eigen::VectorXd c = products_.bottomRightCorner(left, left)
                                  .template triangularView<Eigen::Lower>()
                                  .solve(f_.tail(left));
    v_ = r_ - g_.rightCols(left) * c;
    preconditioner.apply(v_, t_);
    v_ = omega * t_ + u_.rightCols(left) * c;
    matrix.multiply(v_, t_);
    for (int i = 0; i < k; ++i) {
      const double alpha = shadow_.col(i).dot(t_) / products_(i, i);
      t_ -= alpha * g_.col(i);
      v_ -= alpha * u_.col(i);
    }
    u_.col(k) = v_;
    g_.col(k) = t_;
    for (int i = k; i < s_; ++i) products_(i, k) = shadow_.col(i).dot(t_);
    return !is_lost(products_(k, k), t_.norm());
  }

  /// True when an inner product is but round-off of vectors of these norms, or not a number.
  static bool is_lost(double product, double norms) {
    return !(std::abs(product) > std::numeric_limits<double>::epsilon() * norms);
  }

  /// The step along t = A M^-1 r; zero when t says nothing.
  double step_length() const {
    constexpr double least_angle = 0.7;
    const double size = t_.norm();
    const double along = t_.dot(r_);
    if (!(size > 0)) return 0;
    const double angle = std::abs(along) / (size * r_.norm());
    const double omega = along / (size * size);
    return angle < least_angle && angle > 0 ? omega * least_angle / angle : omega;
  }
};

template <class Matrix, class Preconditioner>
bool Idr::run(const Matrix& matrix, const Preconditioner& preconditioner, double wanted,
              int& iterations, Eigen::VectorXd& x) {
  g_.setZero();
  u_.setZero();
  products_.setIdentity();
  double omega = 1;
  while (iterations < limits_.iterations) {
    f_ = shadow_.transpose() * r_;
    for (int k = 0; k < s_; ++k) {
      if (!make_direction(matrix, preconditioner, k, omega)) return true;
      ++iterations;
      const double beta = f_[k] / products_(k, k);
      r_ -= beta * g_.col(k);
      x += beta * u_.col(k);
      if (r_.norm() <= wanted || iterations >= limits_.iterations) return false;
      f_.tail(s_ - k - 1) -= beta * products_.col(k).tail(s_ - k - 1);
    }
    preconditioner.apply(r_, v_);
    matrix.multiply(v_, t_);
    ++iterations;
    omega = step_length();
    if (omega == 0 || !std::isfinite(omega)) return true;
    r_ -= omega * t_;
    x += omega * v_;
    if (r_.norm() <= wanted) return false;
  }
  return false;
}

}  // namespace strongpoint
