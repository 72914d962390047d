#include "methods/core/condition.hpp"

#include <limits>

#include <Eigen/Dense>

namespace strongpoint {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

double largest_column_sum(const Eigen::MatrixXd& matrix) {
  return matrix.cwiseAbs().colwise().sum().maxCoeff();
}

}  // namespace

double condition_number(const Eigen::MatrixXd& matrix, ConditionNorm norm) {
  if (matrix.size() == 0 || !matrix.allFinite()) return infinite;
  if (norm == ConditionNorm::two) {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix);
    const Eigen::VectorXd& values = svd.singularValues();
    const double smallest = values[values.size() - 1];
    return smallest > 0 ? values[0] / smallest : infinite;
  }
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(matrix);
  const double condition = largest_column_sum(matrix) * largest_column_sum(lu.inverse());
  return condition < infinite ? condition : infinite;  // NaN counts as infinite
}

}  // namespace strongpoint
