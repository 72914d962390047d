#include "problems/core/field_units.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/QR>

namespace strongpoint {
namespace {

/// The unit of each field: the components of a vector share one, every scalar has its own.
std::vector<std::uint16_t> units_of_fields(const LinearSystem& system) {
  std::vector<std::uint16_t> units(system.fields);
  std::uint16_t count = 0;
  std::optional<std::uint16_t> of_vector;
  for (int field = 0; field < system.fields; ++field) {
    const bool is_component = !system.field_axis.empty() && system.field_axis[field] >= 0;
    if (is_component && !of_vector) of_vector = count++;
    units[field] = is_component ? *of_vector : count++;
  }
  return units;
}

}  // namespace

FieldUnits::FieldUnits(const LinearSystem& system) {
  const std::vector<std::uint16_t> of_fields = units_of_fields(system);
  const int units = *std::max_element(of_fields.begin(), of_fields.end()) + 1;
  if (units > 1) {
    of_unknowns_.resize(system.unknowns());
    for (std::size_t i = 0; i < of_unknowns_.size(); ++i) {
      of_unknowns_[i] = of_fields[i % of_fields.size()];
    }
  }
  sums_.setZero(units, system.rows());
#pragma omp parallel for schedule(static)
  for (std::int64_t row = 0; row < system.rows(); ++row) {
    double* const sums = &sums_(0, row);
    const std::int64_t end = system.offsets[row + 1];
    if (units == 1) {
      const Eigen::Map<const Eigen::ArrayXd> values(system.values.data() + system.offsets[row],
                                                    end - system.offsets[row]);
      *sums = values.abs().sum();
      continue;
    }
    for (std::int64_t i = system.offsets[row]; i < end; ++i) {
      sums[of_unknowns_[system.columns[i]]] += std::abs(system.values[i]);
    }
  }
}

Eigen::VectorXd FieldUnits::sizes(const Eigen::VectorXd& x) const {
  if (count() == 1) {
    return Eigen::VectorXd::Constant(1, x.cwiseAbs().maxCoeff<Eigen::PropagateNaN>());
  }
  Eigen::VectorXd sizes = Eigen::VectorXd::Zero(count());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    double& size = sizes[of_unknowns_[i]];
    if (!(std::abs(x[i]) <= size)) size = std::abs(x[i]);
  }
  return sizes;
}

Eigen::VectorXd FieldUnits::even_sizes() const {
  const int units = count();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(units, units);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(units);
  Eigen::VectorXd logs(units);
  for (Eigen::Index row = 0; row < sums_.cols() && units > 1; ++row) {
    const double* const sums = &sums_(0, row);
    int present = 0;
    double mean = 0;  // minus the logarithm of the row's factor
    for (int unit = 0; unit < units; ++unit) {
      if (!(sums[unit] > 0)) continue;
      logs[unit] = std::log2(sums[unit]);
      mean += logs[unit];
      ++present;
    }
    if (present < 2) continue;  // says nothing
    mean /= present;
    for (int unit = 0; unit < units; ++unit) {
      if (!(sums[unit] > 0)) continue;
      right[unit] -= logs[unit] - mean;
      normal(unit, unit) += 1;
      for (int other = 0; other < units; ++other) {
        if (sums[other] > 0) normal(unit, other) -= 1.0 / present;
      }
    }
  }
  Eigen::VectorXd sizes = normal.completeOrthogonalDecomposition().solve(right);
  if (!sizes.allFinite()) return Eigen::VectorXd::Ones(units);
  sizes.array() -= sizes[0];  // of what is alike
  return sizes.unaryExpr([](double power) { return std::exp2(std::round(power)); });
}

LinearSystem in_units(const LinearSystem& system, const FieldUnits& units,
                      const Eigen::VectorXd& sizes) {
  LinearSystem result = system;
  const bool is_square = system.rows() == system.unknowns();
#pragma omp parallel for schedule(static)
  for (std::int64_t row = 0; row < system.rows(); ++row) {
    double before = 0;
    double after = 0;
    for (std::int64_t i = system.offsets[row]; i < system.offsets[row + 1]; ++i) {
      double& value = result.values[i];
      before = std::max(before, std::abs(value));
      value *= sizes[units.of_unknowns()[system.columns[i]]];
      after = std::max(after, std::abs(value));
    }
    if (!is_square || !(after > 0)) continue;
    const double factor = before / after;
    for (std::int64_t i = system.offsets[row]; i < system.offsets[row + 1]; ++i) {
      result.values[i] *= factor;
    }
    result.right_hand_side[row] *= factor;
    if (!result.row_scales.empty()) result.row_scales[row] *= factor;
  }
  return result;
}

}  // namespace strongpoint
