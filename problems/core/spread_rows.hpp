#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "problems/core/column_set.hpp"
#include "problems/core/row_sources.hpp"

namespace strongpoint {

/// Makes rows whose terms lie at several points, such as balances of fluxes through faces. Points
/// in turn with one stencil are added up over its nodes first, and columns are kept while the rows
/// that follow read the same points.
class SpreadRowMaker {
 public:
  explicit SpreadRowMaker(const RowSources& sources) : sources_(sources) {}

  /// Number of entries of a row. Throws as `make` does.
  std::int64_t count(int row);
  /// Makes the entries of a row, which `columns` and `values` hold until the next one. Throws
  /// CaseError for a derivative read at a point without weights.
  void make(int row);

  std::span<const std::int64_t> columns() const { return columns_; }  ///< ascending
  std::span<const double> values() const { return values_; }

 private:
  /// What a row reads of some points in turn with one stencil, or of a bare value.
  struct Group {
    int first;             ///< point
    std::uint64_t fields;  ///< that occur, a bit each
    bool is_value;         ///< the bare value of a node's field, without a stencil

    bool operator==(const Group&) const = default;
  };
  /// A term's place in a row: which group and point it belongs to.
  struct Reading {
    int point;
    std::size_t group;
    std::size_t begin, end;  ///< of its terms
  };

  RowSources sources_;
  std::vector<Group> groups_, known_groups_;  ///< of this row, of that which `columns_` belong to
  std::vector<Reading> readings_;
  std::int64_t known_count_ = -1;  ///< entries of rows with the known groups
  bool has_columns_ = false;       ///< `columns_` are those of the known groups
  ColumnSet set_;
  std::vector<double> coefficients_;  ///< (fields, derivatives) of one point
  std::vector<double> group_sums_;    ///< (stencil size, fields)
  std::vector<double> sums_;          ///< (unknowns) at the columns; zero before and after
  ColumnSet nodes_;                   ///< of rows of whole nodes, as what follows
  std::vector<int> seen_;             ///< (nodes) the stamp they were counted with
  int stamp_ = 0;                     ///< of the last row counted
  std::vector<int> place_;            ///< (nodes) among the row's; of others, anything
  std::vector<int> places_;           ///< of the nodes of all groups in turn
  std::vector<std::int64_t> columns_;
  std::vector<double> values_;

  bool has_same_stencil(int a, int b) const;
  void read(int row);
  std::int64_t insert_columns();
  bool has_whole_nodes() const;
  std::int64_t count_nodes();
  void list_nodes();
  void add_nodes(const Term* terms);
  void add_group(std::size_t group, std::span<const Reading> readings, const Term* terms);
};

}  // namespace strongpoint
