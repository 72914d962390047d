#pragma once

#include <memory>
#include <string_view>

#include <suitesparse/cholmod.h>

#include "problems/core/solvers.hpp"

namespace strongpoint {

/// CHOLMOD's parameters and memory for the solve of one system, quiet and with 64-bit indices, and
/// views of that system.
class CholmodSession {
 public:
  /// Starts CHOLMOD for a system, which must outlive the session, on behalf of `solver`.
  CholmodSession(const LinearSystem& system, std::string_view solver);
  CholmodSession(const CholmodSession&) = delete;
  CholmodSession& operator=(const CholmodSession&) = delete;
  ~CholmodSession();

  /// The handle that CHOLMOD's functions take.
  cholmod_common* common() { return &common_; }
  /// A^T, (unknowns, rows), without a copy: the rows of A are its columns.
  cholmod_sparse* transposed() { return &transposed_; }
  /// A vector as a dense matrix of one column, without a copy; it must outlive the view.
  static cholmod_dense view(const Eigen::VectorXd& vector);
  /// Throws the CaseError of the last call's status, when it failed.
  void check() const;

 private:
  const LinearSystem& system_;
  std::string_view solver_;
  cholmod_common common_{};
  cholmod_sparse transposed_{};
};

/// Frees what CHOLMOD made.
struct CholmodFree {
  cholmod_common* common;
  void operator()(cholmod_sparse* matrix) const { cholmod_l_free_sparse(&matrix, common); }
  void operator()(cholmod_dense* matrix) const { cholmod_l_free_dense(&matrix, common); }
  void operator()(cholmod_factor* factor) const { cholmod_l_free_factor(&factor, common); }
};

/// Owns a `cholmod_sparse`, `cholmod_dense` or `cholmod_factor`.
template <class Object>
using CholmodPointer = std::unique_ptr<Object, CholmodFree>;

/// Takes what a CHOLMOD function returned. Throws the CaseError of its status, when it failed.
template <class Object>
CholmodPointer<Object> take(CholmodSession& session, Object* made) {
  CholmodPointer<Object> owner(made, CholmodFree{session.common()});
  session.check();
  return owner;
}

}  // namespace strongpoint
