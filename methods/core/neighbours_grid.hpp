#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "methods/core/neighbours_groups.hpp"

namespace strongpoint {

/// Cubic cells in row-major order with the nodes sorted by cell, coordinates as a structure of
/// arrays. A query scans shells of cells around its own until no farther cell can hold a nearer
/// node. Made for clouds of about even density: memory is bounded for any cloud, but a cloud that
/// crowds into few cells costs a scan of the crowd per query.
template <int Dim>
class GridEngine {
 public:
  explicit GridEngine(const Points<Dim>& nodes) {
    if (nodes.cols() == 0) return;
    choose_cells(nodes);
    sort_by_cell(nodes);
  }

  /// Offers all nodes within the collector's bound.
  void visit(const Point<Dim>& query, CandidateCollector auto& collector) const {
    if (sorted_.size() == 0) return;
    const Cell home = cell_of(query);
    int inner = -1;
    int outer = first_shell(collector.expected());
    while (true) {
      scan_shell(query, home, inner, outer, collector);
      const double clearance = squared_clearance(query, home, outer) * shy;
      // An infinite clearance means that nothing is left, even when the bound is infinite too.
      if (clearance > collector.bound() || std::isinf(clearance)) return;
      inner = outer++;
    }
  }

  /// The nodes by cell; a cell is a group.
  const SortedNodes<Dim>& sorted() const { return sorted_; }
  int groups() const { return static_cast<int>(cell_start_.size()) - 1; }
  std::pair<int, int> group(int g) const { return {cell_start_[g], cell_start_[g + 1]}; }
  int group_of(const Point<Dim>& x) const { return index_of(cell_of(x)); }
  /// Whether the cells share the nodes well: the fullest one holds less than 8 times the mean of
  /// those that hold any.
  bool is_even() const {
    int fullest = 0;
    int occupied = 0;
    for (int g = 0; g < groups(); ++g) {
      const int count = cell_start_[g + 1] - cell_start_[g];
      fullest = std::max(fullest, count);
      occupied += count > 0 ? 1 : 0;
    }
    return static_cast<double>(fullest) * occupied < 8.0 * sorted_.size();
  }
  /// Squared radius of a ball of about k nodes at the density of cell g.
  double expected_square(int g, int k) const {
    const double count = std::max(1, cell_start_[g + 1] - cell_start_[g]);
    return square_of_ball(k / count, edge_, directions_);
  }
  /// Lists ranges, begin and end, of the sorted nodes that include all within `reach` of a box;
  /// returns how many. The list grows where it has to and is not cut back.
  int list_ranges(const Point<Dim>& low, const Point<Dim>& high, double reach,
                  std::vector<int>& ranges) const;

 private:
  using Cell = std::array<int, Dim>;

  /// Mean number of nodes in a cell of an even cloud. Measured: few enough that the list around a
  /// cell is not long, many enough that it serves several queries.
  static constexpr double nodes_per_cell = Dim == 1 ? 3 : Dim == 2 ? 12 : 14;
  /// Keeps round-off in the distance to a cell from hiding a node on its face.
  static constexpr double shy = 1 - 1e-12;

  Point<Dim> low_, high_;        ///< corners of the nodes' bounding box
  Cell counts_;                  ///< cells along each direction
  double edge_ = 1;              ///< of a cell
  double per_edge_ = 1;          ///< 1 / edge_
  double slack_ = 0;             ///< bounds the round-off in telling the cell of a node
  std::vector<int> cell_start_;  ///< (cells + 1) into the arrays below
  int directions_ = 0;           ///< in which the cloud is thicker than a cell
  SortedNodes<Dim> sorted_;      ///< by cell, ids ascending within a cell

  void choose_cells(const Points<Dim>& nodes);
  void sort_by_cell(const Points<Dim>& nodes);

  /// The cell of a position, the nearest one when it lies outside.
  Cell cell_of(const Point<Dim>& x) const {
    Cell cell;
    for (int c = 0; c < Dim; ++c) {
      const double position = (x[c] - low_[c]) * per_edge_;
      cell[c] = static_cast<int>(std::clamp(position, 0.0, counts_[c] - 1.0));
    }
    return cell;
  }
  int index_of(const Cell& cell) const {
    int index = 0;
    for (int c = 0; c < Dim; ++c) index = index * counts_[c] + cell[c];
    return index;
  }
  /// Half width, in cells, of the block scanned first: it holds about `expected` nodes.
  static int first_shell(int expected) {
    const double cells = std::pow(std::max(1.0, expected / nodes_per_cell), 1.0 / Dim);
    return static_cast<int>(std::min(1e9, (cells - 1) / 2));
  }
  /// Square of a distance that every node beyond the block of half width `reach` exceeds; infinite
  /// when there is none.
  double squared_clearance(const Point<Dim>& x, const Cell& home, int reach) const;
  /// Square of the distance from x to a range of cells in one direction.
  double squared_gap(const Point<Dim>& x, int c, int first, int last) const {
    const double below = low_[c] + first * edge_ - x[c] - slack_;
    const double above = x[c] - (low_[c] + (last + 1.0) * edge_) - slack_;
    const double gap =
        std::max({0.0, first > 0 ? below : 0.0, last < counts_[c] - 1 ? above : 0.0});
    return gap * gap;
  }
  /// Offers the nodes in cells farther than `inner` and at most `outer` cells from `home`.
  void scan_shell(const Point<Dim>& x, const Cell& home, int inner, int outer,
                  CandidateCollector auto& collector) const;
  /// Offers the nodes in cells `first` to `last` of the row that `cell` names, clipped to the grid.
  void scan_row(const Point<Dim>& x, Cell cell, int first, int last,
                CandidateCollector auto& collector) const;
};

template <int Dim>
void GridEngine<Dim>::choose_cells(const Points<Dim>& nodes) {
  low_ = nodes.rowwise().minCoeff();
  high_ = nodes.rowwise().maxCoeff();
  const Point<Dim> extent = high_ - low_;
  std::array<bool, Dim> thin;
  for (int c = 0; c < Dim; ++c) thin[c] = !(extent[c] > 1e-250);
  // A direction thinner than a cell gets one layer, and the cells then spread over the others.
  for (bool again = true; again;) {
    double log_measure = 0;
    int directions = 0;
    for (int c = 0; c < Dim; ++c) {
      if (thin[c]) continue;
      log_measure += std::log(extent[c]);
      ++directions;
    }
    if (directions == 0) break;
    const double cells = std::max(1.0, static_cast<double>(nodes.cols()) / nodes_per_cell);
    edge_ = std::exp((log_measure - std::log(cells)) / directions);
    again = false;
    for (int c = 0; c < Dim; ++c) {
      if (thin[c] || extent[c] >= edge_ || directions == 1) continue;
      thin[c] = true;
      again = true;
      break;
    }
  }
  directions_ = Dim - static_cast<int>(std::count(thin.begin(), thin.end(), true));
  for (int c = 0; c < Dim; ++c) counts_[c] = thin[c] ? 1 : static_cast<int>(extent[c] / edge_) + 1;
  per_edge_ = 1 / edge_;
  slack_ = 8 * std::numeric_limits<double>::epsilon() *
           (low_.cwiseAbs().maxCoeff() + high_.cwiseAbs().maxCoeff());
}

template <int Dim>
void GridEngine<Dim>::sort_by_cell(const Points<Dim>& nodes) {
  const int count = static_cast<int>(nodes.cols());
  int cells = 1;
  for (int c = 0; c < Dim; ++c) cells *= counts_[c];
  cell_start_.assign(static_cast<std::size_t>(cells) + 1, 0);
  std::vector<int> cell(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    cell[i] = index_of(cell_of(nodes.col(i)));
    ++cell_start_[cell[i] + 1];
  }
  for (int i = 0; i < cells; ++i) cell_start_[i + 1] += cell_start_[i];
  std::vector<int> next(cell_start_.begin(), cell_start_.end() - 1);
  std::vector<int> order(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) order[next[cell[i]]++] = i;
  sorted_.assign(nodes, std::move(order));
}

template <int Dim>
int GridEngine<Dim>::list_ranges(const Point<Dim>& low, const Point<Dim>& high, double reach,
                                 std::vector<int>& ranges) const {
  const double wide = reach * (1 + 1e-9) + slack_ +
                      1e-15 * (low.cwiseAbs().maxCoeff() + high.cwiseAbs().maxCoeff());
  const Cell first = cell_of(low - Point<Dim>::Constant(wide));
  const Cell last = cell_of(high + Point<Dim>::Constant(wide));
  std::size_t rows = 1;
  for (int c = 0; c < Dim - 1; ++c) rows *= static_cast<std::size_t>(last[c] - first[c]) + 1;
  if (ranges.size() < 2 * rows) ranges.resize(2 * rows);
  int* next = ranges.data();
  Cell cell = first;
  cell[Dim - 1] = 0;
  while (true) {
    const int row = index_of(cell);
    *next++ = cell_start_[row + first[Dim - 1]];
    *next++ = cell_start_[row + last[Dim - 1] + 1];
    int c = Dim - 2;
    while (c >= 0 && cell[c] == last[c]) {
      cell[c] = first[c];
      --c;
    }
    if (c < 0) return static_cast<int>(rows);
    ++cell[c];
  }
}

template <int Dim>
double GridEngine<Dim>::squared_clearance(const Point<Dim>& x, const Cell& home, int reach) const {
  // A query outside the box is at least this far away from any node, per direction.
  Point<Dim> outside;
  for (int c = 0; c < Dim; ++c) outside[c] = std::max({0.0, low_[c] - x[c], x[c] - high_[c]});
  const double all_outside = outside.squaredNorm();
  double clearance = std::numeric_limits<double>::infinity();
  for (int c = 0; c < Dim; ++c) {
    const double others = std::max(0.0, all_outside * (1 - 1e-14) - outside[c] * outside[c]);
    const auto beyond = [&](double gap) {
      const double safe = std::max(0.0, gap - slack_);
      clearance = std::min(clearance, safe * safe + others);
    };
    if (home[c] - reach > 0) beyond(x[c] - (low_[c] + (home[c] - reach) * edge_));
    if (home[c] < counts_[c] - 1 - reach) beyond(low_[c] + (home[c] + reach + 1.0) * edge_ - x[c]);
  }
  return clearance;
}

template <int Dim>
void GridEngine<Dim>::scan_shell(const Point<Dim>& x, const Cell& home, int inner, int outer,
                                 CandidateCollector auto& collector) const {
  // Rows run along the last direction; the others are counted through like the digits of a number.
  constexpr int last = Dim - 1;
  Cell first_cell, last_cell;
  for (int c = 0; c < Dim; ++c) {
    first_cell[c] = std::max(0, home[c] - outer);
    last_cell[c] = outer > counts_[c] ? counts_[c] - 1 : std::min(counts_[c] - 1, home[c] + outer);
  }
  Cell cell = first_cell;
  while (true) {
    int away = -1;
    for (int c = 0; c < last; ++c) away = std::max(away, std::abs(cell[c] - home[c]));
    if (away > inner || inner < 0) {
      scan_row(x, cell, first_cell[last], last_cell[last], collector);
    } else {
      scan_row(x, cell, first_cell[last], home[last] - inner - 1, collector);
      scan_row(x, cell, home[last] + inner + 1, last_cell[last], collector);
    }
    int c = last - 1;
    while (c >= 0 && cell[c] == last_cell[c]) {
      cell[c] = first_cell[c];
      --c;
    }
    if (c < 0) return;
    ++cell[c];
  }
}

template <int Dim>
void GridEngine<Dim>::scan_row(const Point<Dim>& x, Cell cell, int first, int last,
                               CandidateCollector auto& collector) const {
  if (first > last) return;
  double gap = squared_gap(x, Dim - 1, first, last);
  for (int c = 0; c < Dim - 1; ++c) gap += squared_gap(x, c, cell[c], cell[c]);
  if (gap * shy > collector.bound()) return;
  cell[Dim - 1] = 0;
  const int row = index_of(cell);
  for (int i = cell_start_[row + first]; i < cell_start_[row + last + 1]; ++i) {
    Point<Dim> node;
    for (int c = 0; c < Dim; ++c) node[c] = sorted_.coordinates[c][i];
    const double d2 = squared_distance<Dim>(x, node);
    if (d2 <= collector.bound()) collector.offer({d2, sorted_.ids[i]});
  }
}

}  // namespace strongpoint
