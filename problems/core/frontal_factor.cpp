#include "problems/core/frontal_factor.hpp"

#include <algorithm>
#include <utility>

#include "problems/core/frontal_plan.hpp"
#include "problems/core/simd/front_kernel.hpp"

namespace strongpoint {
namespace {

/// Unknowns eliminated together: enough to keep the products of panels busy, few enough that the
/// panels' own work stays small.
constexpr int pivots_at_once = 32;

/// Factors beyond this are left to solvers whose factors grow less with the system.
constexpr std::size_t most_bytes = std::size_t{4} << 30;

int padded(int count) { return (count + front_tile - 1) / front_tile * front_tile; }

/// The entries of each column.
struct Columns {
  std::vector<int> offsets, rows;
  std::vector<double> values;

  explicit Columns(const Eigen::Map<const RowMatrix>& matrix)
      : offsets(matrix.cols() + 1, 0), rows(matrix.nonZeros()), values(matrix.nonZeros()) {
    const std::int64_t* const columns = matrix.innerIndexPtr();
    for (Eigen::Index i = 0; i < matrix.nonZeros(); ++i) ++offsets[columns[i] + 1];
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) offsets[c + 1] += offsets[c];
    std::vector<int> next(offsets.begin(), offsets.end() - 1);
    for (int row = 0; row < static_cast<int>(matrix.rows()); ++row) {
      for (std::int64_t i = matrix.outerIndexPtr()[row]; i < matrix.outerIndexPtr()[row + 1]; ++i) {
        const int at = next[columns[i]]++;
        rows[at] = row;
        values[at] = matrix.valuePtr()[i];
      }
    }
  }
};

}  // namespace

/// The dense matrix of unknowns that are coupled to eliminated ones.
class FrontalFactor::Front {
 public:
  Front(const Eigen::Map<const RowMatrix>& matrix, int fields, int widest)
      : matrix_(matrix),
        columns_(matrix),
        fields_(fields),
        stride_(padded(widest) + 8),  // no power of two
        entries_(static_cast<std::size_t>(stride_) * padded(widest)),
        place_(matrix.rows() / fields, outside) {}

  std::size_t doubles() const { return entries_.size(); }
  double* data() { return entries_.data(); }
  int stride() const { return stride_; }

  /// Lets nodes in, puts the ones to be eliminated last and adds their rows and columns.
  void advance(const FrontStep& step) {
    const auto size = static_cast<int>(step.nodes.size());
    clear(size - static_cast<int>(step.entering.size()), size);
    exchange(step.exchanges, size);
    for (int i = 0; i < size; ++i) place_[step.nodes[i]] = i;
    const int rest = size - (step.end - step.begin);
    for (int i = rest; i < size; ++i) add_rows(step.nodes[i]);
    for (int i = rest; i < size; ++i) add_columns(step.nodes[i], rest);
    for (int i = rest; i < size; ++i) place_[step.nodes[i]] = outside;
  }

 private:
  static constexpr int outside = -1;

  const Eigen::Map<const RowMatrix>& matrix_;
  Columns columns_;
  int fields_;
  int stride_;
  LargeArray<double> entries_;
  std::vector<int> place_;  ///< of each node

  double* row(int place) { return entries_.data() + static_cast<std::size_t>(place) * stride_; }

  /// Zeros the rows and columns of nodes at places from `old_size` on.
  void clear(int old_size, int size) {
    const int from = old_size * fields_;
    const int to = size * fields_;
    for (int r = 0; r < to; ++r) std::fill(row(r) + (r < from ? from : 0), row(r) + to, 0.0);
  }
  void exchange(std::span<const std::pair<int, int>> places, int size) {
    const int width = size * fields_;
    for (const auto& [a, b] : places) {
      for (int f = 0; f < fields_; ++f) {
        std::swap_ranges(row(a * fields_ + f), row(a * fields_ + f) + width, row(b * fields_ + f));
      }
    }
    for (int r = 0; r < width; ++r) {
      double* const entries = row(r);
      for (const auto& [a, b] : places) {
        for (int f = 0; f < fields_; ++f) {
          std::swap(entries[a * fields_ + f], entries[b * fields_ + f]);
        }
      }
    }
  }
  /// Adds what the rows of a node hold of columns that are still there.
  void add_rows(int node) {
    for (int f = 0; f < fields_; ++f) {
      double* const entries = row(place_[node] * fields_ + f);
      const std::int64_t line = std::int64_t{node} * fields_ + f;
      for (std::int64_t i = matrix_.outerIndexPtr()[line]; i < matrix_.outerIndexPtr()[line + 1];
           ++i) {
        const auto column = static_cast<int>(matrix_.innerIndexPtr()[i]);
        const int place = place_[column / fields_];
        if (place != outside) entries[place * fields_ + column % fields_] += matrix_.valuePtr()[i];
      }
    }
  }
  /// Adds what the columns of a node hold of the rows that stay.
  void add_columns(int node, int rest) {
    for (int f = 0; f < fields_; ++f) {
      const int column = node * fields_ + f;
      const int at = place_[node] * fields_ + f;
      for (int i = columns_.offsets[column]; i < columns_.offsets[column + 1]; ++i) {
        const int place = place_[columns_.rows[i] / fields_];
        if (place == outside || place >= rest) continue;
        row(place * fields_ + columns_.rows[i] % fields_)[at] += columns_.values[i];
      }
    }
  }
};

FrontalFactor::FrontalFactor(const Eigen::Map<const RowMatrix>& matrix, int fields,
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
    const Step step{planned.begin, planned.end, rest, padded(rest), fronts_.size(), room};
    room += static_cast<std::size_t>(pivots) * (pivots + 2 * step.length);
    steps_.push_back(step);
    for (const int node : planned.nodes) {
      for (int f = 0; f < fields; ++f) fronts_.push_back(node * fields + f);
    }
    widest = std::max(widest, size);
    longest_ = std::max(longest_, step.length);
  }
  has_factors_ = room * sizeof(double) <= most_bytes;
  if (!has_factors_) return;
  factors_.resize(room);
  Front front(matrix, fields, widest);
  front_doubles_ = front.doubles();
  for (std::size_t s = 0; s < plan.size() && has_factors_; ++s) {
    front.advance(plan[s]);
    const Step& step = steps_[s];
    const int pivots = pivots_of(step);
    double* const block = factors_.data() + step.block;
    double* const upper = block + static_cast<std::size_t>(pivots) * pivots;
    double* const lower = upper + static_cast<std::size_t>(pivots) * step.length;
    double least_pivot = 0;
    eliminate_pivots({front.data(), front.stride(), step.rest, pivots, block,
                      swapped_.data() + static_cast<std::ptrdiff_t>(step.begin) * fields, upper,
                      lower, step.length, &least_pivot});
    has_factors_ = least_pivot > 0;
  }
}

void FrontalFactor::solve(const double* b, double* x) const {
  const std::size_t n = swapped_.size();
  if (x != b) std::copy(b, b + n, x);
  std::vector<double> pivot_values(n);  // by order of elimination
  std::vector<double> gathered(longest_);
  for (const Step& step : steps_) {
    const int pivots = pivots_of(step);
    const double* const block = factors_.data() + step.block;
    const double* const lower = block + static_cast<std::size_t>(pivots) * (pivots + step.length);
    const int* const unknowns = fronts_.data() + step.unknowns;
    const std::size_t first = static_cast<std::size_t>(step.begin) * fields_;
    double* const values = pivot_values.data() + first;
    for (int k = 0; k < pivots; ++k) values[k] = x[unknowns[step.rest + k]];
    std::fill(gathered.begin(), gathered.begin() + step.length, 0.0);
    for (int k = 0; k < pivots; ++k) std::swap(values[k], values[swapped_[first + k]]);
    for (int k = 0; k < pivots; ++k) {
      for (int i = 0; i < k; ++i) values[k] -= block[k * pivots + i] * values[i];
      const double* const vector = lower + static_cast<std::size_t>(k) * step.length;
      for (int i = 0; i < step.rest; ++i) gathered[i] += vector[i] * values[k];
    }
    for (int i = 0; i < step.rest; ++i) x[unknowns[i]] -= gathered[i];
  }
  for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
    const int pivots = pivots_of(*step);
    const double* const block = factors_.data() + step->block;
    const double* const upper = block + static_cast<std::size_t>(pivots) * pivots;
    const int* const unknowns = fronts_.data() + step->unknowns;
    double* const values = pivot_values.data() + static_cast<std::size_t>(step->begin) * fields_;
    for (int i = 0; i < step->rest; ++i) gathered[i] = x[unknowns[i]];
    for (int k = pivots - 1; k >= 0; --k) {
      const double* const vector = upper + static_cast<std::size_t>(k) * step->length;
      double sum = values[k];
      for (int i = 0; i < step->rest; ++i) sum -= vector[i] * gathered[i];
      for (int i = k + 1; i < pivots; ++i) sum -= block[k * pivots + i] * values[i];
      values[k] = sum / block[k * pivots + k];
      x[unknowns[step->rest + k]] = values[k];
    }
  }
}

}  // namespace strongpoint
