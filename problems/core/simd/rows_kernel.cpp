#include "problems/core/simd/rows_kernel.hpp"

#include "methods/core/simd/lane_scatter.hpp"
#include "problems/core/simd/few_nodes.hpp"
#include "problems/core/simd/few_vectors.hpp"
#include "problems/core/simd/node_ranks.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

/// Entries that were made and wait to be written, few enough to stay in the first-level cache.
struct Made {
  static constexpr int room = 1024;

  alignas(64) double values[room + 2 * few_nodes] = {};  // some are written in packs
  alignas(64) std::int64_t columns[room + 2 * few_nodes] = {};
  std::int64_t begin = 0;  ///< where they go
  int count = 0;

  void write(const RowsTask& task) {
    copy(task.output, values, task.values + begin);
    if (task.other_columns == nullptr) copy(task.output, columns, task.columns + begin);
    begin += count;
    count = 0;
  }

 private:
  template <class Number>
  void copy(Output output, const Number* from, Number* to) const {
    if (output == Output::streamed) return stream_copy(from, count, to);
    for (int e = 0; e < count; ++e) to[e] = from[e];
  }
};

/// Buffers for one point.
template <int Fields>
struct Buffers {
  static constexpr int entries = Fields * Fields;  ///< of a node, in all rows
  static constexpr int width = (entries + lanes - 1) / lanes * lanes;

  alignas(64) int rank[most_kernel_nodes];
  alignas(64) double coefficients[most_kernel_derivatives][width];  ///< again and again in a row
  alignas(64) std::int64_t columns[most_kernel_nodes * Fields];
  alignas(64) double sums[most_kernel_nodes][width];
  Made made;
  double entries_of_one[most_kernel_nodes];  ///< of one field
  double scales[Fields];
  int used[most_kernel_derivatives];  ///< derivatives that have coefficients, one at least
  int used_count;
};

/// Sums of all rows at the nodes, put where the nodes belong: a node's derivatives times the
/// coefficients. Weights are read as they lie in memory.
template <int Fields>
void add_up(const RowsTask& task, std::int64_t first, int count, Buffers<Fields>& work) {
  constexpr int packs = Buffers<Fields>::width / lanes;
  for (int j = 0; j < count; ++j) {
    const double* w = task.weights + (first + j) * task.derivatives;
    Pack sums[packs] = {};
    for (int u = 0; u < work.used_count; ++u) {
      const Pack weight = all(w[work.used[u]]);
      for (int e = 0; e < packs; ++e) {
        sums[e] = sums[e] + weight * load(work.coefficients[u] + e * lanes);
      }
    }
    for (int e = 0; e < packs; ++e) store(work.sums[work.rank[j]] + e * lanes, sums[e]);
  }
}

/// The scales of all rows.
template <int Fields>
void find_scales(int count, Buffers<Fields>& work) {
  using Work = Buffers<Fields>;
  alignas(64) double largest[Work::width];
  alignas(64) double total[Work::width];
  for (int e = 0; e < Work::width; e += lanes) {
    Pack high = all(0);
    Pack sum = all(0);
    for (int j = 0; j < count; ++j) {
      const Pack size = abs(load(&work.sums[j][e]));
      high = max(size, high);
      sum = sum + size;
    }
    store(largest + e, high);
    store(total + e, sum);
  }
  for (int row = 0; row < Fields; ++row) {
    double high = 0;
    double sum = 0;
    for (int f = 0; f < Fields; ++f) {
      const int e = row * Fields + f;
      high = largest[e] > high ? largest[e] : high;
      sum += total[e];
    }
    work.scales[row] = scale_of(high, sum);
  }
}

/// Makes the rows of a point, behind those that wait, and their scales times `row_weights`.
template <int Fields>
struct PointRows {
  static void make(const RowsTask& task, std::int64_t first, int count, const double* row_weights,
                   Buffers<Fields>& work) {
    if constexpr (Fields == FewVectors::fields) {
      if (count <= few_nodes && make_few(task, first, count, row_weights, work)) return;
    }
    rank_nodes(task.nodes + first, count, work.rank);
    add_up<Fields>(task, first, count, work);
    find_scales<Fields>(count, work);
    for (int j = 0; j < count; ++j) {
      std::int64_t* const columns = work.columns + work.rank[j] * Fields;
      for (int f = 0; f < Fields; ++f) {
        columns[f] = static_cast<std::int64_t>(task.nodes[first + j]) * Fields + f;
      }
    }
    for (int row = 0; row < Fields; ++row) {
      work.scales[row] *= row_weights[row];
      put(count, row, work);
    }
  }

 private:
  static bool make_few(const RowsTask& task, std::int64_t first, int count,
                       const double* row_weights, Buffers<Fields>& work) {
    FewVectors few;
    if (!few.sort(task.nodes + first, count)) return false;
    few.add_up(task.weights + first * task.derivatives, task.derivatives, work.used,
               work.used_count, work.coefficients);
    double largest[Fields];
    double totals[Fields];
    few.measure(largest, totals);
    for (int row = 0; row < Fields; ++row) {
      work.scales[row] = scale_of(largest[row], totals[row]) * row_weights[row];
    }
    few.put(work.scales, work.made.values + work.made.count, work.made.columns + work.made.count);
    return true;
  }
  static void put(int count, int row, Buffers<Fields>& work) {
    const int length = count * Fields;
    double* const values = work.made.values + work.made.count + row * length;
    std::int64_t* const columns = work.made.columns + work.made.count + row * length;
    const double scale = work.scales[row];
    for (int j = 0; j < count; ++j) {
      for (int f = 0; f < Fields; ++f) {
        values[j * Fields + f] = work.sums[j][row * Fields + f] * scale;
      }
    }
    for (int e = 0; e < length; ++e) columns[e] = work.columns[e];
  }
};

/// The same for one field, in the order of the stencil until numbers are put.
template <>
struct PointRows<1> {
  static void make(const RowsTask& task, std::int64_t first, int count, const double* row_weights,
                   Buffers<1>& work) {
    const int* const nodes = task.nodes + first;
    double* const values = work.made.values + work.made.count;
    std::int64_t* const columns = work.made.columns + work.made.count;
    if (count <= few_nodes && task.derivatives == 2 && work.used_count == 2) {
      FewNodes few;
      if (few.sort(nodes, count)) {
        few.add_up(task.weights + 2 * first, count, work.coefficients[0], work.coefficients[1]);
        work.scales[0] = scale_of(few.largest(), 0) * *row_weights;
        return few.put(work.scales[0], values, columns);
      }
    }
    rank_nodes(nodes, count, work.rank);
    const int all_used = work.used_count == task.derivatives ? work.used_count : 0;
    if (all_used == 2) {
      add_up<2>(task, first, count, work);
    } else if (all_used == 3) {
      add_up<3>(task, first, count, work);
    } else {
      add_up<0>(task, first, count, work);
    }
    work.scales[0] *= *row_weights;
    for (int j = 0; j < count; ++j) {
      const int place = work.rank[j];
      values[place] = work.entries_of_one[j] * work.scales[0];
      columns[place] = nodes[j];
    }
  }

 private:
  static constexpr int chains = 4;  ///< independent of each other

  template <int Derivatives>
  static double sum_at(const double* w, const Buffers<1>& work) {
    double sum = 0;
    for (int u = 0; u < (Derivatives > 0 ? Derivatives : work.used_count); ++u) {
      sum += w[Derivatives > 0 ? u : work.used[u]] * work.coefficients[u][0];
    }
    return sum;
  }
  /// Derivatives is their number where all are used, 0 where it is not known before.
  template <int Derivatives>
  static void add_up(const RowsTask& task, std::int64_t first, int count, Buffers<1>& work) {
    double high[chains] = {};
    double total[chains] = {};
    const int m = Derivatives > 0 ? Derivatives : task.derivatives;
    const double* const weights = task.weights + first * m;
    const auto add = [&](int j, int chain) {
      const double sum = sum_at<Derivatives>(weights + static_cast<long>(j) * m, work);
      const double size = __builtin_fabs(sum);
      work.entries_of_one[j] = sum;
      high[chain] = size > high[chain] ? size : high[chain];
      total[chain] += size;
    };
    const int whole = count - count % chains;
    for (int j = 0; j < whole; j += chains) {
#pragma GCC unroll 4
      for (int chain = 0; chain < chains; ++chain) add(j + chain, chain);
    }
    for (int j = whole; j < count; ++j) add(j, j - whole);
    const double low = high[0] > high[1] ? high[0] : high[1];
    const double top = high[2] > high[3] ? high[2] : high[3];
    work.scales[0] = scale_of(low > top ? low : top, (total[0] + total[1]) + (total[2] + total[3]));
  }
};

bool are_same(const std::int64_t* a, const std::int64_t* b, int count) {
  std::int64_t difference = 0;
  for (int i = 0; i < count; ++i) difference |= a[i] ^ b[i];
  return difference == 0;
}

/// True when a row has the columns that are there.
bool has_columns(const RowsTask& task, int row, const std::int64_t* columns, int length) {
  const std::int64_t begin = task.offsets[row];
  return task.offsets[row + 1] - begin == length && are_same(task.columns + begin, columns, length);
}

/// Makes the rows of the points; returns the first one that has not the columns that are there, -1
/// for none.
template <int Fields>
int make_rows_with(const RowsTask& task, Buffers<Fields>& work) {
  constexpr double ones[most_kernel_fields] = {1, 1, 1};
  Made& made = work.made;
  made.begin = task.offsets[0];
  for (int i = 0; i < task.count; ++i) {
    const int point = task.points[static_cast<long>(i) * task.point_step];
    const std::int64_t first = task.weight_offsets[point];
    const int count = static_cast<int>(task.weight_offsets[point + 1] - first);
    const int length = count * Fields;
    if (made.count + length * Fields > Made::room) made.write(task);
    const double* const row_weights =
        task.row_weights != nullptr ? task.row_weights + static_cast<long>(i) * Fields : ones;
    PointRows<Fields>::make(task, first, count, row_weights, work);
    for (int r = 0; r < Fields; ++r) {
      const int row = i * Fields + r;
      if (task.other_columns != nullptr &&
          !has_columns(task, row, made.columns + made.count, length)) {
        return row;
      }
      made.count += length;
      task.scales[row] = work.scales[r];
    }
  }
  return -1;
}

/// Notes a derivative and its coefficients unless all are zero, and others are used.
template <int Fields>
void take_coefficients(const RowsTask& task, int derivative, Buffers<Fields>& work) {
  using Work = Buffers<Fields>;
  const double* const from = task.coefficients + derivative * Work::entries;
  bool is_used = derivative + 1 == task.derivatives && work.used_count == 0;
  for (int e = 0; e < Work::entries; ++e) is_used = is_used || from[e] != 0;
  if (!is_used) return;
  const int u = work.used_count++;
  work.used[u] = derivative;
  for (int e = 0; e < Work::width; ++e) work.coefficients[u][e] = from[e % Work::entries];
}

template <int Fields>
void make_rows_of(const RowsTask& task) {
  Buffers<Fields> work;
  work.used_count = 0;
  for (int d = 0; d < task.derivatives; ++d) take_coefficients(task, d, work);
  const int other = make_rows_with<Fields>(task, work);
  work.made.write(task);
  end_streams();
  if (other >= 0) *task.other_columns = other;
}

}  // namespace

void make_rows(const RowsTask& task) {
  switch (task.fields) {
    case 1:
      return make_rows_of<1>(task);
    case 2:
      return make_rows_of<2>(task);
    default:
      return make_rows_of<3>(task);
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
