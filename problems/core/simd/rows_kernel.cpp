#include "problems/core/simd/rows_kernel.hpp"

#include "methods/core/simd/lane_scatter.hpp"
#include "problems/core/simd/few_nodes.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

/// Numbers compared side by side when nodes are sorted.
constexpr int block = 16;

/// Ids that one register holds, 4 without AVX2.
constexpr int ids_at_once = lanes == 1 ? 4 : 2 * lanes;
using Ids = int __attribute__((vector_size(ids_at_once * sizeof(int)), may_alias));

/// Larger than any node's id.
constexpr int beyond = 0x7fffffff;

constexpr int padded(int count, int unit) { return (count + unit - 1) / unit * unit; }

/// The first `count` of some ids, large numbers behind them.
inline Ids load_ids(const int* ids, int count) {
#if defined(__AVX512F__)
  const unsigned some = count >= ids_at_once ? 0xFFFFU : count > 0 ? (1U << count) - 1 : 0U;
  return reinterpret_cast<Ids>(
      _mm512_mask_loadu_epi32(_mm512_set1_epi32(beyond), static_cast<__mmask16>(some), ids));
#else
  Ids result;
  for (int i = 0; i < ids_at_once; ++i) result[i] = i < count ? ids[i] : beyond;
  return result;
#endif
}

/// The place of each id in ascending order: the number of smaller ones. No branch depends on data.
template <int Blocks>
void rank_few(const int* ids, int count, int* rank) {
  constexpr int packs = Blocks * block / ids_at_once;
  Ids numbers[packs];
  for (int b = 0; b < packs; ++b) {
    numbers[b] = load_ids(ids + b * ids_at_once, count - b * ids_at_once);
  }
  Ids smaller[packs] = {};
  for (int j = 0; j < count; ++j) {
    for (int b = 0; b < packs; ++b) smaller[b] -= numbers[b] > ids[j];  // true is -1
  }
  for (int b = 0; b < packs; ++b) reinterpret_cast<Ids*>(rank)[b] = smaller[b];
}

inline void rank_nodes(const int* nodes, int count, int* rank) {
  if (count <= block) return rank_few<1>(nodes, count, rank);
  if (count <= 2 * block) return rank_few<2>(nodes, count, rank);
  rank_few<most_kernel_nodes / block>(nodes, count, rank);
}

/// Entries that were made and wait to be written, few enough to stay in the first-level cache.
struct Made {
  static constexpr int room = 1024;

  alignas(64) double values[room + few_nodes];  // some are written in packs
  alignas(64) std::int64_t columns[room + few_nodes];
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
  static constexpr int width = padded(entries, lanes);

  alignas(64) int rank[most_kernel_nodes];
  FewNodes few;  ///< of one field, instead of ranks and sums
  alignas(64) double coefficients[most_kernel_derivatives][width];
  alignas(64) std::int64_t columns[most_kernel_nodes * Fields];
  alignas(64) double sums[most_kernel_nodes][width];
  Made made;
  double entries_of_one[most_kernel_nodes];  ///< of one field
  const int* nodes;                          ///< of the same
  double scales[Fields];
  bool is_few;  ///< `few` holds the row
};

/// Sums of all rows at the nodes, put where the nodes belong: a node's derivatives times the
/// coefficients. Weights are read as they lie in memory.
template <int Fields>
void add_up(const RowsTask& task, std::int64_t first, int count, Buffers<Fields>& work) {
  using Work = Buffers<Fields>;
  const int m = task.derivatives;
  for (int j = 0; j < count; ++j) {
    const double* w = task.weights + (first + j) * m;
    const int place = work.rank[j];
    for (int e = 0; e < Work::width; e += lanes) {
      Pack sum = all(w[0]) * load(&work.coefficients[0][e]);
      for (int d = 1; d < m; ++d) sum = sum + all(w[d]) * load(&work.coefficients[d][e]);
      store(&work.sums[place][e], sum);
    }
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

bool are_same(const std::int64_t* a, const std::int64_t* b, int count) {
  std::int64_t difference = 0;
  for (int i = 0; i < count; ++i) difference |= a[i] ^ b[i];
  return difference == 0;
}

/// Makes the rows of a point.
template <int Fields>
struct PointRows {
  static void find(const RowsTask& task, std::int64_t first, int count, Buffers<Fields>& work) {
    rank_nodes(task.nodes + first, count, work.rank);
    add_up<Fields>(task, first, count, work);
    find_scales<Fields>(count, work);
    for (int j = 0; j < count; ++j) {
      std::int64_t* const columns = work.columns + work.rank[j] * Fields;
      for (int f = 0; f < Fields; ++f) {
        columns[f] = static_cast<std::int64_t>(task.nodes[first + j]) * Fields + f;
      }
    }
  }
  static void put(int count, int row, double scale, Buffers<Fields>& work) {
    double* const values = work.made.values + work.made.count;
    std::int64_t* const columns = work.made.columns + work.made.count;
    for (int j = 0; j < count; ++j) {
      for (int f = 0; f < Fields; ++f) {
        values[j * Fields + f] = work.sums[j][row * Fields + f] * scale;
      }
    }
    for (int e = 0; e < count * Fields; ++e) columns[e] = work.columns[e];
  }
};

/// The same for one field, in the order of the stencil until numbers are put.
template <>
struct PointRows<1> {
  static constexpr int chains = 4;  ///< independent of each other

  template <int Derivatives>
  static double sum_at(const double* w, int derivatives, const Buffers<1>& work) {
    const int m = Derivatives > 0 ? Derivatives : derivatives;
    double sum = w[0] * work.coefficients[0][0];
    for (int d = 1; d < m; ++d) sum += w[d] * work.coefficients[d][0];
    return sum;
  }
  /// Derivatives is their number, 0 where it is not known before.
  template <int Derivatives>
  static void add_up(const RowsTask& task, std::int64_t first, int count, Buffers<1>& work) {
    double high[chains] = {};
    double total[chains] = {};
    const int m = Derivatives > 0 ? Derivatives : task.derivatives;
    const double* const weights = task.weights + first * m;
    const auto add = [&](int j, int chain) {
      const double sum = sum_at<Derivatives>(weights + static_cast<long>(j) * m, m, work);
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
  static void find(const RowsTask& task, std::int64_t first, int count, Buffers<1>& work) {
    work.nodes = task.nodes + first;
    work.is_few = task.derivatives == 2 && count <= few_nodes && work.few.sort(work.nodes, count);
    if (work.is_few) {
      work.few.add_up(task.weights + 2 * first, count, work.coefficients[0], work.coefficients[1]);
      work.scales[0] = scale_of(work.few.largest(), 0);
      return;
    }
    rank_nodes(work.nodes, count, work.rank);
    if (task.derivatives == 2) return add_up<2>(task, first, count, work);
    if (task.derivatives == 3) return add_up<3>(task, first, count, work);
    add_up<0>(task, first, count, work);
  }
  static void put(int count, int, double scale, Buffers<1>& work) {
    double* const values = work.made.values + work.made.count;
    std::int64_t* const columns = work.made.columns + work.made.count;
    if (work.is_few) return work.few.put(scale, values, columns);
    for (int j = 0; j < count; ++j) {
      const int place = work.rank[j];
      values[place] = work.entries_of_one[j] * scale;
      columns[place] = work.nodes[j];
    }
  }
};

/// Makes the rows of the points; returns the first one that has not the columns that are there, -1
/// for none.
template <int Fields>
int make_rows_with(const RowsTask& task, Buffers<Fields>& work) {
  Made& made = work.made;
  made.begin = task.offsets[0];
  for (int i = 0; i < task.count; ++i) {
    const int point = task.points[static_cast<long>(i) * task.point_step];
    const std::int64_t first = task.weight_offsets[point];
    const int count = static_cast<int>(task.weight_offsets[point + 1] - first);
    PointRows<Fields>::find(task, first, count, work);
    const int length = count * Fields;
    if (made.count + length * Fields > Made::room) made.write(task);
    for (int r = 0; r < Fields; ++r) {
      const int row = i * Fields + r;
      const double weight = task.row_weights != nullptr ? task.row_weights[row] : 1;
      const double scale = work.scales[r] * weight;
      PointRows<Fields>::put(count, r, scale, work);
      if (task.other_columns != nullptr) {
        const std::int64_t begin = task.offsets[row];
        if (task.offsets[row + 1] - begin != length ||
            !are_same(task.columns + begin, made.columns + made.count, length)) {
          return row;
        }
      }
      made.count += length;
      task.scales[row] = scale;
    }
  }
  return -1;
}

template <int Fields>
void make_rows_of(const RowsTask& task) {
  Buffers<Fields> work;
  using Work = Buffers<Fields>;
  for (int d = 0; d < task.derivatives; ++d) {
    for (int e = 0; e < Work::width; ++e) {
      work.coefficients[d][e] = e < Work::entries ? task.coefficients[d * Work::entries + e] : 0;
    }
  }
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
