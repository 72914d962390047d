#include "problems/core/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/parallel_errors.hpp"

namespace strongpoint {
namespace {

using Terms = std::span<const Term>;

/// Buffers of one thread.
struct Workspace {
  std::vector<std::pair<int, int>> order;  ///< (node, position in the stencil), sorted by node
  int ordered_point = -1;                  ///< the point that `order` belongs to
  Eigen::MatrixXd coefficients;            ///< (fields, derivatives)
  std::vector<std::uint8_t> used;          ///< (fields) 1 where the row has a term
  std::vector<std::int64_t> columns;       ///< of a row with several points, sorted
  std::vector<double> sums;                ///< (unknowns) its entries, at their columns
  std::vector<std::uint8_t> is_column;     ///< (unknowns) 1 at its columns
  int judged_point = -1;                   ///< the point that `is_plain` belongs to
  bool is_plain = true;                    ///< its nodes are unknowns, all different

  explicit Workspace(int unknowns) : sums(unknowns, 0.0), is_column(unknowns, 0) {}
};

/// What rows are made of beside their terms.
struct Scene {
  const Weights& weights;
  const NodeUnknowns& unknowns;
  int fields;

  std::int64_t column(int node, int field) const {
    return static_cast<std::int64_t>(unknowns.of(node)) * fields + field;
  }
};

/// True when all terms name one point, the case that assembles at full speed.
bool has_single_point(Terms terms) {
  return std::all_of(terms.begin(), terms.end(),
                     [&](const Term& term) { return term.point == terms.front().point; });
}

bool is_bare_value(Terms terms) {
  return std::all_of(terms.begin(), terms.end(),
                     [](const Term& term) { return term.derivative == value_only; });
}

/// Marks the fields that occur among the terms on derivatives; returns how many.
int mark_fields(Terms terms, int fields, std::vector<std::uint8_t>& used) {
  used.assign(fields, 0);
  for (const Term& term : terms) {
    if (term.derivative != value_only) used[term.field] = 1;
  }
  return static_cast<int>(std::count(used.begin(), used.end(), 1));
}

/// Sums the entries of all terms by column, whatever their points, in the order of the terms.
void gather_entries(Terms terms, const Scene& scene, Workspace& work) {
  for (std::int64_t column : work.columns) {
    work.sums[column] = 0;
    work.is_column[column] = 0;
  }
  work.columns.clear();
  const auto add = [&work](std::int64_t column, double value) {
    if (work.is_column[column] == 0) work.columns.push_back(column);
    work.is_column[column] = 1;
    work.sums[column] += value;
  };
  for (const Term& term : terms) {
    if (term.derivative == value_only) {
      add(scene.column(term.point, term.field),
          scene.unknowns.sign(term.point, term.field) * term.coefficient);
      continue;
    }
    const Weights& weights = scene.weights;
    const std::span<const int> nodes = weights.nodes(term.point);
    if (nodes.empty()) {
      throw CaseError(
          fmt::format("a derivative is read at evaluation point {}, which has no weights; its "
                      "stencil was not asked for",
                      term.point));
    }
    const double* values =
        weights.values.data() + weights.offsets[term.point] * weights.per_entry + term.derivative;
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      add(scene.column(nodes[j], term.field), scene.unknowns.sign(nodes[j], term.field) *
                                                  term.coefficient * values[j * weights.per_entry]);
    }
  }
  std::sort(work.columns.begin(), work.columns.end());
}

/// True when the nodes in a point's row are unknowns themselves.
bool has_plain_nodes(int point, const Scene& scene, Workspace& work) {
  if (scene.unknowns.is_identity()) return true;
  if (work.judged_point != point) {
    const std::span<const int> nodes = scene.weights.nodes(point);
    work.judged_point = point;
    work.is_plain = std::all_of(nodes.begin(), nodes.end(),
                                [&](int node) { return scene.unknowns.of(node) == node; });
  }
  return work.is_plain;
}

/// True when the row is derivatives of fields at one point, without bare values, and no two of its
/// nodes stand for one unknown.
bool is_compact(Terms terms, const Scene& scene, Workspace& work) {
  return has_single_point(terms) &&
         std::none_of(terms.begin(), terms.end(),
                      [](const Term& term) { return term.derivative == value_only; }) &&
         has_plain_nodes(terms.front().point, scene, work);
}

std::int64_t count_entries(Terms terms, const Scene& scene, Workspace& work) {
  if (terms.empty()) return 0;
  if (is_compact(terms, scene, work)) {
    const auto stencil = static_cast<std::int64_t>(scene.weights.nodes(terms.front().point).size());
    return mark_fields(terms, scene.fields, work.used) * stencil;
  }
  if (terms.size() == 1 && is_bare_value(terms)) return 1;
  gather_entries(terms, scene, work);
  return static_cast<std::int64_t>(work.columns.size());
}

/// Fills a compact row: for every stencil node the used fields, a product (fields x derivatives)
/// with the node's weights.
void fill_compact(Terms terms, const Scene& scene, Workspace& work, std::int64_t* columns,
                  double* values) {
  const Weights& weights = scene.weights;
  const int fields = scene.fields;
  const int point = terms.front().point;
  const std::span<const int> nodes = weights.nodes(point);
  if (work.ordered_point != point) {  // sorted once per stencil, not once per row
    work.ordered_point = point;
    work.order.clear();
    for (std::size_t j = 0; j < nodes.size(); ++j)
      work.order.emplace_back(nodes[j], static_cast<int>(j));
    std::sort(work.order.begin(), work.order.end());
  }
  mark_fields(terms, fields, work.used);
  work.coefficients.setZero(fields, weights.per_entry);
  for (const Term& term : terms) work.coefficients(term.field, term.derivative) += term.coefficient;
  const double* base = weights.values.data() + weights.offsets[point] * weights.per_entry;
  std::size_t at = 0;
  for (const auto& [node, position] : work.order) {
    const double* of_entry = base + static_cast<std::ptrdiff_t>(position) * weights.per_entry;
    for (int f = 0; f < fields; ++f) {
      if (work.used[f] == 0) continue;
      double sum = 0;
      for (int d = 0; d < weights.per_entry; ++d) sum += work.coefficients(f, d) * of_entry[d];
      columns[at] = static_cast<std::int64_t>(node) * fields + f;
      values[at++] = sum;
    }
  }
}

void fill_row(Terms terms, const Scene& scene, Workspace& work, std::int64_t* columns,
              double* values) {
  if (is_compact(terms, scene, work)) {
    fill_compact(terms, scene, work, columns, values);
    return;
  }
  gather_entries(terms, scene, work);
  for (std::size_t i = 0; i < work.columns.size(); ++i) {
    columns[i] = work.columns[i];
    values[i] = work.sums[work.columns[i]];
  }
}

/// Largest magnitude of a row, 1 / which scales it; 0 or NaN mark a bad row.
double scale_row(double* values, std::int64_t count, double& right_hand_side) {
  double largest = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    if (!std::isfinite(values[i])) return std::numeric_limits<double>::quiet_NaN();
    largest = std::max(largest, std::abs(values[i]));
  }
  if (largest > 0) {
    for (std::int64_t i = 0; i < count; ++i) values[i] /= largest;
    right_hand_side /= largest;
  }
  return largest;
}

/// Runs `work(row, workspace)` for all rows in parallel, with one workspace a thread.
template <class Work>
void for_each_row(int rows, int unknowns, const Work& work) {
  ParallelErrors errors;
#pragma omp parallel
  {
    Workspace workspace(unknowns);
#pragma omp for schedule(static)
    for (int row = 0; row < rows; ++row) {
      errors.guard(row, [&] { work(row, workspace); });
    }
  }
  errors.rethrow();
}

/// Where a row is written, by its first term: points beyond those of the nodes are named as such.
std::string place_of(Terms terms, const Scene& scene) {
  if (terms.empty()) return "without terms";
  const int point = terms.front().point;
  const char* kind = point < scene.unknowns.count ? "node" : "evaluation point";
  return fmt::format("with terms at {} {}", kind, point);
}

void check_rows(const EquationList& equations, const Scene& scene,
                const std::vector<double>& largest, const Eigen::VectorXd& right_hand_side) {
  for (std::size_t row = 0; row < largest.size(); ++row) {
    const bool fine =
        largest[row] > 0 && std::isfinite(right_hand_side[static_cast<Eigen::Index>(row)]);
    if (fine) continue;
    const char* what = largest[row] == 0 ? "has no entry but zeros (or its node no stencil)"
                                         : "holds a number that is not finite";
    throw CaseError(fmt::format("row {} of {}, {}, {}; check the problem's data and the stencil",
                                row, largest.size(),
                                place_of(equations.row(static_cast<int>(row)), scene), what));
  }
}

void weigh_rows(const std::vector<double>& row_weights, LinearSystem& system) {
  for (std::size_t row = 0; row < row_weights.size(); ++row) {
    for (std::int64_t i = system.offsets[row]; i < system.offsets[row + 1]; ++i) {
      system.values[i] *= row_weights[row];
    }
    system.right_hand_side[static_cast<Eigen::Index>(row)] *= row_weights[row];
    system.row_scales[row] *= row_weights[row];
  }
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
  const Scene scene{weights, unknowns, fields};
  LinearSystem system;
  system.fields = fields;
  system.width = columns;
  system.offsets.assign(rows + 1, 0);
  system.right_hand_side =
      Eigen::Map<const Eigen::VectorXd>(equations.right_hand_sides.data(), rows);
  std::vector<double> largest(rows);
  for_each_row(rows, columns, [&](int row, Workspace& work) {
    system.offsets[row + 1] = count_entries(equations.row(row), scene, work);
  });
  for (int row = 0; row < rows; ++row) system.offsets[row + 1] += system.offsets[row];
  system.columns.resize(system.offsets.back());
  system.values.resize(system.offsets.back());
  for_each_row(rows, columns, [&](int row, Workspace& work) {
    const std::int64_t begin = system.offsets[row];
    const std::int64_t count = system.offsets[row + 1] - begin;
    if (count == 0) return;
    fill_row(equations.row(row), scene, work, system.columns.data() + begin,
             system.values.data() + begin);
    largest[row] = scale_row(system.values.data() + begin, count, system.right_hand_side[row]);
  });
  check_rows(equations, scene, largest, system.right_hand_side);
  system.row_scales.resize(rows);
  for (int row = 0; row < rows; ++row) system.row_scales[row] = 1 / largest[row];
  if (!equations.row_weights.empty()) weigh_rows(equations.row_weights, system);
  return system;
}

}  // namespace strongpoint
