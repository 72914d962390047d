#pragma once

#include <array>
#include <span>
#include <vector>

#include "problems/core/assembly_rows.hpp"
#include "problems/core/simd/rows_kernel.hpp"

namespace strongpoint {

/// Finds the rows that the kernel of rows can make: those of points in a row with the same
/// coefficients, one row a field, that read derivatives of all fields at their point.
class RowRuns {
 public:
  explicit RowRuns(const RowSources& sources) : sources_(sources) {}

  /// Looks for such rows from `row` on, before `end`; returns the number of points they belong to,
  /// 0 when the next row is none. The point of each is that of its first row's place.
  int find(int row, int end);

  /// (derivatives, rows of a point, fields)
  const std::vector<double>& coefficients() const { return coefficients_; }

 private:
  RowSources sources_;
  std::array<std::int64_t, most_kernel_fields> known_{-1, -1, -1};  ///< terms of `coefficients_`
  bool is_usable_ = false;  ///< all fields occur in each row, and no bare values
  std::vector<double> coefficients_;

  void learn(int row);
  template <int Fields>
  int count_alike(int row, int end) const;
  template <int Fields>
  bool is_alike(const EquationPlace* places) const;
  bool are_unknowns(std::span<const int> nodes) const;
};

}  // namespace strongpoint
