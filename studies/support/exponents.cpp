#include "studies/support/exponents.hpp"

#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace strongpoint {
namespace {

/// Sums of a straight line through (log nodes, log value).
struct LineSums {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;

  void add(double nodes, double value) {
    const double a = std::log(nodes), b = std::log(value);
    n += 1, x += a, y += b, xx += a * a, xy += a * b;
  }
  /// The slope, as text; empty where the points leave it open, up to round-off.
  std::string slope() const {
    const double determinant = n * xx - x * x;
    if (n < 2 || determinant <= 1e-12 * n * xx) return "";
    return fmt::format("{:.3f}", (n * xy - x * y) / determinant);
  }
};

/// The choice that a row belongs to, in words, and its quantity.
using Name = std::pair<std::string, std::string>;

Name name_of(const Row& row) {
  const CaseKey& key = row.key;
  return {fmt::format("{}, {}, {}, {}, {}, {}", key.problem, key.method, key.stencil, key.cloud,
                      key.form, key.solver),
          row.quantity};
}

bool has_value(const Row& row) {
  return row.status == Status::ok && row.value && *row.value > 0 && row.nodes && *row.nodes > 0;
}

}  // namespace

void fit_exponents(std::vector<std::vector<Row>>& cases, std::size_t column) {
  std::map<Name, LineSums> lines;
  for (const std::vector<Row>& rows : cases) {
    for (const Row& row : rows) {
      if (has_value(row)) lines[name_of(row)].add(static_cast<double>(*row.nodes), *row.value);
    }
  }
  for (std::vector<Row>& rows : cases) {
    for (Row& row : rows) row.extra[column] = has_value(row) ? lines[name_of(row)].slope() : "";
  }
}

std::string exponents_text(const std::vector<std::vector<Row>>& cases) {
  std::vector<std::string> choices;
  std::map<std::string, std::vector<const Row*>> last;  // of each quantity, in their order
  for (const std::vector<Row>& rows : cases) {
    if (rows.empty()) continue;
    const std::string choice = name_of(rows.front()).first;
    if (!last.contains(choice)) choices.push_back(choice);
    last[choice].clear();
    for (const Row& row : rows) {
      if (has_value(row)) last[choice].push_back(&row);
    }
  }
  std::string text =
      "\nper node on the finest level (us, bytes), and the exponent p of value ~ N^p\n";
  for (const std::string& choice : choices) {
    text += choice + '\n';
    for (const Row* row : last[choice]) {
      text += fmt::format("  {:<12}{:>10}{:>9}\n", row->quantity, row->extra[0], row->extra[1]);
    }
  }
  return text;
}

}  // namespace strongpoint
