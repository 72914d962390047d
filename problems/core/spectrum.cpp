#include "problems/core/spectrum.hpp"

#include <Spectra/GenEigsSolver.h>
#include <algorithm>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

/// K as Spectra sees it.
class OperatorProduct {
 public:
  using Scalar = double;  // NOLINT(readability-identifier-naming): Spectra's name

  explicit OperatorProduct(const Motion& motion)
      : motion_(motion), in_(motion.size()), out_(motion.size()) {}
  Eigen::Index rows() const { return motion_.size(); }
  Eigen::Index cols() const { return motion_.size(); }
  // NOLINTNEXTLINE(readability-identifier-naming): Spectra's name
  void perform_op(const double* x, double* y) const {
    in_ = Eigen::Map<const Eigen::VectorXd>(x, motion_.size());
    motion_.apply(in_, out_);
    Eigen::Map<Eigen::VectorXd>(y, motion_.size()) = out_;
  }

 private:
  const Motion& motion_;
  mutable Eigen::VectorXd in_, out_;
};

}  // namespace

double growth_rate(const Eigen::VectorXcd& eigenvalues) {
  return eigenvalues.cwiseSqrt().real().maxCoeff();
}

double spectral_radius(const Motion& motion) {
  constexpr int small = 40;
  if (motion.size() <= small) {
    return dense_eigenvalues(motion).cwiseAbs().maxCoeff();
  }
  OperatorProduct product(motion);
  constexpr int basis = 20;
  constexpr int restarts = 300;
  constexpr double tolerance = 1e-4;
  Spectra::GenEigsSolver<OperatorProduct> solver(product, 1, basis);
  solver.init();
  if (solver.compute(Spectra::SortRule::LargestMagn, restarts, tolerance) < 1) {
    throw CaseError(
        "the spectral radius of the operator did not converge; choose the time step by "
        "dt= instead");
  }
  return std::abs(solver.eigenvalues()[0]);
}

}  // namespace strongpoint
