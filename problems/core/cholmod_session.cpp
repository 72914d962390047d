#include "problems/core/cholmod_session.hpp"

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/solver_entry.hpp"

namespace strongpoint {

CholmodSession::CholmodSession(const LinearSystem& system, std::string_view solver)
    : system_(system), solver_(solver) {
  static_assert(sizeof(SuiteSparse_long) == sizeof(std::int64_t));
  cholmod_l_start(&common_);
  common_.print = 0;
  // CHOLMOD takes pointers to what it only reads.
  transposed_.nrow = static_cast<std::size_t>(system.unknowns());
  transposed_.ncol = static_cast<std::size_t>(system.rows());
  transposed_.nzmax = system.values.size();
  transposed_.p = const_cast<std::int64_t*>(system.offsets.data());
  transposed_.i = const_cast<std::int64_t*>(system.columns.data());
  transposed_.x = const_cast<double*>(system.values.data());
  transposed_.stype = 0;
  transposed_.itype = CHOLMOD_LONG;
  transposed_.xtype = CHOLMOD_REAL;
  transposed_.dtype = CHOLMOD_DOUBLE;
  transposed_.sorted = 1;
  transposed_.packed = 1;
}

CholmodSession::~CholmodSession() { cholmod_l_finish(&common_); }

cholmod_dense CholmodSession::view(const Eigen::VectorXd& vector) {
  cholmod_dense dense{};
  dense.nrow = static_cast<std::size_t>(vector.size());
  dense.ncol = 1;
  dense.nzmax = dense.nrow;
  dense.d = dense.nrow;
  dense.x = const_cast<double*>(vector.data());
  dense.xtype = CHOLMOD_REAL;
  dense.dtype = CHOLMOD_DOUBLE;
  return dense;
}

void CholmodSession::check() const {
  if (common_.status == CHOLMOD_OK) return;
  if (common_.status == CHOLMOD_NOT_POSDEF) throw_singular(system_, solver_);
  if (common_.status == CHOLMOD_OUT_OF_MEMORY || common_.status == CHOLMOD_TOO_LARGE) {
    throw_out_of_memory(system_, solver_);
  }
  throw CaseError(fmt::format("{}: CHOLMOD failed with status {}", solver_, common_.status));
}

}  // namespace strongpoint
