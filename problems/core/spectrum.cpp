#include "problems/core/spectrum.hpp"

#include <Spectra/GenEigsSolver.h>
#include <algorithm>
#include <functional>
#include <numeric>
#include <vector>

#include <fmt/format.h>

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

/// The inverse of 1 - factor K as Spectra sees it.
class InverseProduct {
 public:
  using Scalar = double;  // NOLINT(readability-identifier-naming): Spectra's name

  InverseProduct(const Motion& motion, double factor)
      : inverse_(motion.shifted(factor)), in_(motion.size()), out_(motion.size()) {}
  Eigen::Index rows() const { return in_.size(); }
  Eigen::Index cols() const { return in_.size(); }
  // NOLINTNEXTLINE(readability-identifier-naming): Spectra's name
  void perform_op(const double* x, double* y) const {
    in_ = Eigen::Map<const Eigen::VectorXd>(x, in_.size());
    inverse_->solve(in_, out_);
    Eigen::Map<Eigen::VectorXd>(y, out_.size()) = out_;
  }

 private:
  std::unique_ptr<ShiftedMotion> inverse_;
  mutable Eigen::VectorXd in_, out_;
};

/// Columns that Arnoldi's iteration keeps for a number of eigenvalues wanted.
int basis_for(int count) { return 2 * count + 20; }

void check_count(const Motion& motion, int count) {
  if (count >= 1 && count <= motion.size()) return;
  throw UsageError(fmt::format("{} eigenvalues of {} are asked for; take 1 to {}", count,
                               motion.size(), motion.size()));
}

/// The pairs in an order of their eigenvalues, `count` at most.
template <class Before>
EigenPairs first_of(const EigenPairs& pairs, int count, const Before& before) {
  std::vector<Eigen::Index> order(pairs.values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return before(std::abs(pairs.values[a]), std::abs(pairs.values[b]));
  });
  if (order.size() > static_cast<std::size_t>(count)) order.resize(count);
  return {pairs.values(order), pairs.vectors(Eigen::all, order)};
}

/// The pairs of largest magnitude of an operator by restarted Arnoldi iterations.
template <class Product>
EigenPairs largest_of(Product& product, int count, int restarts, double tolerance) {
  Spectra::GenEigsSolver<Product> solver(product, count, basis_for(count));
  solver.init();
  if (solver.compute(Spectra::SortRule::LargestMagn, restarts, tolerance) < count) {
    throw CaseError(fmt::format(
        "{} eigenvalues of the operator did not converge in {} restarts; ask for fewer, or take "
        "dense algebra",
        count, restarts));
  }
  return {solver.eigenvalues(), solver.eigenvectors()};
}

constexpr double sharp = 1e-11;  ///< tolerance of what agrees with dense algebra

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
        "the spectral radius of the operator did not converge; take another stencil, cloud or "
        "level");
  }
  return std::abs(solver.eigenvalues()[0]);
}

double eigen_residual(const Motion& motion, const EigenPairs& pairs) {
  Eigen::VectorXd part(motion.size());
  Eigen::VectorXd product(motion.size());
  Eigen::VectorXcd image(motion.size());
  double worst = 0;
  for (Eigen::Index i = 0; i < pairs.values.size(); ++i) {
    part = pairs.vectors.col(i).real();
    motion.apply(part, product);
    image.real() = product;
    part = pairs.vectors.col(i).imag();
    motion.apply(part, product);
    image.imag() = product;
    image -= pairs.values[i] * pairs.vectors.col(i);
    const double error = image.norm();
    const double size = std::abs(pairs.values[i]) * pairs.vectors.col(i).norm();
    if (error > 0) worst = std::max(worst, error / size);
  }
  return worst;
}

EigenPairs lowest_modes(const Motion& motion, int count) {
  check_count(motion, count);
  if (motion.size() <= basis_for(count)) {
    return first_of(dense_eigenpairs(motion), count, std::less<>());
  }
  // Large enough that the identity is next to nothing beside factor K for every mode that nodes can
  // resolve, small enough to keep a singular K from overflowing.
  const double factor = 1e10 / spectral_radius(motion);
  InverseProduct inverse(motion, factor);
  constexpr int restarts = 300;
  EigenPairs pairs = largest_of(inverse, count, restarts, sharp);
  pairs.values = (1 - pairs.values.array().inverse()) / factor;
  return first_of(pairs, count, std::less<>());
}

EigenPairs largest_modes(const Motion& motion, int count) {
  check_count(motion, count);
  if (motion.size() <= basis_for(count)) {
    return first_of(dense_eigenpairs(motion), count, std::greater<>());
  }
  OperatorProduct product(motion);
  constexpr int restarts = 3000;  // eigenvalues crowd at the upper end
  return first_of(largest_of(product, count, restarts, sharp), count, std::greater<>());
}

}  // namespace strongpoint
