#include "problems/core/simd/rows_kernel.hpp"

#include "problems/core/simd/point_rows.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

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
