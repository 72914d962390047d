#include "studies/support/readable_table.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

namespace strongpoint {
namespace {

constexpr std::size_t line_width = 110;
constexpr std::size_t margin = 2;
constexpr std::size_t least_label_width = 22;
constexpr std::size_t cell_width = 16;
constexpr std::size_t slope_width = 6;  // leaves room for five levels beside the least label

/// The cases of one method and stencil on one problem, cloud, form and solver, by level.
using Block = std::vector<const std::vector<Row>*>;

std::string heading(const CaseKey& key) {
  return fmt::format("problem {}, cloud {}, form {}, solver {}", key.problem, key.cloud, key.form,
                     key.solver);
}

/// Breaks a text at blanks so that no line passes the right margin.
std::string wrapped(const std::string& text, const std::string& indent) {
  std::string result, line = indent;
  bool fresh = true;  // nothing but the indent stands on the line
  std::size_t start = 0;
  while (start < text.size()) {
    const std::size_t end = std::min(text.find(' ', start), text.size());
    const std::string word = text.substr(start, end - start);
    if (line.size() + word.size() + 1 > line_width && !fresh) {
      result += line + '\n';
      line = indent + "  ";
      fresh = true;
    }
    line += (fresh ? "" : " ") + word;
    fresh = false;
    start = end + 1;
  }
  return result + line + '\n';
}

/// Variants of a quantity (an algorithm, say) are told apart by the extra columns that the study
/// names, or else by those that hold words.
std::string label_of(const Row& row, const Study& study) {
  std::string label = row.quantity;
  const std::vector<std::string>& chosen = study.variant_columns;
  for (std::size_t i = 0; i < row.extra.size(); ++i) {
    const std::string& text = row.extra[i];
    const std::string& column = study.extra_columns[i];
    if (text.empty()) continue;
    const bool is_word = std::isalpha(static_cast<unsigned char>(text.front())) != 0;
    const bool is_chosen =
        chosen.empty() ? is_word : std::find(chosen.begin(), chosen.end(), column) != chosen.end();
    if (is_chosen) label += is_word ? " " + text : fmt::format(" {}={}", column, text);
  }
  return label;
}

/// A quantity over the levels: row[i] belongs to block[i] and may be missing.
struct Line {
  std::string label;
  std::vector<const Row*> rows;
};

std::vector<Line> lines_of(const Block& block, const Study& study) {
  std::vector<Line> lines;
  std::map<std::pair<std::string, int>, std::size_t> known;
  for (std::size_t level = 0; level < block.size(); ++level) {
    std::map<std::string, int> occurrences;
    for (const Row& row : *block[level]) {
      const auto id = std::pair{row.quantity, occurrences[row.quantity]++};
      const auto [place, added] = known.emplace(id, lines.size());
      if (added) lines.push_back({label_of(row, study), std::vector<const Row*>(block.size())});
      Line& line = lines[place->second];
      line.rows[level] = &row;
      if (row.value) line.label = label_of(row, study);
    }
  }
  return lines;
}

/// Least-squares slope of log value against log spacing, where there are two values at least.
std::optional<double> slope(const Line& line) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const Row* row : line.rows) {
    if (row == nullptr || row->status != Status::ok || !row->value || !row->spacing) continue;
    if (*row->value <= 0 || *row->spacing <= 0) continue;
    const double x = std::log(*row->spacing), y = std::log(*row->value);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double determinant = n * sxx - sx * sx;
  // One level, or several with the same spacing, leave the slope open; the bound is round-off.
  if (n < 2 || determinant <= 1e-12 * n * sxx) return std::nullopt;
  return (n * sxy - sx * sy) / determinant;
}

/// Whether the numbers of a line are errors that may converge.
bool has_rates(const Line& line, const Study& study) {
  const auto has_name = [&](const std::string& name) {
    return std::any_of(line.rows.begin(), line.rows.end(),
                       [&](const Row* row) { return row != nullptr && row->quantity == name; });
  };
  return study.rated && std::none_of(study.unrated.begin(), study.unrated.end(), has_name);
}

std::string cell(const Row* row) {
  if (row == nullptr) return "";
  if (row->status != Status::ok) return fmt::format("{:<6}", name_of(row->status));
  if (!row->value) return "-     ";
  return fmt::format("{:.3g} {:>5}", *row->value,
                     row->rate ? fmt::format("{:.2f}", *row->rate) : "");
}

/// The part of a block that stands side by side, behind labels of one width.
struct Span {
  std::size_t first, last, label_width;
};

template <class Text>
std::string table_line(const std::string& label, Span span, Text&& text_of_level) {
  std::string line = fmt::format("{:{}}{:<{}}", "", margin, label, span.label_width);
  for (std::size_t i = span.first; i < span.last; ++i) {
    line += fmt::format("{:>{}}", text_of_level(i), cell_width);
  }
  return line;
}

std::string ended(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line + '\n';
}

std::string head_lines(const Block& block, Span span, const Study& study) {
  const auto first_row = [&](std::size_t i) -> const Row& { return block[i]->front(); };
  const auto count = [](const std::optional<std::int64_t>& n) {
    return n ? fmt::format("{}      ", *n) : std::string("-      ");
  };
  std::string text = table_line("level", span, [&](std::size_t i) {
    return fmt::format("{} {:>5}", first_row(i).key.level, study.rated ? "rate" : "");
  });
  if (study.rated && span.last == block.size()) text += fmt::format("{:>{}}", "slope", slope_width);
  text = ended(text);
  text +=
      ended(table_line("nodes", span, [&](std::size_t i) { return count(first_row(i).nodes); }));
  return text + ended(table_line("unknowns", span,
                                 [&](std::size_t i) { return count(first_row(i).unknowns); }));
}

std::string time_lines(const Block& block, Span span) {
  constexpr std::pair<const char*, double StageTimes::*> stages[] = {
      {"t_cloud", &StageTimes::cloud},           {"t_prepare", &StageTimes::prepare},
      {"t_neighbours", &StageTimes::neighbours}, {"t_stencils", &StageTimes::stencils},
      {"t_weights", &StageTimes::weights},       {"t_assemble", &StageTimes::assemble},
      {"t_solve", &StageTimes::solve},           {"peak_mb", &StageTimes::peak_mb},
      {"residual", &StageTimes::residual}};
  std::string text;
  const auto line = [&](const char* name, auto&& number_of) {
    const std::string label = *name == 't' ? std::string(name) + " [s]" : std::string(name);
    text += ended(table_line(label, span, [&](std::size_t i) {
      const std::optional<StageTimes>& times = block[i]->front().times;
      return times ? fmt::format("{:.3g}      ", number_of(*times)) : std::string("-      ");
    }));
  };
  for (const auto& [name, member] : stages) {
    line(name, [m = member](const StageTimes& times) { return times.*m; });
    if (member == &StageTimes::solve) {
      line("t_total", [](const StageTimes& times) { return times.total(); });
    }
  }
  return text;
}

/// Why there is no number, each reason once with the levels it concerns.
std::string notes(const Block& block) {
  std::vector<std::pair<std::string, std::string>> reasons;
  for (const std::vector<Row>* rows : block) {
    std::string last;
    for (const Row& row : *rows) {
      if (row.reason.empty()) continue;
      const std::string what =
          row.status == Status::ok ? row.quantity : std::string(name_of(row.status));
      const std::string note = what + "|" + row.reason;
      if (note == last) continue;
      last = note;
      const auto same = [&](const auto& known) { return known.first == note; };
      auto place = std::find_if(reasons.begin(), reasons.end(), same);
      if (place == reasons.end()) place = reasons.insert(place, {note, ""});
      place->second += fmt::format("{}{}", place->second.empty() ? "" : ",", row.key.level);
    }
  }
  std::string text;
  for (const auto& [note, levels] : reasons) {
    const std::size_t bar = note.find('|');
    text += wrapped(
        fmt::format("{} (level {}): {}", note.substr(0, bar), levels, note.substr(bar + 1)), "  ");
  }
  return text;
}

std::string block_text(const Block& block, const Study& study) {
  const CaseKey& key = block.front()->front().key;
  std::string text = wrapped(fmt::format("{}, stencil {}", key.method, key.stencil), "");
  const bool any = std::any_of(block.begin(), block.end(), [](const std::vector<Row>* rows) {
    return std::any_of(rows->begin(), rows->end(),
                       [](const Row& row) { return row.status == Status::ok; });
  });
  const std::vector<Line> lines = any ? lines_of(block, study) : std::vector<Line>();
  std::size_t label_width = least_label_width;
  for (const Line& line : lines) label_width = std::max(label_width, line.label.size());
  const std::size_t room = line_width - (study.rated ? slope_width : 0);
  const std::size_t taken = std::min(margin + label_width, room - cell_width);
  const std::size_t abreast = (room - taken) / cell_width;
  for (std::size_t first = 0; any && first < block.size(); first += abreast) {
    const Span span{first, std::min(first + abreast, block.size()), label_width};
    text += head_lines(block, span, study);
    for (const Line& line : lines) {
      std::string row =
          table_line(line.label, span, [&](std::size_t i) { return cell(line.rows[i]); });
      const std::optional<double> fitted = has_rates(line, study) ? slope(line) : std::nullopt;
      if (fitted && span.last == block.size())
        row += fmt::format("{:>{}.2f}", *fitted, slope_width);
      text += ended(row);
    }
    if (study.timed) text += time_lines(block, span);
  }
  return text + notes(block) + '\n';
}

}  // namespace

std::string readable_table(const std::vector<std::vector<Row>>& cases, const Study& study) {
  std::vector<std::pair<std::string, std::vector<Block>>> groups;
  for (const std::vector<Row>& rows : cases) {
    if (rows.empty()) continue;
    const CaseKey& key = rows.front().key;
    const auto same_group = [&](const auto& group) { return group.first == heading(key); };
    auto group = std::find_if(groups.begin(), groups.end(), same_group);
    if (group == groups.end()) group = groups.insert(group, {heading(key), {}});
    const auto same_block = [&](const Block& block) {
      const CaseKey& other = block.front()->front().key;
      return other.method == key.method && other.stencil == key.stencil;
    };
    auto block = std::find_if(group->second.begin(), group->second.end(), same_block);
    if (block == group->second.end()) block = group->second.insert(block, Block{});
    block->push_back(&rows);
  }
  std::string text = wrapped(study.name + ": " + study.summary, "");
  for (const auto& [title, blocks] : groups) {
    const std::string line = wrapped(title, "");
    text += "\n" + line + std::string(std::min(line.size() - 1, line_width), '-') + "\n";
    for (const Block& block : blocks) text += block_text(block, study);
  }
  return text;
}

}  // namespace strongpoint
