#include "studies/support/resume.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include <fmt/format.h>

#include "studies/support/csv.hpp"

namespace strongpoint {
namespace {

std::string read_text(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return {};
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file || !std::filesystem::is_regular_file(path)) {
    throw UsageError(
        fmt::format("--resume {}: cannot be read; name a CSV file of this study", path));
  }
  return text;
}

std::vector<std::string> names_of(const std::vector<Column>& columns) {
  std::vector<std::string> names;
  names.reserve(columns.size());
  for (const Column& column : columns) names.push_back(column.name);
  return names;
}

std::vector<std::string> missing_from(const std::vector<std::string>& names,
                                      const std::vector<std::string>& all) {
  std::vector<std::string> missing;
  for (const std::string& name : all) {
    if (std::find(names.begin(), names.end(), name) == names.end()) missing.push_back(name);
  }
  return missing;
}

void check_header(const std::string& path, const std::vector<std::string>& header,
                  const std::vector<std::string>& expected) {
  if (header == expected) return;
  std::string what;
  for (const auto& [word, names] : {std::pair{"missing", missing_from(header, expected)},
                                    std::pair{"unexpected", missing_from(expected, header)}}) {
    if (!names.empty()) what += fmt::format("{} {}; ", word, fmt::join(names, ","));
  }
  if (what.empty()) what = "wrong order or repeated; ";
  throw UsageError(
      one_line(fmt::format("--resume {}: the columns are not those of this study: {}expected {}",
                           path, what, fmt::join(expected, ","))));
}

/// Rows with a value that the planned case does not give: they come of other options of the study.
int foreign_rows(const std::vector<Row>& rows, const PlannedCase& planned) {
  return static_cast<int>(std::count_if(rows.begin(), rows.end(), [&](const Row& row) {
    const std::vector<std::string>& known = planned.quantities;
    return row.value && std::find(known.begin(), known.end(), row.quantity) == known.end();
  }));
}

bool is_complete(const std::vector<Row>& rows, const PlannedCase& planned) {
  std::vector<std::string> missing = planned.quantities;
  for (const Row& row : rows) {
    if (row.status == Status::failed) return false;
    const auto found = std::find(missing.begin(), missing.end(), row.quantity);
    if (found != missing.end()) missing.erase(found);
  }
  return missing.empty();
}

}  // namespace

Resumed read_resumed(const std::string& path, const std::vector<PlannedCase>& plan,
                     const Study& study, int threads, const std::string& version,
                     const Options& extra) {
  Resumed resumed;
  resumed.cases.resize(plan.size());
  const CsvText text = parse_csv(read_text(path));
  const std::vector<std::string> expected = names_of(columns_of(study));
  if (text.records.empty()) {
    // Not even the header line was finished; anything but a torn header is somebody else's file.
    if (!csv_line(expected).starts_with(text.torn)) check_header(path, {text.torn}, expected);
    return resumed;
  }
  check_header(path, text.records.front(), expected);
  std::map<std::string, std::size_t> place;
  for (std::size_t i = 0; i < plan.size(); ++i) place[identity_of(plan[i].key)] = i;
  for (std::size_t r = 1; r < text.records.size(); ++r) {
    const std::string where = fmt::format("--resume {}: record {}", path, r + 1);
    if (text.records[r].size() != expected.size()) {
      throw UsageError(fmt::format("{} has {} fields; the header names {}; mend or delete the line",
                                   where, text.records[r].size(), expected.size()));
    }
    try {
      const Row row = row_from_fields(text.records[r], study);
      const auto found = place.find(identity_of(row.key));
      const bool fits = row.study == study.name && row.version == version &&
                        (!study.timed || row.threads == threads) &&
                        (!study.keeps || study.keeps(row.key, row.extra, extra));
      if (fits && found != place.end()) {
        resumed.cases[found->second].push_back(row);
      } else {
        ++resumed.left_out;
      }
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("{}: {}", where, error.what()));
    }
  }
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (is_complete(resumed.cases[i], plan[i])) continue;
    resumed.left_out += foreign_rows(resumed.cases[i], plan[i]);
    resumed.cases[i].clear();
  }
  return resumed;
}

}  // namespace strongpoint
