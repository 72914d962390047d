#include "problems/core/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/parallel_errors.hpp"
#include "problems/core/assembly_rows.hpp"
#include "problems/core/row_runs.hpp"

namespace strongpoint {
namespace {

/// Nodes whose rows a thread treats in one go.
constexpr int nodes_at_once = 256;

constexpr double most = std::numeric_limits<double>::max();

/// Distance between the points of two places.
constexpr int ints_of_place = sizeof(EquationPlace) / sizeof(int);
static_assert(sizeof(EquationPlace) % sizeof(int) == 0, "points lie a whole number of ints apart");

/// Whether the columns of a row are written, or compared with those that are there.
enum class Pattern { made, kept };

/// What one thread makes rows with.
struct Tools {
  RowMaker maker;
  RowRuns runs;

  explicit Tools(const RowSources& sources) : maker(sources), runs(sources) {}
};

/// Runs `work(row, end, tools)`, which treats some rows from `row` on and returns their number,
/// until all rows are treated: in parallel, with tools for each thread. What a row throws is thrown
/// for the lowest.
template <class Work>
void for_all_rows(const RowSources& sources, const Work& work) {
  const int rows = sources.equations.size();
  const int rows_at_once = nodes_at_once * sources.fields;
  ParallelErrors errors;
#pragma omp parallel
  {
    Tools tools(sources);
#pragma omp for schedule(static)
    for (int first = 0; first < rows; first += rows_at_once) {
      errors.guard(first, [&] {
        const int end = std::min(rows - first, rows_at_once) + first;
        for (int row = first; row < end;) row += work(row, end, tools);
      });
    }
  }
  errors.rethrow();
}

/// Where a row is written, by its first term: points beyond those of the nodes are named as such.
std::string place_of(const EquationRow& row, const NodeUnknowns& unknowns) {
  if (row.empty()) return "without terms";
  const int point = row.front().point;
  if (point >= unknowns.count) return fmt::format("with terms at evaluation point {}", point);
  return fmt::format("with terms at node {}", unknowns.number_of(point));
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

/// Makes one row, of whatever kind.
void fill_row(const RowSources& sources, int row, Pattern pattern, RowMaker& maker,
              LinearSystem& system) {
  maker.make(row);
  const std::span<const double> values = maker.values();
  const double scale = scale_of(row, values, sources);
  const std::int64_t begin = system.offsets[row];
  if (pattern == Pattern::kept) {
    check_columns(row, maker.columns(), system);
  } else {
    std::copy(maker.columns().begin(), maker.columns().end(), system.columns.data() + begin);
  }
  double* const scaled = system.values.data() + begin;
  for (std::size_t i = 0; i < values.size(); ++i) scaled[i] = values[i] * scale;
  system.row_scales[row] = scale;
  system.right_hand_side[row] = sources.equations.right_hand_sides[row] * scale;
}

/// Makes the rows of a run; those that the kernel finds fault with are judged one by one.
void fill_run(const RowSources& sources, int first, int points, Pattern pattern, Tools& tools,
              LinearSystem& system) {
  const LargeArray<double>& row_weights = sources.equations.row_weights;
  int other_columns = -1;
  make_rows({.weight_offsets = sources.weights.offsets.data(),
             .nodes = sources.weights.columns.data(),
             .weights = sources.weights.values.data(),
             .derivatives = sources.weights.per_entry,
             .fields = sources.fields,
             .coefficients = tools.runs.coefficients().data(),
             .points = &sources.equations.places[first].point,
             .point_step = sources.fields * ints_of_place,
             .count = points,
             .offsets = system.offsets.data() + first,
             .row_weights = row_weights.empty() ? nullptr : row_weights.data() + first,
             .columns = system.columns.data(),
             .values = system.values.data(),
             .scales = system.row_scales.data() + first,
             .output = system.values.size() >= least_streamed ? Output::streamed : Output::cached,
             .other_columns = pattern == Pattern::kept ? &other_columns : nullptr});
  const int end = other_columns >= 0 ? first + other_columns + 1 : first + points * sources.fields;
  const double* const scales = system.row_scales.data();
  const double* const given = sources.equations.right_hand_sides.data();
  double* const scaled = system.right_hand_side.data();
  int bad = 0;
  for (int row = first; row < end; ++row) {
    bad += (scales[row] > 0 ? 0 : 1) + (std::abs(given[row]) <= most ? 0 : 1);
    scaled[row] = given[row] * scales[row];
  }
  if (bad == 0 && other_columns < 0) return;
  for (int row = first; row < end; ++row) {
    if (row == first + other_columns || !(scales[row] > 0) || !std::isfinite(given[row])) {
      fill_row(sources, row, pattern, tools.maker, system);
    }
  }
}

void fill_rows(const RowSources& sources, Pattern pattern, LinearSystem& system) {
  for_all_rows(sources, [&](int row, int end, Tools& tools) {
    if (const int points = tools.runs.find(row, end); points > 0) {
      fill_run(sources, row, points, pattern, tools, system);
      return points * sources.fields;
    }
    fill_row(sources, row, pattern, tools.maker, system);
    return 1;
  });
}

/// Writes the number of entries of each row behind it.
void count_entries(const RowSources& sources, LargeArray<std::int64_t>& offsets) {
  for_all_rows(sources, [&](int row, int end, Tools& tools) {
    std::int64_t* count = offsets.data() + row + 1;
    const int points = tools.runs.find(row, end);
    if (points == 0) {
      *count = tools.maker.count(row);
      return 1;
    }
    const EquationPlace* place = sources.equations.places.data() + row;
    for (int i = 0; i < points; ++i, place += sources.fields) {
      const auto nodes = static_cast<std::int64_t>(sources.weights.nodes(place->point).size());
      for (int r = 0; r < sources.fields; ++r) *count++ = nodes * sources.fields;
    }
    return points * sources.fields;
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
  system.field_axis = unknowns.field_axis;
  system.width = columns;
  system.offsets.resize(rows + 1);
  system.right_hand_side.resize(rows);
  system.row_scales.resize(rows);
  system.offsets[0] = 0;
  count_entries(sources, system.offsets);
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
