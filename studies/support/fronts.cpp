#include "studies/support/fronts.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace strongpoint {
namespace {

using RowTable = std::vector<std::vector<Row>>;

/// True when a row can be compared: an error and the time that it took.
bool takes_part(const Row& row) { return row.status == Status::ok && row.value && row.times; }

/// Calls `work(row)` for all rows that take part.
template <class Table, class Work>
void for_each_row(Table& cases, const Work& work) {
  for (auto& rows : cases) {
    for (auto& row : rows) {
      if (takes_part(row)) work(row);
    }
  }
}

/// The choice that a row belongs to: its case, whatever the level.
CaseKey choice_of(const Row& row) {
  CaseKey key = row.key;
  key.level = 0;
  return key;
}

/// Keeps the smaller of two times.
void keep_least(std::optional<double>& least, double seconds) {
  if (!least || seconds < *least) least = seconds;
}

void add_row(const Row& row, ReachTable& table) {
  const CaseKey key = choice_of(row);
  auto place = std::find_if(table.choices.begin(), table.choices.end(),
                            [&](const ReachTimes& times) { return times.key == key; });
  if (place == table.choices.end()) {
    std::vector<std::optional<double>> none(reach_tolerances().size());
    place = table.choices.insert(place, {key, std::move(none)});
  }
  for (std::size_t i = 0; i < reach_tolerances().size(); ++i) {
    if (std::abs(*row.value) > reach_tolerances()[i]) break;
    keep_least(place->seconds[i], row.times->total());
  }
}

/// Those that reach the tightest tolerance come first, the fastest of them at the top.
bool is_better(const ReachTimes& a, const ReachTimes& b) {
  for (std::size_t i = reach_tolerances().size(); i-- > 0;) {
    if (a.seconds[i].has_value() != b.seconds[i].has_value()) return a.seconds[i].has_value();
    if (a.seconds[i] && *a.seconds[i] != *b.seconds[i]) return *a.seconds[i] < *b.seconds[i];
  }
  return false;
}

std::string line_of(const std::string& label, const std::vector<std::optional<double>>& seconds) {
  std::string line = fmt::format("  {:<10}", label);
  for (const std::optional<double>& time : seconds) {
    line += time ? fmt::format("{:>9.2g}", *time) : fmt::format("{:>9}", "-");
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + '\n';
}

std::string text_of(const ReachTable& table) {
  std::string title = fmt::format("time [s] to reach {} of {}", table.quantity, table.problem);
  std::string text = "\n" + title + '\n' + std::string(title.size(), '-') + '\n';
  std::string head = fmt::format("  {:<10}", "at most");
  for (double tolerance : reach_tolerances()) head += fmt::format("{:>9.0e}", tolerance);
  text += head + '\n';
  std::vector<std::optional<double>> least(reach_tolerances().size());
  for (const ReachTimes& choice : table.choices) {
    for (std::size_t i = 0; i < least.size(); ++i) {
      if (choice.seconds[i]) keep_least(least[i], *choice.seconds[i]);
    }
  }
  text += line_of("best", least);
  for (const ReachTimes& choice : table.choices) {
    const CaseKey& key = choice.key;
    text += fmt::format("{}, {}, {}, {}, {}\n", key.method, key.stencil, key.cloud, key.form,
                        key.solver);
    text += line_of("", choice.seconds);
  }
  return text;
}

}  // namespace

void mark_fronts(RowTable& cases) {
  std::map<std::pair<std::string, std::string>, std::vector<Row*>> groups;
  for_each_row(cases, [&](Row& row) {
    row.extra.front().clear();
    groups[{row.key.problem, row.quantity}].push_back(&row);
  });
  for (auto& [name, rows] : groups) {
    std::sort(rows.begin(), rows.end(), [](const Row* a, const Row* b) {
      return std::pair(a->times->total(), std::abs(*a->value)) <
             std::pair(b->times->total(), std::abs(*b->value));
    });
    std::optional<double> least;
    for (Row* row : rows) {
      const double error = std::abs(*row->value);
      if (least && error >= *least) continue;
      least = error;
      row->extra.front() = "front";
    }
  }
}

const std::vector<double>& reach_tolerances() {
  static const std::vector<double> tolerances{1e-2, 1e-3, 1e-4, 1e-5, 1e-6,
                                              1e-7, 1e-8, 1e-9, 1e-10};
  return tolerances;
}

std::vector<ReachTable> reach_tables(const RowTable& cases) {
  std::vector<ReachTable> tables;
  for_each_row(cases, [&](const Row& row) {
    auto place = std::find_if(tables.begin(), tables.end(), [&](const ReachTable& table) {
      return table.problem == row.key.problem && table.quantity == row.quantity;
    });
    if (place == tables.end()) {
      place = tables.insert(tables.end(), {row.key.problem, row.quantity, {}});
    }
    add_row(row, *place);
  });
  for (ReachTable& table : tables) {
    std::erase_if(table.choices,
                  [](const ReachTimes& choice) { return !choice.seconds.front().has_value(); });
    std::stable_sort(table.choices.begin(), table.choices.end(), is_better);
  }
  return tables;
}

std::string reach_text(const RowTable& cases) {
  std::string text;
  for (const ReachTable& table : reach_tables(cases)) text += text_of(table);
  return text;
}

}  // namespace strongpoint
