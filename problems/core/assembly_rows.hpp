#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "problems/core/row_sources.hpp"
#include "problems/core/spread_rows.hpp"

namespace strongpoint {

/// The terms of an equation at one point, added up: for each field that occurs, the derivatives and
/// what they are multiplied by.
struct RowRecipe {
  struct Part {
    int derivative;
    double coefficient;
  };
  std::vector<std::vector<Part>> parts;  ///< (fields that occur), derivatives ascending
  std::vector<int> fields;               ///< ascending
};

/// Positions of some different numbers in ascending order. `ids` has room for a multiple of 16
/// numbers and is overwritten beyond `count`; `order` has as much.
void sort_positions(int count, int* ids, int* order);

/// Makes rows, one after the other, with buffers of its own: one for each thread.
class RowMaker {
 public:
  explicit RowMaker(const RowSources& sources)
      : sources_(sources), spread_(sources), recipes_(sources.fields) {}

  /// Number of entries of a row. Throws as `make` does.
  std::int64_t count(int row);
  /// Makes the entries of a row, which `columns` and `values` hold until the next one. Rows at one
  /// point should follow each other: its nodes are sorted once. Throws CaseError for a derivative
  /// read at a point without weights.
  void make(int row);

  /// Ascending.
  std::span<const std::int64_t> columns() const {
    return is_spread_ ? spread_.columns() : std::span<const std::int64_t>(columns_);
  }
  std::span<const double> values() const {
    return is_spread_ ? spread_.values() : std::span<const double>(values_);
  }

 private:
  /// The recipe of a row in turn, kept while the rows are alike.
  struct Known {
    std::int64_t first = -1;
    RowRecipe recipe;
  };

  RowSources sources_;
  SpreadRowMaker spread_;
  bool is_spread_ = false;             ///< `spread_` holds the row
  std::vector<Known> recipes_;         ///< (fields)
  std::vector<double> coefficients_;   ///< (fields x derivatives)
  int sorted_point_ = -1;              ///< whose nodes `order_` sorts
  std::vector<int> ids_, order_;       ///< of the nodes of a point
  std::vector<std::int64_t> entries_;  ///< where the weights of the sorted nodes begin
  std::vector<int> column_fields_;     ///< with which `columns_` were made at the sorted point
  bool has_stencil_columns_ = false;   ///< false after a row that is no stencil
  std::vector<std::int64_t> columns_;
  std::vector<double> values_;
  int judged_point_ = -1;  ///< the point that `is_plain_` belongs to
  bool is_plain_ = true;   ///< its nodes are unknowns, all different

  bool has_plain_nodes(int point);
  bool is_compact(int row);
  const RowRecipe& recipe_of(int row);
  void sort_nodes(int point);
  void fill_compact(int row);
  void fill_value(const Term& term);
};

}  // namespace strongpoint
