#pragma once

#include <Eigen/Core>

#include "methods/core/method.hpp"

namespace strongpoint {

/// Condition number |A| |A^-1| of a square matrix, infinite when it is singular or not finite.
/// Exact: by singular values in the 2-norm, by the inverse in the 1-norm.
double condition_number(const Eigen::MatrixXd& matrix, ConditionNorm norm);

}  // namespace strongpoint
