#include "problems/core/backward_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "problems/core/solver_entry.hpp"

namespace strongpoint {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double quotient(double part, double whole) {
  if (part == 0) return 0;
  const double value = part / whole;
  return std::isfinite(value) ? value : infinity;
}

}  // namespace

double BackwardError::of(const Eigen::VectorXd& x, Eigen::VectorXd& residual) const {
  residual.resize(system_.rows());
  const Eigen::VectorXd sizes = units_.sizes(x);
  const double* const values = system_.values.data();
  const std::int64_t* const columns = system_.columns.data();
  double largest = 0;
#pragma omp parallel for schedule(static) reduction(max : largest)
  for (std::int64_t row = 0; row < system_.rows(); ++row) {
    const double b = system_.right_hand_side[row];
    double product = 0;
    for (std::int64_t i = system_.offsets[row]; i < system_.offsets[row + 1]; ++i) {
      product += values[i] * x[columns[i]];
    }
    residual[row] = b - product;
    const double whole = std::abs(b) + units_.sums().col(row).dot(sizes);
    largest = std::max(largest, quotient(std::abs(residual[row]), whole));
  }
  return largest;
}

double BackwardError::of_null_vector(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd sizes = units_.sizes(x);
  const int units = units_.count();
  double whole = sizes.isZero(0) ? infinity : 0;
  Eigen::VectorXd alone = (sizes.array() > 0).select(Eigen::VectorXd::Zero(units), infinity);
  for (std::int64_t row = 0; row < system_.rows(); ++row) {
    const double b = std::abs(system_.right_hand_side[row]);
    const double sum = units_.sums().col(row).dot(sizes);
    whole = std::max(whole, quotient(b, sum));
    for (int unit = 0; unit < units && units > 1; ++unit) {
      const double part = units_.sums()(unit, row) * sizes[unit];
      if (part > 0) alone[unit] = std::max(alone[unit], quotient(b + (sum - part), part));
    }
  }
  return units > 1 ? std::min(whole, alone.minCoeff()) : whole;
}

double BackwardError::of_gradient(const Eigen::VectorXd& residual) const {
  const Eigen::VectorXd gradient = view_of(system_).transpose() * residual;
  Eigen::VectorXd columns = Eigen::VectorXd::Zero(system_.unknowns());
  for (std::size_t i = 0; i < system_.values.size(); ++i) {
    columns[system_.columns[i]] += std::abs(system_.values[i]);
  }
  const Eigen::VectorXd parts = units_.sizes(gradient);
  const Eigen::VectorXd wholes =
      units_.sizes(columns) * residual.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  double largest = 0;
  for (int unit = 0; unit < units_.count(); ++unit) {
    largest = std::max(largest, quotient(parts[unit], wholes[unit]));
  }
  return largest;
}

}  // namespace strongpoint
