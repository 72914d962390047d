#include "problems/core/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/parallel_errors.hpp"
#include "problems/core/assembly_rows.hpp"

namespace strongpoint {
namespace {

/// Rows that a thread treats in one go.
constexpr int rows_at_once = 512;

/// Whether the columns of a row are written, or compared with those that are there.
enum class Pattern { made, kept };

/// Runs `work(row, maker)` for all rows in parallel, with one maker a thread. What a row throws is
/// thrown for the lowest.
template <class Work>
void for_each_row(const RowSources& sources, const Work& work) {
  const int rows = sources.equations.size();
  ParallelErrors errors;
#pragma omp parallel
  {
    RowMaker maker(sources);
#pragma omp for schedule(static)
    for (int first = 0; first < rows; first += rows_at_once) {
      errors.guard(first, [&] {
        const int end = std::min(rows - first, rows_at_once) + first;
        for (int row = first; row < end; ++row) work(row, maker);
      });
    }
  }
  errors.rethrow();
}

/// Where a row is written, by its first term: points beyond those of the nodes are named as such.
std::string place_of(const EquationRow& row, const NodeUnknowns& unknowns) {
  if (row.empty()) return "without terms";
  const int point = row.front().point;
  const char* kind = point < unknowns.count ? "node" : "evaluation point";
  return fmt::format("with terms at {} {}", kind, point);
}

[[noreturn]] void refuse(int row, const RowSources& sources, const char* what) {
  throw CaseError(fmt::format("row {} of {}, {}, {}; check the problem's data and the stencil", row,
                              sources.equations.size(),
                              place_of(sources.equations.row(row), sources.unknowns), what));
}

/// Largest magnitude among values; NaN when one of them is not finite.
double largest_of(std::span<const double> values) {
  constexpr std::size_t lanes = 8;  // independent of each other
  double largest[lanes] = {};
  double spoiled[lanes] = {};
  std::size_t i = 0;
  for (; i + lanes <= values.size(); i += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double size = std::abs(values[i + lane]);
      largest[lane] = size > largest[lane] ? size : largest[lane];
      spoiled[lane] += size * 0;  // stays zero but for what is not finite
    }
  }
  for (; i < values.size(); ++i) {
    const double size = std::abs(values[i]);
    largest[0] = size > largest[0] ? size : largest[0];
    spoiled[0] += size * 0;
  }
  double result = largest[0];
  double sum = spoiled[0];
  for (std::size_t lane = 1; lane < lanes; ++lane) {
    result = largest[lane] > result ? largest[lane] : result;
    sum += spoiled[lane];
  }
  return sum == 0 ? result : std::numeric_limits<double>::quiet_NaN();
}

/// What a row is multiplied by.
double scale_of(int row, std::span<const double> values, const RowSources& sources) {
  const double largest = largest_of(values);
  const double scale = 1 / largest;
  const bool fine =
      std::isfinite(scale) && scale > 0 && std::isfinite(sources.equations.right_hand_sides[row]);
  if (!fine) {
    refuse(row, sources,
           largest == 0 ? "has no entry but zeros (or its node no stencil)"
                        : "holds a number that is not finite");
  }
  const LargeArray<double>& weights = sources.equations.row_weights;
  return weights.empty() ? scale : scale * weights[row];
}

void check_columns(int row, std::span<const std::int64_t> columns, const LinearSystem& system) {
  const std::int64_t begin = system.offsets[row];
  const std::int64_t count = system.offsets[row + 1] - begin;
  if (count == static_cast<std::int64_t>(columns.size()) &&
      std::equal(columns.begin(), columns.end(), system.columns.begin() + begin)) {
    return;
  }
  throw CaseError(
      fmt::format("row {}: its {} entries are not at the places of the {} that the "
                  "system has; assemble the system anew",
                  row, columns.size(), count));
}

void fill_rows(const RowSources& sources, Pattern pattern, LinearSystem& system) {
  for_each_row(sources, [&](int row, RowMaker& maker) {
    maker.make(row);
    const std::span<const double> values = maker.values();
    const std::span<const std::int64_t> columns = maker.columns();
    const double scale = scale_of(row, values, sources);
    const std::int64_t begin = system.offsets[row];
    if (pattern == Pattern::kept) {
      check_columns(row, columns, system);
    } else {
      std::copy(columns.begin(), columns.end(), system.columns.data() + begin);
    }
    double* const scaled = system.values.data() + begin;
    for (std::size_t i = 0; i < values.size(); ++i) scaled[i] = values[i] * scale;
    system.row_scales[row] = scale;
    system.right_hand_side[row] = sources.equations.right_hand_sides[row] * scale;
  });
}

}  // namespace

LinearSystem assemble(const EquationList& equations, const Weights& weights,
                      const NodeUnknowns& unknowns, int fields) {
  const int rows = equations.size();
  const int columns = unknowns.count * fields;
  if (rows < columns) {
    throw CaseError(fmt::format("{} equations for {} unknowns; one per node and field are needed",
                                rows, columns));
  }
  const RowSources sources{equations, weights, unknowns, fields};
  LinearSystem system;
  system.fields = fields;
  system.width = columns;
  system.offsets.resize(rows + 1);
  system.right_hand_side.resize(rows);
  system.row_scales.resize(rows);
  for_each_row(sources,
               [&](int row, RowMaker& maker) { system.offsets[row + 1] = maker.count(row); });
  system.offsets[0] = 0;
  for (int row = 0; row < rows; ++row) system.offsets[row + 1] += system.offsets[row];
  system.columns.resize(system.offsets.back());
  system.values.resize(system.offsets.back());
  fill_rows(sources, Pattern::made, system);
  return system;
}

void reassemble(const EquationList& equations, const Weights& weights, const NodeUnknowns& unknowns,
                LinearSystem& system) {
  const std::int64_t columns = static_cast<std::int64_t>(unknowns.count) * system.fields;
  if (equations.size() != system.rows() || columns != system.unknowns()) {
    throw CaseError(
        fmt::format("{} equations for {} unknowns do not fit a system of {} rows for "
                    "{}; assemble the system anew",
                    equations.size(), columns, system.rows(), system.unknowns()));
  }
  fill_rows({equations, weights, unknowns, system.fields}, Pattern::kept, system);
}

}  // namespace strongpoint
