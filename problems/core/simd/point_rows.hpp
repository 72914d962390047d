#pragma once

// For kernel sources only (methods/core/simd/path.hpp): the rows of one point.

#include "methods/core/simd/lane_scatter.hpp"
#include "problems/core/simd/few_nodes.hpp"
#include "problems/core/simd/few_vectors.hpp"
#include "problems/core/simd/node_ranks.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

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
    const bool are_packs = work.used_count == task.derivatives && count >= lanes;
    if (are_packs && task.derivatives == 2) {
      add_up_packs<2>(task.weights + 2 * first, count, work);
    } else if (are_packs && task.derivatives == 3) {
      add_up_packs<3>(task.weights + 3 * first, count, work);
    } else {
      add_up(task, first, count, work);
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

  /// For a pack of nodes or more, with as many derivatives, all of which are used.
  template <int Derivatives>
  static void add_up_packs(const double* weights, int count, Buffers<1>& work) {
    Pack coefficients[Derivatives];
    for (int u = 0; u < Derivatives; ++u) coefficients[u] = load(work.coefficients[u]);
    Pack high = all(0);
    Pack total = all(0);
    for (int next = 0; next < count; next += lanes) {
      const int j = next < count - lanes ? next : count - lanes;  // some count twice
      const double* node[lanes];
      for (int lane = 0; lane < lanes; ++lane) {
        node[lane] = weights + static_cast<long>(j + lane) * Derivatives;
      }
      Pack w[Derivatives];
      load_nodes<Derivatives>(node, w);
      Pack sum = w[0] * coefficients[0];
      for (int u = 1; u < Derivatives; ++u) sum = sum + w[u] * coefficients[u];
      store(work.entries_of_one + j, sum);
      high = max(abs(sum), high);
      total = total + abs(sum);
    }
    double largest[lanes];
    double totals[lanes];
    store(largest, high);
    store(totals, total);
    for (int lane = 1; lane < lanes; ++lane) {
      largest[0] = largest[lane] > largest[0] ? largest[lane] : largest[0];
      totals[0] += totals[lane];
    }
    work.scales[0] = scale_of(largest[0], totals[0]);
  }
  static void add_up(const RowsTask& task, std::int64_t first, int count, Buffers<1>& work) {
    double high[chains] = {};
    double total[chains] = {};
    const double* const weights = task.weights + first * task.derivatives;
    const auto add = [&](int j, int chain) {
      const double* const w = weights + static_cast<long>(j) * task.derivatives;
      double sum = 0;
      for (int u = 0; u < work.used_count; ++u) sum += w[work.used[u]] * work.coefficients[u][0];
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

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
