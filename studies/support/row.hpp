#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/support/study.hpp"

namespace strongpoint {

/// How a number came out: computed, not offered, or not computable.
enum class Status { ok, skipped, failed };

/// The word for a status in a table.
std::string_view name_of(Status status);

/// One line of a table: a number of a case with all that is needed to understand it.
struct Row {
  std::string study;
  CaseKey key;
  std::optional<std::int64_t> nodes, unknowns;
  std::optional<double> spacing;
  std::string quantity;
  std::optional<double> value, rate;
  Status status = Status::ok;
  std::string reason;
  std::optional<int> threads;
  std::optional<StageTimes> times;
  std::vector<std::string> extra;  ///< one text per extra column of the study
  std::string version;             ///< of the code that computed the number
};

/// A column of the table.
struct Column {
  std::string name;
  enum class Kind { text, number } kind;
};

/// The columns of a study's table, in order.
std::vector<Column> columns_of(const Study& study);

/// The texts of a row, one per column; numbers in the shortest form that reads back to the same
/// bits.
std::vector<std::string> fields_of(const Row& row, const Study& study);

/// The row whose texts are `fields`. Throws UsageError naming the column and the text when a number
/// or a status cannot be read.
Row row_from_fields(const std::vector<std::string>& fields, const Study& study);

/// A text without line ends.
std::string one_line(std::string_view text);

/// What all rows of a case have in common.
struct RowFrame {
  const Study& study;
  CaseKey key;
  int threads;
  std::string version;
};

/// A row per quantity of a case that ran. A number that is not finite, a missing number without a
/// reason, and an expected quantity that was not given are failures.
std::vector<Row> rows_of_result(const RowFrame& frame, const std::vector<std::string>& expected,
                                const CaseResult& result);

/// A row without value per expected quantity.
std::vector<Row> rows_without_value(const RowFrame& frame, const std::vector<std::string>& expected,
                                    Status status, std::string_view reason);

/// Fills `rate` in the rows of case `index` from the nearest earlier case that differs in level
/// only and has the number, but for quantities that are `unrated`. `cases` are in case order.
void fill_rates(std::vector<std::vector<Row>>& cases, std::size_t index,
                const std::vector<std::string>& unrated = {});

}  // namespace strongpoint
