#pragma once

#include <limits>

#include <Eigen/Core>

#include "methods/core/method.hpp"

namespace strongpoint {

/// What is known of a condition number.
struct ConditionBounds {
  double lower = 0;
  double upper = std::numeric_limits<double>::infinity();
};

/// Relative error of bounds that are not exact.
inline constexpr double bounds_error = 1e-6;

/// Condition number |A| |A^-1| of a square matrix, infinite when it is singular or not finite.
/// Exact: by singular values in the 2-norm, by the inverse in the 1-norm.
double condition_number(const Eigen::MatrixXd& matrix, ConditionNorm norm);

}  // namespace strongpoint
