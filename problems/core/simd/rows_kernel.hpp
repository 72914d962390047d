#pragma once

#include <cstdint>

#include "methods/core/simd/output.hpp"
#include "methods/core/simd/path.hpp"

namespace strongpoint {

/// Largest stencil that the kernel of rows takes.
inline constexpr int most_kernel_nodes = 64;

/// Largest number of fields that it takes.
inline constexpr int most_kernel_fields = 3;

/// Largest number of derivatives that it takes.
inline constexpr int most_kernel_derivatives = 32;

/// The rows of some points, `fields` each, all alike: every row reads every field, by the same
/// coefficients at each point.
struct RowsTask {
  const std::int64_t* weight_offsets;  ///< (all points + 1), as those of Weights
  const int* nodes;                    ///< (entries) columns of the weights, unknowns themselves
  const double* weights;               ///< (derivatives * entries)
  int derivatives;                     ///< values an entry
  int fields;                          ///< 1 to `most_kernel_fields`
  const double* coefficients;          ///< (derivatives, rows of a point, fields), fields innermost
  const int* points;  ///< (count), `point_step` apart, with 1 to `most_kernel_nodes` nodes
  int point_step;
  int count;
  const std::int64_t* offsets;  ///< (count * fields + 1) of the rows in what follows
  const double* row_weights;    ///< (count * fields) factors after scaling, or null
  std::int64_t* columns;        ///< written, or compared
  double* values;               ///< written
  double* scales;               ///< (count * fields) written; not positive for a bad row
  Output output;                ///< how columns and values are stored
  int* other_columns;           ///< null: columns are written; else they are compared, and the
                                ///< first row that has others is noted here
};

/// Sorts the nodes of each point, adds up the entries, scales each row to a largest entry of 1 and
/// writes it.
STRONGPOINT_SIMD_KERNEL(make_rows, RowsTask);

}  // namespace strongpoint
