#include "problems/core/sparse_factor.hpp"

#include <array>
#include <stdexcept>
#include <vector>

#include <umfpack.h>

#include "problems/core/node_ordering.hpp"

namespace strongpoint {
namespace {

SparseFactor::Fault fault_of(SuiteSparse_long status) {
  switch (status) {
    case UMFPACK_OK:
      return SparseFactor::Fault::none;
    case UMFPACK_WARNING_singular_matrix:
      return SparseFactor::Fault::singular;
    case UMFPACK_ERROR_out_of_memory:
      return SparseFactor::Fault::out_of_memory;
    default:
      return SparseFactor::Fault::other;
  }
}

const SuiteSparse_long* as_long(const std::int64_t* indices) {
  static_assert(sizeof(SuiteSparse_long) == sizeof(std::int64_t));
  return reinterpret_cast<const SuiteSparse_long*>(indices);
}

}  // namespace

/// UMFPACK's objects, freed on every path, and room for its solves.
struct SparseFactor::Objects {
  explicit Objects(Eigen::Index n) : indices(n), numbers(5 * n) {
    umfpack_dl_defaults(control.data());
    // The default of 0.1 lets the factors grow: traction rows at 161^2 nodes left a residual of
    // 1e-1. Full partial pivoting solves them to round-off and is no slower.
    control[UMFPACK_PIVOT_TOLERANCE] = 1;
  }
  Objects(const Objects&) = delete;
  Objects& operator=(const Objects&) = delete;
  ~Objects() {
    umfpack_dl_free_symbolic(&symbolic);
    umfpack_dl_free_numeric(&numeric);
  }
  /// Orders the unknowns and analyses the pattern; gives UMFPACK's status.
  SuiteSparse_long analyse(const Eigen::Map<const RowMatrix>& matrix, Ordering ordering, int fields,
                           double* info) {
    const SuiteSparse_long n = matrix.rows();
    const SuiteSparse_long* offsets = as_long(matrix.outerIndexPtr());
    const SuiteSparse_long* columns = as_long(matrix.innerIndexPtr());
    if (ordering == Ordering::least_fill) control[UMFPACK_ORDERING] = UMFPACK_ORDERING_BEST;
    if (ordering == Ordering::nodes) {
      const std::vector<std::int64_t> order = node_ordering(matrix, fields);
      if (!order.empty()) {
        control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
        return umfpack_dl_qsymbolic(n, n, offsets, columns, matrix.valuePtr(),
                                    as_long(order.data()), &symbolic, control.data(), info);
      }
    }
    return umfpack_dl_symbolic(n, n, offsets, columns, matrix.valuePtr(), &symbolic, control.data(),
                               info);
  }

  std::array<double, UMFPACK_CONTROL> control{};
  std::vector<SuiteSparse_long> indices;
  std::vector<double> numbers;
  void* symbolic = nullptr;
  void* numeric = nullptr;
};

/// The rows are handed over as the columns of the transpose.
SparseFactor::SparseFactor(const Eigen::Map<const RowMatrix>& matrix, Ordering ordering, int fields)
    : matrix_(matrix), objects_(std::make_unique<Objects>(matrix.rows())) {
  const SuiteSparse_long* offsets = as_long(matrix_.outerIndexPtr());
  const SuiteSparse_long* columns = as_long(matrix_.innerIndexPtr());
  std::array<double, UMFPACK_INFO> info{};
  SuiteSparse_long status = objects_->analyse(matrix_, ordering, fields, info.data());
  if (status == UMFPACK_OK) {
    status = umfpack_dl_numeric(offsets, columns, matrix_.valuePtr(), objects_->symbolic,
                                &objects_->numeric, objects_->control.data(), info.data());
    pivot_ratio_ = info[UMFPACK_RCOND];
    bytes_ = static_cast<std::size_t>(info[UMFPACK_NUMERIC_SIZE] * info[UMFPACK_SIZE_OF_UNIT]);
    peak_bytes_ = static_cast<std::size_t>(info[UMFPACK_PEAK_MEMORY] * info[UMFPACK_SIZE_OF_UNIT]);
  }
  umfpack_dl_free_symbolic(&objects_->symbolic);
  status_ = static_cast<int>(status);
  fault_ = fault_of(status);
}

SparseFactor::~SparseFactor() = default;

void SparseFactor::solve(const double* b, double* x) const {
  if (fault_ != Fault::none) throw std::logic_error("factors of a matrix that has none");
  Objects& objects = *objects_;
  umfpack_dl_wsolve(UMFPACK_At, as_long(matrix_.outerIndexPtr()), as_long(matrix_.innerIndexPtr()),
                    matrix_.valuePtr(), x, b, objects.numeric, objects.control.data(), nullptr,
                    objects.indices.data(), objects.numbers.data());
}

TriangularFactors SparseFactor::packed() const {
  if (fault_ != Fault::none) throw std::logic_error("factors of a matrix that has none");
  return TriangularFactors(objects_->numeric);
}

}  // namespace strongpoint
