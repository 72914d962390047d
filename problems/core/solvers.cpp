#include "problems/core/solvers.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <fmt/format.h>
#include <umfpack.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

using RowMajor = Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor, std::int64_t>>;

RowMajor view_of(const LinearSystem& system) {
  return {
      system.rows(),         system.rows(),         static_cast<Eigen::Index>(system.values.size()),
      system.offsets.data(), system.columns.data(), system.values.data()};
}

[[noreturn]] void throw_singular(const LinearSystem& system, std::string_view solver) {
  throw CaseError(fmt::format(
      "{}: the system of {} unknowns is singular; check the boundary conditions and the stencils",
      solver, system.rows()));
}

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

void check_umfpack(SuiteSparse_long status, const LinearSystem& system) {
  if (status == UMFPACK_OK) return;
  if (status == UMFPACK_WARNING_singular_matrix) throw_singular(system, "umfpack");
  if (status == UMFPACK_ERROR_out_of_memory) {
    throw CaseError(
        fmt::format("umfpack: out of memory for {} unknowns; use fewer nodes", system.rows()));
  }
  throw CaseError(fmt::format("umfpack: failed with status {}", status));
}

/// Direct factorisation with 64-bit indices. The rows are handed over as the columns of the
/// transpose.
Eigen::VectorXd solve_umfpack(const LinearSystem& system) {
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
  check_umfpack(
      umfpack_dl_symbolic(n, n, offsets, columns, values, &made.symbolic, control, nullptr),
      system);
  check_umfpack(
      umfpack_dl_numeric(offsets, columns, values, made.symbolic, &made.numeric, control, nullptr),
      system);
  Eigen::VectorXd x(n);
  check_umfpack(umfpack_dl_solve(UMFPACK_At, offsets, columns, values, x.data(),
                                 system.right_hand_side.data(), made.numeric, control, nullptr),
                system);
  return x;
}

Eigen::VectorXd solve_sparse_lu(const LinearSystem& system) {
  const Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t> matrix = view_of(system);
  Eigen::SparseLU<Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t>,
                  Eigen::COLAMDOrdering<std::int64_t>>
      lu;
  lu.compute(matrix);
  if (lu.info() != Eigen::Success) throw_singular(system, "sparse_lu");
  return lu.solve(system.right_hand_side);
}

struct SolverEntry {
  EntryInfo info;
  Eigen::VectorXd (*solve)(const LinearSystem&);
};

const std::vector<SolverEntry>& entries() {
  static const std::vector<SolverEntry> list{
      {{"umfpack", "UMFPACK's multifrontal LU with 64-bit indices", {}}, solve_umfpack},
      {{"sparse_lu", "Eigen's supernodal SparseLU", {}}, solve_sparse_lu}};
  return list;
}

/// Largest absolute row sum.
double infinity_norm(const LinearSystem& system) {
  double norm = 0;
  for (std::int64_t row = 0; row < system.rows(); ++row) {
    double sum = 0;
    for (std::int64_t i = system.offsets[row]; i < system.offsets[row + 1]; ++i) {
      sum += std::abs(system.values[i]);
    }
    norm = std::max(norm, sum);
  }
  return norm;
}

/// True when |A| |x| / |b|, a lower bound of the condition number, says that no digit can be
/// trusted.
bool proves_singular(const LinearSystem& system, const Eigen::VectorXd& x, double norm) {
  constexpr double largest_condition = 1e14;
  return norm * x.lpNorm<Eigen::Infinity>() >
         largest_condition * system.right_hand_side.lpNorm<Eigen::Infinity>();
}

double relative_residual(const LinearSystem& system, const Eigen::VectorXd& x, double norm) {
  const RowMajor matrix = view_of(system);
  const Eigen::VectorXd residual = system.right_hand_side - matrix * x;
  const double scale =
      norm * x.lpNorm<Eigen::Infinity>() + system.right_hand_side.lpNorm<Eigen::Infinity>();
  return scale > 0 ? residual.lpNorm<Eigen::Infinity>() / scale : 0;
}

}  // namespace

const std::vector<EntryInfo>& solvers() {
  static const std::vector<EntryInfo> infos = [] {
    std::vector<EntryInfo> list;
    for (const SolverEntry& entry : entries()) list.push_back(entry.info);
    return list;
  }();
  return infos;
}

std::string canonical_solver(std::string_view text) {
  const Spec spec = parse_spec(text);
  return Options(find_entry(entries(), "solver", spec.name).info, spec).canonical();
}

LinearSolution solve(const LinearSystem& system, std::string_view solver) {
  const SolverEntry& entry = find_entry(entries(), "solver", parse_spec(solver).name);
  LinearSolution solution;
  solution.x = entry.solve(system);
  const double norm = infinity_norm(system);
  if (!solution.x.allFinite() || proves_singular(system, solution.x, norm)) {
    throw_singular(system, entry.info.name);
  }
  solution.residual = relative_residual(system, solution.x, norm);
  if (!(solution.residual <= largest_residual)) {
    throw CaseError(
        fmt::format("{}: the relative residual {:.1e} exceeds {:.0e}; the system of {} "
                    "unknowns is too ill-conditioned",
                    entry.info.name, solution.residual, largest_residual, system.rows()));
  }
  return solution;
}

}  // namespace strongpoint
