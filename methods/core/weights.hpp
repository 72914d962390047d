#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "methods/core/large_array.hpp"

namespace strongpoint {

/// Derivative weights of all evaluation points: one CSR pattern (points x nodes), `per_entry`
/// values an entry, one for each derivative asked for, in their order.
struct Weights {
  int per_entry = 0;                     ///< m, derivatives per entry
  std::vector<std::int64_t> offsets{0};  ///< (points + 1)
  LargeArray<int> columns;               ///< (entries) node ids, in stencil order
  LargeArray<double> values;             ///< (m * entries), the m values of an entry side by side

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

/// The rows of two sets of weights for the same points and derivatives, where a row is empty in one
/// of them at least.
inline Weights joined_rows(const Weights& a, const Weights& b) {
  Weights all;
  all.per_entry = a.per_entry;
  all.offsets.reserve(a.offsets.size());
  all.columns.reserve(a.columns.size() + b.columns.size());
  all.values.reserve(a.values.size() + b.values.size());
  for (int p = 0; p < a.size(); ++p) {
    const Weights& part = a.nodes(p).empty() ? b : a;
    const std::span<const int> nodes = part.nodes(p);
    const double* values = part.row(p).data();
    all.columns.insert(all.columns.end(), nodes.begin(), nodes.end());
    all.values.insert(all.values.end(), values, values + part.row(p).size());
    all.offsets.push_back(static_cast<std::int64_t>(all.columns.size()));
  }
  return all;
}

}  // namespace strongpoint
