#include "problems/core/frontal_factor.hpp"

#include <algorithm>
#include <utility>

#include "problems/core/frontal_plan.hpp"
#include "problems/core/simd/front_kernel.hpp"
#include "problems/core/simd/panel_kernel.hpp"

namespace strongpoint {
namespace {

/// Unknowns eliminated together: enough to keep the products of panels busy, few enough that the
/// panels' own work stays small.
constexpr int pivots_at_once = 32;

/// Factors beyond this are left to solvers whose factors grow less with the system.
constexpr std::size_t most_bytes = std::size_t{4} << 30;

template <class Real>
int padded(int count) {
  return (count + front_tile<Real> - 1) / front_tile<Real> * front_tile<Real>;
}

/// An entry of a column.
template <class Real>
struct Entry {
  int row;
  Real value;
};

/// The entries of each column in rows that are eliminated in a later step.
template <class Real>
struct Columns {
  std::vector<int> offsets;
  LargeArray<Entry<Real>> entries;

  /// `steps` holds the step in which each unknown is eliminated.
  Columns(const Eigen::Map<const RowMatrix>& matrix, std::span<const int> steps)
      : offsets(matrix.cols() + 1, 0) {
    for_later_rows(matrix, steps, [&](int column, int, double) { ++offsets[column + 1]; });
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) offsets[c + 1] += offsets[c];
    entries.resize(offsets.back());
    std::vector<int> next(offsets.begin(), offsets.end() - 1);
    for_later_rows(matrix, steps, [&](int column, int row, double value) {
      entries[next[column]++] = {row, static_cast<Real>(value)};
    });
  }
  std::span<const Entry<Real>> of(int column) const {
    return {entries.data() + offsets[column], entries.data() + offsets[column + 1]};
  }

 private:
  template <class Visit>
  static void for_later_rows(const Eigen::Map<const RowMatrix>& matrix, std::span<const int> steps,
                             const Visit& visit) {
    for (int row = 0; row < static_cast<int>(matrix.rows()); ++row) {
      for (std::int64_t i = matrix.outerIndexPtr()[row]; i < matrix.outerIndexPtr()[row + 1]; ++i) {
        const auto column = static_cast<int>(matrix.innerIndexPtr()[i]);
        if (steps[column] < steps[row]) visit(column, row, matrix.valuePtr()[i]);
      }
    }
  }
};

/// The step in which each unknown is eliminated.
std::vector<int> steps_of_unknowns(std::span<const FrontStep> plan, std::span<const int> order,
                                   int fields) {
  std::vector<int> steps(order.size() * fields);
  for (std::size_t s = 0; s < plan.size(); ++s) {
    for (int i = plan[s].begin; i < plan[s].end; ++i) {
      std::fill_n(steps.begin() + static_cast<std::ptrdiff_t>(order[i]) * fields, fields,
                  static_cast<int>(s));
    }
  }
  return steps;
}

/// Places of unknowns in a front (`FrontTask`).
struct Places {
  std::vector<int> pivots, from, to, rows;

  void set(const FrontStep& step, int fields) {
    pivots.clear();
    from.clear();
    to.clear();
    for (const int place : step.pivots) add(place, fields, pivots);
    for (const auto& [old_place, place] : step.moves) {
      add(old_place, fields, from);
      add(place, fields, to);
    }
    rows.resize(pivots.size());
  }

 private:
  static void add(int place, int fields, std::vector<int>& places) {
    for (int f = 0; f < fields; ++f) places.push_back(place * fields + f);
  }
};

}  // namespace

/// The dense matrix of unknowns that are coupled to eliminated ones.
template <class Real>
class FrontalFactor<Real>::Front {
 public:
  Front(const Eigen::Map<const RowMatrix>& matrix, int fields, int widest, Columns<Real> columns)
      : matrix_(matrix),
        columns_(std::move(columns)),
        fields_(fields),
        stride_(padded<Real>(widest) + 8),  // no power of two
        entries_(static_cast<std::size_t>(stride_) * padded<Real>(widest)),
        place_(matrix.rows(), outside) {}

  std::size_t size() const { return entries_.size(); }
  Real* data() { return entries_.data(); }
  int stride() const { return stride_; }

  /// Lets nodes in and adds the rows and columns of those that are eliminated.
  void advance(const FrontStep& step) {
    const auto size = static_cast<int>(step.nodes.size());
    const int old_size = size - static_cast<int>(step.entering.size());
    clear(old_size, size);
    for (int i = old_size; i < size; ++i) put(step.entering[i - old_size], i);
    const int* const pivots = step.nodes.data() + size - step.pivots.size();
    for (std::size_t i = 0; i < step.pivots.size(); ++i) add_rows(pivots[i], step.pivots[i]);
    for (std::size_t i = 0; i < step.pivots.size(); ++i) add_columns(pivots[i], step.pivots[i]);
    for (std::size_t i = 0; i < step.pivots.size(); ++i) {
      std::fill_n(place_.begin() + static_cast<std::ptrdiff_t>(pivots[i]) * fields_, fields_,
                  outside);
    }
    for (const auto& [from, to] : step.moves) put(step.nodes[to], to);
  }

 private:
  static constexpr int outside = -1;

  const Eigen::Map<const RowMatrix>& matrix_;
  Columns<Real> columns_;
  int fields_;
  int stride_;
  LargeArray<Real> entries_;
  std::vector<int> place_;  ///< of each unknown

  Real* row(int place) { return entries_.data() + static_cast<std::size_t>(place) * stride_; }
  void put(int node, int place) {
    for (int f = 0; f < fields_; ++f) place_[node * fields_ + f] = place * fields_ + f;
  }
  /// Zeros the rows and columns of nodes at places from `old_size` on.
  void clear(int old_size, int size) {
    const int from = old_size * fields_;
    const int to = size * fields_;
    for (int r = 0; r < to; ++r) std::fill(row(r) + (r < from ? from : 0), row(r) + to, Real{0});
  }
  /// Adds what the rows of a node hold of columns that are still there.
  void add_rows(int node, int place) {
    for (int f = 0; f < fields_; ++f) {
      Real* const entries = row(place * fields_ + f);
      const std::int64_t line = std::int64_t{node} * fields_ + f;
      for (std::int64_t i = matrix_.outerIndexPtr()[line]; i < matrix_.outerIndexPtr()[line + 1];
           ++i) {
        const int at = place_[matrix_.innerIndexPtr()[i]];
        if (at != outside) entries[at] += static_cast<Real>(matrix_.valuePtr()[i]);
      }
    }
  }
  /// Adds what the columns of a node hold of the rows that stay.
  void add_columns(int node, int place) {
    for (int f = 0; f < fields_; ++f) {
      const int at = place * fields_ + f;
      for (const Entry<Real>& entry : columns_.of(node * fields_ + f)) {
        row(place_[entry.row])[at] += entry.value;
      }
    }
  }
};

template <class Real>
std::size_t FrontalFactor<Real>::lower_of(const Step& step) const {
  return upper_of(step) + static_cast<std::size_t>(pivots_of(step)) * padded<Real>(step.rest);
}

template <class Real>
FrontalFactor<Real>::FrontalFactor(const Eigen::Map<const RowMatrix>& matrix, int fields,
                                   const NodeGraph& graph, std::span<const int> order)
    : fields_(fields), swapped_(matrix.rows()) {
  const std::vector<FrontStep> plan =
      plan_fronts(graph, order, std::max(1, pivots_at_once / fields));
  std::size_t room = 0;
  int widest = 0;
  for (const FrontStep& planned : plan) {
    const auto size = static_cast<int>(planned.nodes.size()) * fields;
    const int pivots = (planned.end - planned.begin) * fields;
    const int rest = size - pivots;
    const Step step{planned.begin, planned.end, rest, fronts_.size(), room};
    room += static_cast<std::size_t>(pivots) * (pivots + 2 * padded<Real>(rest));
    steps_.push_back(step);
    for (const int node : planned.nodes) {
      for (int f = 0; f < fields; ++f) fronts_.push_back(node * fields + f);
    }
    widest = std::max(widest, size);
    longest_ = std::max(longest_, padded<Real>(rest));
  }
  has_factors_ = room * sizeof(Real) <= most_bytes;
  if (!has_factors_) return;
  factors_.resize(room);
  Front front(matrix, fields, widest,
              Columns<Real>(matrix, steps_of_unknowns(plan, order, fields)));
  front_size_ = front.size();
  Places places;
  for (std::size_t s = 0; s < plan.size() && has_factors_; ++s) {
    front.advance(plan[s]);
    places.set(plan[s], fields);
    const Step& step = steps_[s];
    Real* const block = factors_.data() + step.block;
    double least_pivot = 0;
    eliminate_pivots(
        FrontTask<Real>{front.data(), front.stride(), step.rest, pivots_of(step),
                        places.pivots.data(), places.from.data(), places.to.data(),
                        static_cast<int>(places.from.size()), places.rows.data(), block,
                        swapped_.data() + static_cast<std::ptrdiff_t>(step.begin) * fields,
                        block + upper_of(step), block + lower_of(step), &least_pivot});
    has_factors_ = least_pivot > 0;
  }
}

template <class Real>
void FrontalFactor<Real>::solve(const double* b, double* x) const {
  const std::size_t n = swapped_.size();
  if (x != b) std::copy(b, b + n, x);
  std::vector<Real> pivot_values(n);  // by order of elimination
  std::vector<Real> gathered(longest_);
  for (const Step& step : steps_) {
    const int pivots = pivots_of(step);
    const Real* const block = factors_.data() + step.block;
    const int* const unknowns = fronts_.data() + step.unknowns;
    const std::size_t first = static_cast<std::size_t>(step.begin) * fields_;
    Real* const values = pivot_values.data() + first;
    for (int k = 0; k < pivots; ++k) values[k] = static_cast<Real>(x[unknowns[step.rest + k]]);
    for (int k = 0; k < pivots; ++k) std::swap(values[k], values[swapped_[first + k]]);
    for (int k = 0; k < pivots; ++k) {
      for (int i = 0; i < k; ++i) values[k] -= block[k * pivots + i] * values[i];
    }
    multiply_panel(
        PanelTask<Real>{block + lower_of(step), step.rest, pivots, values, gathered.data()});
    for (int i = 0; i < step.rest; ++i) x[unknowns[i]] -= gathered[i];
  }
  for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
    const int pivots = pivots_of(*step);
    const Real* const block = factors_.data() + step->block;
    const int* const unknowns = fronts_.data() + step->unknowns;
    Real* const values = pivot_values.data() + static_cast<std::size_t>(step->begin) * fields_;
    std::fill(gathered.begin(), gathered.end(), Real{0});
    for (int i = 0; i < step->rest; ++i) gathered[i] = static_cast<Real>(x[unknowns[i]]);
    subtract_turned_panel(
        PanelTask<Real>{block + upper_of(*step), step->rest, pivots, values, gathered.data()});
    for (int k = pivots - 1; k >= 0; --k) {
      Real sum = values[k];
      for (int i = k + 1; i < pivots; ++i) sum -= block[k * pivots + i] * values[i];
      values[k] = sum / block[k * pivots + k];
      x[unknowns[step->rest + k]] = values[k];
    }
  }
}

template class FrontalFactor<double>;
template class FrontalFactor<float>;

}  // namespace strongpoint
