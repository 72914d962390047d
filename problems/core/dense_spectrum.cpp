#include <cmath>
#include <lapacke.h>
#include <limits>

#include "methods/core/error.hpp"
#include "problems/core/spectrum.hpp"

extern "C" {
/// Present when LAPACK's BLAS is OpenBLAS.
void openblas_set_num_threads(int threads) __attribute__((weak));
int openblas_get_num_threads() __attribute__((weak));
}

namespace strongpoint {
namespace {

/// Keeps OpenBLAS to one thread: faster for matrices of some thousand rows, and the same bits
/// whatever the machine.
class OneBlasThread {
 public:
  OneBlasThread() {
    if (openblas_set_num_threads == nullptr || openblas_get_num_threads == nullptr) return;
    before_ = openblas_get_num_threads();
    openblas_set_num_threads(1);
  }
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;
  ~OneBlasThread() {
    if (before_ > 0) openblas_set_num_threads(before_);
  }

 private:
  int before_ = 0;
};

/// What dgeev gives: a complex pair's vectors lie in two columns, real and imaginary part.
struct RealForm {
  Eigen::VectorXd real, imaginary;
  Eigen::MatrixXd vectors;  ///< (size, size), empty when not asked for
};

enum class Wanted { values, vectors };

RealForm decompose(const Motion& motion, Wanted wanted) {
  Eigen::MatrixXd matrix = dense_operator(motion);
  const Eigen::Index n = matrix.rows();
  RealForm form{Eigen::VectorXd(n), Eigen::VectorXd(n), {}};
  if (wanted == Wanted::vectors) form.vectors.resize(n, n);
  const auto size = static_cast<lapack_int>(n);
  const OneBlasThread one;
  const lapack_int info =
      matrix.allFinite()
          ? LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', wanted == Wanted::vectors ? 'V' : 'N', size,
                          matrix.data(), size, form.real.data(), form.imaginary.data(), nullptr, 1,
                          form.vectors.data(), size)
          : -1;
  if (info < 0) throw CaseError("the operator of the motion has no finite eigenvalues");
  if (info > 0) {
    throw CaseError(
        "the eigenvalues of the operator did not converge; take another stencil or level");
  }
  return form;
}

Eigen::VectorXcd values_of(const RealForm& form) {
  Eigen::VectorXcd values(form.real.size());
  values.real() = form.real;
  values.imag() = form.imaginary;
  return values;
}

}  // namespace

Eigen::VectorXcd dense_eigenvalues(const Motion& motion) {
  return values_of(decompose(motion, Wanted::values));
}

EigenPairs dense_eigenpairs(const Motion& motion) {
  const RealForm form = decompose(motion, Wanted::vectors);
  EigenPairs pairs{values_of(form), form.vectors};
  for (Eigen::Index i = 0; i + 1 < form.imaginary.size(); ++i) {
    if (form.imaginary[i] == 0) continue;
    pairs.vectors.col(i).imag() = form.vectors.col(i + 1);
    pairs.vectors.col(i + 1) = pairs.vectors.col(i).conjugate();
    ++i;
  }
  return pairs;
}

/// A pair v, conj(v) is that of sqrt(2) Re v, sqrt(2) Im v turned by a unitary matrix: real columns
/// have the same singular values.
double eigenvector_condition(const EigenPairs& pairs) {
  const Eigen::Index n = pairs.values.size();
  if (pairs.vectors.rows() != n) {
    throw SkipCase("the condition of the eigenvectors needs all of them");
  }
  Eigen::MatrixXd columns = pairs.vectors.real();
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    if (pairs.values[i].imag() == 0) continue;
    columns.col(i) *= std::sqrt(2.0);
    columns.col(i + 1) = std::sqrt(2.0) * pairs.vectors.col(i).imag();
    ++i;
  }
  Eigen::VectorXd singular(n);
  const auto size = static_cast<lapack_int>(n);
  const OneBlasThread one;
  if (LAPACKE_dgesdd(LAPACK_COL_MAJOR, 'N', size, size, columns.data(), size, singular.data(),
                     nullptr, 1, nullptr, 1) != 0) {
    throw CaseError("the singular values of the eigenvectors did not converge");
  }
  return singular[n - 1] > 0 ? singular[0] / singular[n - 1]
                             : std::numeric_limits<double>::infinity();
}

}  // namespace strongpoint
