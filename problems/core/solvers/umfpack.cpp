#include <fmt/format.h>
#include <umfpack.h>

#include "methods/core/error.hpp"
#include "problems/core/solver_entry.hpp"

namespace strongpoint {
namespace {

/// Frees UMFPACK's objects on every path.
struct UmfpackObjects {
  UmfpackObjects() = default;
  UmfpackObjects(const UmfpackObjects&) = delete;
  UmfpackObjects& operator=(const UmfpackObjects&) = delete;
  ~UmfpackObjects() {
    umfpack_dl_free_symbolic(&symbolic);
    umfpack_dl_free_numeric(&numeric);
  }
  void* symbolic = nullptr;
  void* numeric = nullptr;
};

void check(SuiteSparse_long status, const LinearSystem& system) {
  if (status == UMFPACK_OK) return;
  if (status == UMFPACK_WARNING_singular_matrix) throw_singular(system, "umfpack");
  if (status == UMFPACK_ERROR_out_of_memory) throw_out_of_memory(system, "umfpack");
  throw CaseError(fmt::format("umfpack: failed with status {}", status));
}

/// The rows are handed over as the columns of the transpose.
LinearSolution solve_umfpack(const LinearSystem& system) {
  static_assert(sizeof(SuiteSparse_long) == sizeof(std::int64_t));
  const auto n = static_cast<SuiteSparse_long>(system.rows());
  const auto* offsets = reinterpret_cast<const SuiteSparse_long*>(system.offsets.data());
  const auto* columns = reinterpret_cast<const SuiteSparse_long*>(system.columns.data());
  const double* values = system.values.data();
  double control[UMFPACK_CONTROL];
  umfpack_dl_defaults(control);
  // The default of 0.1 lets the factors grow: traction rows at 161^2 nodes left a residual of 1e-1.
  // Full partial pivoting solves them to round-off and is no slower.
  control[UMFPACK_PIVOT_TOLERANCE] = 1;
  UmfpackObjects made;
  check(umfpack_dl_symbolic(n, n, offsets, columns, values, &made.symbolic, control, nullptr),
        system);
  check(
      umfpack_dl_numeric(offsets, columns, values, made.symbolic, &made.numeric, control, nullptr),
      system);
  LinearSolution solution;
  solution.x.resize(n);
  check(umfpack_dl_solve(UMFPACK_At, offsets, columns, values, solution.x.data(),
                         system.right_hand_side.data(), made.numeric, control, nullptr),
        system);
  return solution;
}

}  // namespace

/// Direct factorisation with 64-bit indices. Source: Davis 2004, UMFPACK; full partial pivoting
/// instead of its threshold.
SolverEntry solver_umfpack() {
  return {{"umfpack", "UMFPACK's multifrontal LU with 64-bit indices", {}},
          Shape::square,
          Approach::direct,
          [](const Options&) -> Solver { return solve_umfpack; }};
}

}  // namespace strongpoint
