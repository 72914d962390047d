#include "studies/support/row.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace strongpoint {
namespace {

constexpr double StageTimes::*stage_members[] = {
    &StageTimes::cloud,   &StageTimes::prepare,  &StageTimes::neighbours, &StageTimes::stencils,
    &StageTimes::weights, &StageTimes::assemble, &StageTimes::solve};

template <class T>
std::string text_of(const std::optional<T>& value) {
  return value ? fmt::format("{}", *value) : std::string();
}

/// Reads the fields of one row from left to right.
class FieldReader {
 public:
  FieldReader(const std::vector<std::string>& fields, const std::vector<Column>& columns)
      : fields_(fields), columns_(columns) {}

  const std::string& text() { return fields_[next_++]; }

  template <class T>
  std::optional<T> number() {
    const std::string& field = fields_[next_++];
    if (field.empty()) return std::nullopt;
    T value{};
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size()) reject("a number");
    return value;
  }

  Status status() {
    const std::string& field = fields_[next_++];
    for (Status status : {Status::ok, Status::skipped, Status::failed}) {
      if (field == name_of(status)) return status;
    }
    reject("ok, skipped or failed");
  }

 private:
  const std::vector<std::string>& fields_;
  const std::vector<Column>& columns_;
  std::size_t next_ = 0;

  [[noreturn]] void reject(std::string_view allowed) const {
    throw UsageError(fmt::format("column {} holds '{}'; it must be {}", columns_[next_ - 1].name,
                                 fields_[next_ - 1], allowed));
  }
};

Row empty_row(const RowFrame& frame, const std::string& quantity) {
  Row row;
  row.study = frame.study.name;
  row.key = frame.key;
  row.quantity = quantity;
  if (frame.study.timed) row.threads = frame.threads;
  row.extra.resize(frame.study.extra_columns.size());
  row.version = frame.version;
  return row;
}

/// The value judged: only finite numbers, and explained gaps, may pass as ok.
void set_value(Row& row, const Quantity& quantity) {
  row.reason = one_line(quantity.reason);
  if (quantity.value && std::isfinite(*quantity.value)) {
    row.value = quantity.value;
  } else if (quantity.value) {
    row.status = Status::failed;
    row.reason = fmt::format("the value is {}, not a finite number{}{}", *quantity.value,
                             row.reason.empty() ? "" : ": ", row.reason);
  } else if (row.reason.empty()) {
    row.status = Status::failed;
    row.reason = "the study gave neither a value nor a reason";
  }
}

bool same_axes(CaseKey a, const CaseKey& b) {
  a.level = b.level;
  return a == b;
}

/// The row with the same quantity, counting repeated names (a quantity may come once per variant).
const Row* counterpart(const std::vector<Row>& rows, const std::string& quantity, int occurrence) {
  for (const Row& row : rows) {
    if (row.quantity == quantity && occurrence-- == 0) return &row;
  }
  return nullptr;
}

std::optional<double> rate_between(const Row& coarse, const Row& fine) {
  if (coarse.status != Status::ok || !coarse.value || !coarse.spacing) return std::nullopt;
  const double rate =
      std::log(*coarse.value / *fine.value) / std::log(*coarse.spacing / *fine.spacing);
  return std::isfinite(rate) ? std::optional(rate) : std::nullopt;
}

}  // namespace

std::string_view name_of(Status status) {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::skipped:
      return "skipped";
    case Status::failed:
      break;
  }
  return "failed";
}

std::vector<Column> columns_of(const Study& study) {
  using enum Column::Kind;
  std::vector<Column> columns = {
      {"study", text},   {"problem", text},    {"method", text},    {"stencil", text},
      {"cloud", text},   {"form", text},       {"solver", text},    {"level", number},
      {"nodes", number}, {"unknowns", number}, {"spacing", number}, {"quantity", text},
      {"value", number}, {"rate", number},     {"status", text},    {"reason", text}};
  if (study.timed) {
    for (const char* name :
         {"threads", "t_cloud", "t_prepare", "t_neighbours", "t_stencils", "t_weights",
          "t_assemble", "t_solve", "t_total", "peak_mb", "residual"}) {
      columns.push_back({name, number});
    }
  }
  for (const std::string& name : study.extra_columns) columns.push_back({name, text});
  columns.push_back({"version", text});
  return columns;
}

std::vector<std::string> fields_of(const Row& row, const Study& study) {
  const CaseKey& key = row.key;
  std::vector<std::string> fields = {row.study,
                                     key.problem,
                                     key.method,
                                     key.stencil,
                                     key.cloud,
                                     key.form,
                                     key.solver,
                                     fmt::format("{}", key.level),
                                     text_of(row.nodes),
                                     text_of(row.unknowns),
                                     text_of(row.spacing),
                                     row.quantity,
                                     text_of(row.value),
                                     text_of(row.rate),
                                     std::string(name_of(row.status)),
                                     row.reason};
  if (study.timed) {
    fields.push_back(text_of(row.threads));
    for (const auto member : stage_members) {
      fields.push_back(row.times ? fmt::format("{}", (*row.times).*member) : "");
    }
    fields.push_back(row.times ? fmt::format("{}", row.times->total()) : "");
    fields.push_back(row.times ? fmt::format("{}", row.times->peak_mb) : "");
    fields.push_back(row.times ? fmt::format("{}", row.times->residual) : "");
  }
  fields.insert(fields.end(), row.extra.begin(), row.extra.end());
  fields.push_back(row.version);
  return fields;
}

Row row_from_fields(const std::vector<std::string>& fields, const Study& study) {
  const std::vector<Column> columns = columns_of(study);
  FieldReader read(fields, columns);
  Row row;
  row.study = read.text();
  for (std::string CaseKey::*axis : {&CaseKey::problem, &CaseKey::method, &CaseKey::stencil,
                                     &CaseKey::cloud, &CaseKey::form, &CaseKey::solver}) {
    row.key.*axis = read.text();
  }
  row.key.level = read.number<int>().value_or(0);
  row.nodes = read.number<std::int64_t>();
  row.unknowns = read.number<std::int64_t>();
  row.spacing = read.number<double>();
  row.quantity = read.text();
  row.value = read.number<double>();
  row.rate = read.number<double>();
  row.status = read.status();
  row.reason = read.text();
  if (study.timed) {
    row.threads = read.number<int>();
    StageTimes times;
    for (const auto member : stage_members) times.*member = read.number<double>().value_or(0);
    // The total is the sum of the stages; it also tells whether the case was timed at all.
    const bool has_times = read.number<double>().has_value();
    times.peak_mb = read.number<double>().value_or(0);
    times.residual = read.number<double>().value_or(0);
    if (has_times) row.times = times;
  }
  for (std::size_t i = 0; i < study.extra_columns.size(); ++i) row.extra.push_back(read.text());
  row.version = read.text();
  return row;
}

std::string one_line(std::string_view text) {
  std::string line(text);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

std::vector<Row> rows_of_result(const RowFrame& frame, const std::vector<std::string>& expected,
                                const CaseResult& result) {
  std::vector<std::string> missing = expected;
  std::vector<Row> rows;
  for (const Quantity& quantity : result.quantities) {
    Row row = empty_row(frame, quantity.name);
    set_value(row, quantity);
    std::copy_n(quantity.extra.begin(), std::min(quantity.extra.size(), row.extra.size()),
                row.extra.begin());
    const auto found = std::find(missing.begin(), missing.end(), quantity.name);
    if (found != missing.end()) missing.erase(found);
    rows.push_back(std::move(row));
  }
  const std::vector<Row> gaps =
      rows_without_value(frame, missing, Status::failed, "the study did not give this quantity");
  rows.insert(rows.end(), gaps.begin(), gaps.end());
  for (Row& row : rows) {
    row.nodes = result.nodes;
    row.unknowns = result.unknowns;
    row.spacing = result.spacing;
    if (frame.study.timed) row.times = result.times;
  }
  return rows;
}

std::vector<Row> rows_without_value(const RowFrame& frame, const std::vector<std::string>& expected,
                                    Status status, std::string_view reason) {
  std::vector<Row> rows;
  for (const std::string& quantity : expected) {
    Row row = empty_row(frame, quantity);
    row.status = status;
    row.reason = one_line(reason);
    rows.push_back(std::move(row));
  }
  return rows;
}

void fill_rates(std::vector<std::vector<Row>>& cases, std::size_t index,
                const std::vector<std::string>& unrated) {
  std::vector<Row>& rows = cases[index];
  for (std::size_t r = 0; r < rows.size(); ++r) {
    Row& row = rows[r];
    row.rate.reset();
    if (row.status != Status::ok || !row.value || !row.spacing) continue;
    if (std::find(unrated.begin(), unrated.end(), row.quantity) != unrated.end()) continue;
    const auto occurrence = static_cast<int>(
        std::count_if(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(r),
                      [&](const Row& other) { return other.quantity == row.quantity; }));
    for (std::size_t earlier = index; earlier-- > 0;) {
      if (cases[earlier].empty()) continue;
      if (!same_axes(cases[earlier].front().key, row.key)) break;
      const Row* previous = counterpart(cases[earlier], row.quantity, occurrence);
      if (previous == nullptr || previous->status != Status::ok || !previous->value) continue;
      row.rate = rate_between(*previous, row);
      break;
    }
  }
}

}  // namespace strongpoint
