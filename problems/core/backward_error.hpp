#pragma once

#include <Eigen/Core>

#include "problems/core/field_units.hpp"

namespace strongpoint {

/// Judges solutions of a system by how little its numbers would have to change for them to be
/// exact: each row by what its own entries make of the largest values of the fields. What rows are
/// multiplied by and the units of fields make no difference. Source: Oettli and Prager 1964;
/// Arioli, Demmel and Duff 1989.
class BackwardError {
 public:
  /// Both must outlive this.
  BackwardError(const LinearSystem& system, const FieldUnits& units)
      : system_(system), units_(units) {}

  /// Fills r = b - A x. Gives the largest over the rows of |r| / (|b| + s), s the sum over the
  /// units of |A| times the largest value in them; 0 / 0 is no error, what is not finite an
  /// infinite one.
  double of(const Eigen::VectorXd& x, Eigen::VectorXd& residual) const;
  /// The same of x, or of its fields in one unit alone, as a solution other than zero of A x = 0,
  /// when it solves A x = b: by how little A would have to change to be singular, or more.
  double of_null_vector(const Eigen::VectorXd& x) const;
  /// The largest over the units of |A^T r| / (|A^T| |r|) in the columns of their fields, maximum
  /// norms: how far a residual is from a least one.
  double of_gradient(const Eigen::VectorXd& residual) const;

 private:
  const LinearSystem& system_;
  const FieldUnits& units_;
};

}  // namespace strongpoint
