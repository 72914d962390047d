#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/ranges.h>

#include "problems/core/layout.hpp"
#include "problems/core/mesh_file.hpp"

namespace strongpoint {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::string_view blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// The cells of a text between separators, trimmed; the last may be empty.
std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> cells;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(separator, start), text.size());
    cells.push_back(trimmed(text.substr(start, end - start)));
    start = end + 1;
  }
  return cells;
}

/// One line of a CSV file with what is needed to complain about it.
struct CsvLine {
  int number;  ///< counted from 1, the header included
  std::vector<std::string_view> cells;
  const std::vector<std::string>& columns;

  [[noreturn]] void fail(int column, const std::string& what) const {
    throw CaseError(
        fmt::format("line {}, column {} ({}): {}", number, column + 1, columns[column], what));
  }
  /// The finite number in a column.
  double finite(int column) const {
    std::string_view text = cells[column];
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
      fail(column, fmt::format("'{}' is not a number; write one such as 0.25", cells[column]));
    }
    if (!std::isfinite(value)) {
      fail(column, fmt::format("'{}' is not finite; give a finite number", cells[column]));
    }
    return value;
  }
};

/// Column names of a cloud file of a dimension, normals included.
template <int Dim>
std::vector<std::string> column_names() {
  std::vector<std::string> names;
  names.reserve(2 * Dim + 1);
  for (int c = 0; c < Dim; ++c) names.emplace_back(1, "xyz"[c]);
  names.emplace_back("tag");
  for (int c = 0; c < Dim; ++c) names.push_back(fmt::format("n{}", "xyz"[c]));
  return names;
}

/// The columns of a file from its first line: positions and tag, with or without normals.
template <int Dim>
std::vector<std::string> read_header(std::string_view line) {
  const std::vector<std::string> all = column_names<Dim>();
  const std::vector<std::string> plain(all.begin(), all.begin() + Dim + 1);
  if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);  // a byte order mark
  const std::vector<std::string_view> cells = split(line, ',');
  std::vector<std::string> found(cells.begin(), cells.end());
  if (found == all || found == plain) return found;
  std::size_t wrong = 0;
  while (wrong < found.size() && wrong < all.size() && found[wrong] == all[wrong]) ++wrong;
  throw CaseError(
      fmt::format("line 1, column {}: {}; the header of a {}D cloud must be {} or {}", wrong + 1,
                  wrong < found.size() ? fmt::format("'{}' is not expected here", found[wrong])
                                       : fmt::format("'{}' is missing", all[wrong]),
                  Dim, fmt::join(plain, ","), fmt::join(all, ",")));
}

/// Sides named in the tag column: nothing, `interior` or 0 inside; names or 1-based numbers
/// joined by '+' on the boundary.
std::vector<int> read_tag(const CsvLine& line, int column, const std::vector<std::string>& sides) {
  const std::string_view tag = line.cells[column];
  if (tag.empty() || tag == "interior" || tag == "0") return {};
  std::vector<int> found;
  for (std::string_view part : split(tag, '+')) {
    const auto by_name = std::find(sides.begin(), sides.end(), part);
    int side = static_cast<int>(by_name - sides.begin());
    if (by_name == sides.end()) {
      int number = 0;
      const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
      const bool is_number = error == std::errc() && end == part.data() + part.size();
      if (!is_number || number < 1 || number > static_cast<int>(sides.size())) {
        line.fail(column,
                  fmt::format("'{}' is not a side; known: {}, their numbers 1 to {}, joined "
                              "by '+' at corners, or interior",
                              part, fmt::join(sides, ", "), sides.size()));
      }
      side = number - 1;
    }
    found.push_back(side);
  }
  return found;
}

/// Marks of a node: the file's normal where there is one side and a normal, else the domain's.
template <int Dim>
std::vector<BoundaryMark<Dim>> read_marks(const CsvLine& line, const Domain<Dim>& domain,
                                          const Point<Dim>& x) {
  const std::vector<int> sides = read_tag(line, Dim, domain.sides());
  constexpr int first = Dim + 1;
  const auto is_empty = [](std::string_view cell) { return cell.empty(); };
  const bool has_normal = line.cells.size() > first &&
                          !std::all_of(line.cells.begin() + first, line.cells.end(), is_empty);
  if (sides.size() != 1 || !has_normal) return domain.marks(sides, x);
  Point<Dim> normal;
  for (int c = 0; c < Dim; ++c) normal[c] = line.finite(first + c);
  if (!(normal.norm() > 0)) {
    line.fail(first, "the normal has length zero; give an outward normal or leave its cells empty");
  }
  return {{sides[0], normal.normalized()}};
}

template <int Dim>
PointCloud<Dim> read_csv(const Domain<Dim>& domain, const std::string& path) {
  std::ifstream file(path);
  std::string text;
  if (!file) throw CaseError("cannot be opened; check the path and the permissions");
  if (!std::getline(file, text)) throw CaseError("is empty; the first line must name the columns");
  const std::vector<std::string> columns = read_header<Dim>(text);
  CloudBuilder<Dim> builder;
  for (int number = 2; std::getline(file, text); ++number) {
    if (trimmed(text).empty()) continue;
    const CsvLine line{number, split(text, ','), columns};
    if (line.cells.size() != columns.size()) {
      throw CaseError(
          fmt::format("line {}: {} cells where the header has {}; write one cell for each "
                      "of {}",
                      number, line.cells.size(), columns.size(), fmt::join(columns, ",")));
    }
    Point<Dim> x;
    for (int c = 0; c < Dim; ++c) x[c] = line.finite(c);
    builder.add(x, read_marks(line, domain, x));
  }
  return builder.finish(domain.measure());
}

/// Reads a cloud by the extension of its file.
template <int Dim>
PointCloud<Dim> read_file(const Domain<Dim>& domain, const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".msh") return read_mesh(domain, path);
  try {
    if (extension == ".csv") return read_csv(domain, path);
    throw CaseError(
        fmt::format("extension '{}' is not known; give a Gmsh mesh (.msh) or a table "
                    "(.csv)",
                    extension));
  } catch (const CaseError& error) {
    throw CaseError(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace

/// Registers `file`: nodes, sides and normals from a Gmsh mesh or a CSV table; the level is
/// ignored.
LayoutEntry layout_file() {
  return layout_entry(
      {"file",
       "nodes from a Gmsh mesh (.msh, physical groups named after sides) or a table (.csv with "
       "x,y[,z],tag[,nx,ny,nz])",
       {{"path", "", "the file, .msh or .csv; the problem's own mesh, if it has one"}}},
      []<int Dim>(const Domain<Dim>& domain, const Options& options, const LayoutRequest&) {
        if (options.has("path")) return read_file(domain, options.text("path"));
        if (domain.own_mesh()) return read_file(domain, *domain.own_mesh());
        throw SkipCase("file: path= is missing, and the problem has no mesh of its own");
      },
      Sizing::by_file);
}

}  // namespace strongpoint
