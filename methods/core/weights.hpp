#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace strongpoint {

/// Derivative weights of all evaluation points: one CSR pattern (points x nodes), `per_entry`
/// values an entry, one for each derivative asked for, in their order.
struct Weights {
  int per_entry = 0;                     ///< m, derivatives per entry
  std::vector<std::int64_t> offsets{0};  ///< (points + 1)
  std::vector<int> columns;              ///< (entries) node ids, in stencil order
  std::vector<double> values;            ///< (m * entries), the m values of an entry side by side

  int size() const { return static_cast<int>(offsets.size()) - 1; }
  /// Node ids of one point's row; empty where no derivative was wanted.
  std::span<const int> nodes(int point) const {
    return {columns.data() + offsets[point], columns.data() + offsets[point + 1]};
  }
  /// Weights of one point, (m, stencil size).
  Eigen::Map<const Eigen::MatrixXd> row(int point) const {
    return {values.data() + offsets[point] * per_entry, per_entry,
            static_cast<Eigen::Index>(offsets[point + 1] - offsets[point])};
  }
  /// The same, to be written.
  Eigen::Map<Eigen::MatrixXd> row(int point) {
    return {values.data() + offsets[point] * per_entry, per_entry,
            static_cast<Eigen::Index>(offsets[point + 1] - offsets[point])};
  }
};

}  // namespace strongpoint
