#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "problems/core/krylov.hpp"

namespace strongpoint {

/// Restarted GMRES with right preconditioning, whose residual is that of the system itself. Source:
/// Saad 2003, algorithm 9.5, modified Gram-Schmidt and Givens rotations. Deviation: restarted as
/// `restarted` does.
class Gmres {
 public:
  /// Allocates `restart` + 1 vectors for systems of `unknowns`.
  Gmres(Eigen::Index unknowns, const KrylovLimits& limits, int restart)
      : limits_(limits),
        restart_(restart),
        basis_(unknowns, restart + 1),
        hessenberg_(restart + 1, restart),
        right_(restart + 1),
        cosines_(restart),
        sines_(restart),
        r_(unknowns),
        w_(unknowns),
        z_(unknowns) {}

  /// Improves `x` until it solves A x = b, with matrix and preconditioner as in `Bicgstab::solve`.
  template <class Matrix, class Preconditioner>
  KrylovReport solve(const Matrix& matrix, const Preconditioner& preconditioner,
                     const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    return restarted(matrix, b, limits_, r_, x, [&](double wanted, int& iterations) {
      return run(matrix, preconditioner, wanted, iterations, x);
    });
  }

 private:
  KrylovLimits limits_;
  int restart_;
  Eigen::MatrixXd basis_, hessenberg_;
  Eigen::VectorXd right_, cosines_, sines_, r_, w_, z_;

  /// One cycle; true when it broke down before it improved anything.
  template <class Matrix, class Preconditioner>
  bool run(const Matrix& matrix, const Preconditioner& preconditioner, double wanted,
           int& iterations, Eigen::VectorXd& x);

  /// Orthogonalises w against the basis and appends it; false when nothing is left.
  bool extend(int step) {
    const double before = w_.norm();
    for (int i = 0; i <= step; ++i) {
      hessenberg_(i, step) = basis_.col(i).dot(w_);
      w_ -= hessenberg_(i, step) * basis_.col(i);
    }
    const double left = w_.norm();
    hessenberg_(step + 1, step) = left;
    if (!(left > std::numeric_limits<double>::epsilon() * before)) return false;
    basis_.col(step + 1) = w_ / left;
    return true;
  }
  /// Rotates the new column to a triangle.
  void rotate(int step) {
    for (int i = 0; i < step; ++i) turn(hessenberg_(i, step), hessenberg_(i + 1, step), i);
    double& top = hessenberg_(step, step);
    double& bottom = hessenberg_(step + 1, step);
    const double size = std::hypot(top, bottom);
    cosines_[step] = size > 0 ? top / size : 1;
    sines_[step] = size > 0 ? bottom / size : 0;
    turn(top, bottom, step);
    turn(right_[step], right_[step + 1], step);
  }
  void turn(double& a, double& b, int i) const {
    const double before = a;
    a = cosines_[i] * before + sines_[i] * b;
    b = cosines_[i] * b - sines_[i] * before;
  }
};

template <class Matrix, class Preconditioner>
bool Gmres::run(const Matrix& matrix, const Preconditioner& preconditioner, double wanted,
                int& iterations, Eigen::VectorXd& x) {
  const double size = r_.norm();
  basis_.col(0) = r_ / size;
  right_.setZero();
  right_[0] = size;
  int steps = 0;
  bool is_extended = true;
  while (is_extended && steps < restart_ && iterations < limits_.iterations &&
         std::abs(right_[steps]) > wanted) {
    w_ = basis_.col(steps);
    preconditioner.apply(w_, z_);
    matrix.multiply(z_, w_);
    if (!w_.allFinite()) break;
    is_extended = extend(steps);
    rotate(steps);
    ++steps;
    ++iterations;
  }
  // A column without a pivot, of a singular matrix, adds nothing.
  while (steps > 0 && hessenberg_(steps - 1, steps - 1) == 0) --steps;
  if (steps == 0) return true;
  const Eigen::VectorXd y = hessenberg_.topLeftCorner(steps, steps)
                                .template triangularView<Eigen::Upper>()
                                .solve(right_.head(steps));
  w_.noalias() = basis_.leftCols(steps) * y;
  preconditioner.apply(w_, z_);
  x += z_;
  return !(std::abs(right_[steps]) < size);
}

}  // namespace strongpoint
