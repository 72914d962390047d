#include "problems/core/simd/rows_kernel.hpp"

#include "methods/core/simd/pack.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

/// Numbers compared side by side when nodes are sorted.
constexpr int block = 16;

/// Ids that one register holds, 4 without AVX2.
constexpr int ids_at_once = lanes == 1 ? 4 : 2 * lanes;
using Ids = int __attribute__((vector_size(ids_at_once * sizeof(int)), may_alias));

/// Larger than any node's id.
constexpr int beyond = 0x7fffffff;

/// Largest finite number.
constexpr double most = __DBL_MAX__;

constexpr int padded(int count, int unit) { return (count + unit - 1) / unit * unit; }

/// The place of each id in ascending order: the number of smaller ones. No branch depends on data.
template <int Blocks>
void rank_few(const int* ids, int count, int* rank) {
  constexpr int packs = Blocks * block / ids_at_once;
  const Ids* const numbers = reinterpret_cast<const Ids*>(ids);
  Ids smaller[packs] = {};
  for (int j = 0; j < count; ++j) {
    for (int b = 0; b < packs; ++b) smaller[b] -= numbers[b] > ids[j];  // true is -1
  }
  for (int b = 0; b < packs; ++b) reinterpret_cast<Ids*>(rank)[b] = smaller[b];
}

/// Buffers for one point.
template <int Fields>
struct Buffers {
  static constexpr int entries = Fields * Fields;  ///< of a node, in all rows
  static constexpr int width = padded(entries, lanes);

  alignas(64) int rank[most_kernel_nodes];
  alignas(64) double coefficients[most_kernel_derivatives][width];
  alignas(64) int ids[most_kernel_nodes + block];
  alignas(64) std::int64_t columns[most_kernel_nodes * Fields];
  alignas(64) double sums[most_kernel_nodes + lanes][width];
  double scales[Fields];
  int sorted[most_kernel_nodes];
};

template <int Fields>
void sort_nodes(const int* nodes, int count, Buffers<Fields>& work) {
  const int filled = padded(count, block);
  for (int j = 0; j < count; ++j) work.ids[j] = nodes[j];
  for (int j = count; j < filled; ++j) work.ids[j] = beyond;
  if (filled == block) {
    rank_few<1>(work.ids, count, work.rank);
  } else if (filled == 2 * block) {
    rank_few<2>(work.ids, count, work.rank);
  } else {
    rank_few<most_kernel_nodes / block>(work.ids, count, work.rank);
  }
  for (int j = 0; j < count; ++j) work.sorted[work.rank[j]] = work.ids[j];
}

/// Sums of all rows at the nodes, put where the nodes belong: a node's derivatives times the
/// coefficients. Weights are read as they lie in memory.
template <int Fields>
void add_up(const RowsTask& task, std::int64_t first, int count, Buffers<Fields>& work) {
  using Work = Buffers<Fields>;
  const int m = task.derivatives;
  for (int j = 0; j < count; ++j) {
    const double* w = task.weights + (first + j) * m;
    const int place = work.rank[j];
    if constexpr (Work::entries == 1) {
      double sum = 0;
      for (int d = 0; d < m; ++d) sum += w[d] * work.coefficients[d][0];
      (&work.sums[0][0])[place] = sum;
    } else {
      for (int e = 0; e < Work::width; e += lanes) {
        Pack sum = all(w[0]) * load(&work.coefficients[0][e]);
        for (int d = 1; d < m; ++d) sum = sum + all(w[d]) * load(&work.coefficients[d][e]);
        store(&work.sums[place][e], sum);
      }
    }
  }
}

/// 1 / largest entry of each row, 0 where there is none or one is not finite.
template <int Fields>
void find_scales(int count, Buffers<Fields>& work) {
  using Work = Buffers<Fields>;
  alignas(64) double largest[Work::width < lanes ? lanes : Work::width] = {};
  alignas(64) double total[Work::width < lanes ? lanes : Work::width] = {};
  if constexpr (Work::entries == 1) {
    double* const sums = &work.sums[0][0];
    for (int j = count; j < padded(count, lanes); ++j) sums[j] = 0;
    Pack high = all(0);
    Pack sum = all(0);
    for (int j = 0; j < count; j += lanes) {
      const Pack size = abs(load(sums + j));
      high = max(size, high);
      sum = sum + size;
    }
    store(largest, high);
    store(total, sum);
    for (int lane = 1; lane < lanes; ++lane) {
      largest[0] = largest[lane] > largest[0] ? largest[lane] : largest[0];
      total[0] += total[lane];
    }
  } else {
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
  }
  for (int row = 0; row < Fields; ++row) {
    double high = 0;
    double sum = 0;
    for (int f = 0; f < Fields; ++f) {
      const int e = row * Fields + f;
      high = largest[e] > high ? largest[e] : high;
      sum += total[e];
    }
    // A sum of magnitudes is finite when they are, but for overflow.
    const double scale = 1 / high;
    work.scales[row] = high > 0 && sum <= most && scale <= most ? scale : 0;
  }
}

template <int Fields>
void write_values(int count, int row, double scale, const Buffers<Fields>& work, double* values) {
  if constexpr (Fields == 1) {
    const double* const sums = &work.sums[0][0];
    for (int j = 0; j < count; ++j) values[j] = sums[j] * scale;
  } else {
    for (int j = 0; j < count; ++j) {
      for (int f = 0; f < Fields; ++f) {
        values[j * Fields + f] = work.sums[j][row * Fields + f] * scale;
      }
    }
  }
}

template <int Fields>
void make_columns(int count, Buffers<Fields>& work) {
  for (int j = 0; j < count; ++j) {
    const std::int64_t first = static_cast<std::int64_t>(work.sorted[j]) * Fields;
    for (int f = 0; f < Fields; ++f) work.columns[j * Fields + f] = first + f;
  }
}

bool are_same(const std::int64_t* a, const std::int64_t* b, int count) {
  std::int64_t difference = 0;
  for (int i = 0; i < count; ++i) difference |= a[i] ^ b[i];
  return difference == 0;
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
  for (int i = 0; i < task.count; ++i) {
    const int point = task.points[i];
    const std::int64_t first = task.weight_offsets[point];
    const int count = static_cast<int>(task.weight_offsets[point + 1] - first);
    sort_nodes<Fields>(task.nodes + first, count, work);
    add_up<Fields>(task, first, count, work);
    find_scales<Fields>(count, work);
    make_columns<Fields>(count, work);
    for (int r = 0; r < Fields; ++r) {
      const int row = i * Fields + r;
      const std::int64_t begin = task.offsets[row];
      const int length = count * Fields;
      std::int64_t* const columns = task.columns + begin;
      if (task.other_columns == nullptr) {
        for (int e = 0; e < length; ++e) columns[e] = work.columns[e];
      } else if (task.offsets[row + 1] - begin != length ||
                 !are_same(columns, work.columns, length)) {
        *task.other_columns = row;
        return;
      }
      double scale = work.scales[r];
      if (task.row_weights != nullptr) scale *= task.row_weights[row];
      write_values<Fields>(count, r, scale, work, task.values + begin);
      task.scales[row] = scale;
    }
  }
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
